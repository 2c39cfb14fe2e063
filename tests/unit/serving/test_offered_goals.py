"""Goals that callers outside give: what is reachable, accepted, refused, cancelled, and what callers hear."""

import asyncio
from typing import Any

import jsonschema
import pytest
from serving_lab import Lab, run

from jacaros.serving.arguments import results_schema
from jacaros.serving.callers import RequestError
from jacaros.serving.service import MOST_ALIVE, Event


def refused(request: Any, code: str) -> str:
    """Return the text of the error that a request ends with."""
    with pytest.raises(RequestError) as error:
        request()
    assert error.value.code == code
    return str(error.value)


def test_a_goal_is_accepted_pursued_and_achieved() -> None:
    async def test(lab: Lab) -> None:
        anna, heard = lab.session(), list[Event]()
        anna.listen(heard.append)
        goal = anna.achieve("bob", "deliver", {"parcel": "Ann, O'Hara", "room": "kitchen"})
        assert goal.state == "pending"
        await goal.wait()
        assert lab.mas.clock.elapsed == pytest.approx(2.0)
        states = [(each["state"], each["progress"]) for each in heard if each["event"] == "goal"]
        assert states == [("running", None), ("running", 0.5), ("achieved", 0.5)]
        announced = [each for each in heard if each["event"] == "announced"]
        assert announced == [
            {
                "event": "announced",
                "agent": "bob",
                "name": "delivered",
                "arguments": {"parcel": "Ann, O'Hara"},
            }
        ]

    run(test)


def test_results_are_bindings() -> None:
    async def test(lab: Lab) -> None:
        goal = lab.session().achieve("bob", "count", [3])
        await goal.wait()
        assert goal.results == {"next": 4}
        again = lab.session().achieve("bob", "count(4, Next)")
        await again.wait()
        assert again.results == {"next": 5}

    run(test)


def test_results_that_a_plan_leaves_open_are_left_out() -> None:
    async def test(lab: Lab) -> None:
        goal = lab.session().achieve("bob", "half")
        await goal.wait()
        assert (goal.state, goal.results) == ("achieved", {"x": 1})
        jsonschema.validate(goal.results, results_schema(goal.offer))

    run(test, "{ offer(goal, half(x(out(number)), y(out(number)))) } +!half(1, _).")


def test_only_what_is_offered_to_a_role_is_reachable() -> None:
    async def test(lab: Lab) -> None:
        anna, eve, warden = lab.session(), lab.session("eve", "observer"), lab.session("w", "warden")
        assert refused(lambda: anna.achieve("bob", "hidden"), "not_offered") == "bob offers no goal `hidden`"
        misspelt = refused(lambda: anna.achieve("bob", "serch"), "not_offered")
        assert misspelt == "bob offers no goal `serch`; did you mean `search`?"
        wrong = refused(lambda: anna.achieve("bob", "count(1)"), "not_offered")
        assert wrong == "bob offers no goal `count/1`; expected count(n: number 0..10, -> next: number)"
        secret = refused(lambda: anna.achieve("bob", "gard"), "not_offered")
        assert "guard" not in secret  # it is offered to others
        assert "role user" in refused(lambda: eve.achieve("bob", "search"), "not_permitted")
        refused(lambda: anna.achieve("bob", "guard"), "not_permitted")
        refused(lambda: eve.tell("bob", "closed", ["kitchen"]), "not_permitted")
        refused(lambda: anna.ask("bob", "secret(X)"), "not_offered")
        refused(lambda: anna.achieve("nobody", "search"), "unknown_agent")
        assert {each.name for each in eve.offers("bob")} == {
            "battery", "double", "endless", "saying", "delivered",
        }  # fmt: skip
        assert warden.achieve("bob", "guard").state == "pending"
        assert lab.session("root", "operator").achieve("bob", "guard").state == "pending"

    assert run(test) == []


def test_wrong_arguments_name_all_problems() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        told = refused(lambda: anna.achieve("bob", "deliver", {"parcel": 3, "rom": "x"}), "invalid_arguments")
        assert told == (
            "unknown argument `rom`; `parcel` must be of the kind string; `room` is missing; "
            "expected deliver(parcel: string, room: kitchen | office)"
        )
        refused(lambda: anna.achieve("bob", "deliver", ["p", "attic"]), "invalid_arguments")
        refused(lambda: anna.achieve("bob", "count", [11]), "invalid_arguments")
        refused(lambda: anna.achieve("bob", "count", [float("nan")]), "invalid_arguments")
        refused(lambda: anna.achieve("bob", "deliver(X, kitchen)"), "invalid_arguments")
        refused(lambda: anna.achieve("bob", "deliver("), "invalid_arguments")
        refused(lambda: anna.achieve("bob", f"deliver({'x' * 3000})"), "too_large")

    assert run(test) == []


def test_a_plan_refuses_with_its_reason() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        anna.tell("bob", "closed", ["kitchen"])
        await asyncio.sleep(0.1)
        goal = anna.achieve("bob", "deliver", ["p", "kitchen"])
        await goal.wait()
        assert (goal.state, goal.message) == ("refused", "closed(kitchen)")
        assert goal.data()["reasons"] == ["refused(closed(kitchen))", "error(refused)"]
        answer = await anna.why("!deliver(_, kitchen)")
        assert "request" in answer.text()
        assert "asked by test:anna" in answer.text()
        anna.tell("bob", "closed", ["kitchen"], untell=True)
        again = anna.achieve("bob", "deliver", ["p", "kitchen"])
        await again.wait()
        assert again.state == "achieved"

    assert run(test) == ["[bob] test:anna closed kitchen"]


def test_a_goal_without_an_applicable_plan_is_refused_and_a_late_failure_is_not() -> None:
    program = """
    { offer(goal, go(n(number))) }
    +!go(1) : false. +!go(2) <- .wait(10); .fail(stuck). +!go(3) <- .accept; .fail(stuck). +!go(4) <- !go(1).
    """

    async def test(lab: Lab) -> None:
        goals = []
        for number in (1, 2, 3, 4):
            goals.append(lab.session().achieve("bob", "go", [number]))
            await goals[-1].wait()
        assert [each.state for each in goals] == ["refused", "failed", "failed", "refused"]
        assert "error(no_applicable)" in goals[0].data()["reasons"]
        assert "stuck" in goals[1].data()["reasons"]
        assert [each.message for each in goals[1:3]] == ["stuck", "stuck"]

    run(test, program)


def test_one_more_goal_is_refused_waits_or_replaces() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        first, second = (anna.achieve("bob", "deliver", [p, "office"]) for p in "ab")
        assert second.state == "refused"
        assert second.data()["reasons"] == ["refused(busy)"]
        await first.wait()
        washing = [anna.achieve("bob", "wash") for _ in range(3)]
        begun = lab.mas.clock.elapsed
        assert [each.state for each in washing] == ["pending", "waiting", "waiting"]
        washing[1].cancel()
        await washing[2].wait()
        assert [each.state for each in washing] == ["achieved", "cancelled", "achieved"]
        assert lab.mas.clock.elapsed - begun == pytest.approx(2.0)
        old = anna.achieve("bob", "search")
        await asyncio.sleep(1)
        new = anna.achieve("bob", "search")
        await old.wait()
        assert (old.state, new.state) == ("cancelled", "running")

    run(test)


def test_cancelling_waits_for_the_clean_up() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        goal = anna.achieve("bob", "search")
        await asyncio.sleep(1)
        anna.cancel(goal.id)
        assert goal.state == "cancelling"
        await goal.wait()
        assert goal.state == "cancelled"
        assert lab.lines == ["[bob] tidying", "[bob] tidied"]
        assert lab.mas.clock.elapsed == pytest.approx(1.5)

    run(test)


def test_goals_of_a_caller_that_leaves_continue_or_are_cancelled() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        kept, dropped = anna.achieve("bob", "deliver", ["p", "office"]), anna.achieve("bob", "wash")
        await asyncio.sleep(0.1)
        anna.close()
        await kept.wait()
        await dropped.wait()
        assert (kept.state, dropped.state) == ("achieved", "cancelled")
        refused(lambda: anna.achieve("bob", "wash"), "ended")

    run(test)


def test_goals_end_with_their_agent() -> None:
    async def test(lab: Lab) -> None:
        goal = lab.session().achieve("bob", "search")
        await asyncio.sleep(0.1)
        lab.mas.agent("bob").kill()
        await goal.wait()
        assert (goal.state, goal.message) == ("failed", "agent bob has ended")
        assert lab.session().agents() == []

    run(test)


def test_callers_see_their_own_goals_and_operators_all() -> None:
    async def test(lab: Lab) -> None:
        anna, bert, root = lab.session(), lab.session("bert"), lab.session("root", "operator")
        heard = list[Event]()
        bert.listen(heard.append)
        goal = anna.achieve("bob", "search")
        assert anna.goals() == root.goals() == [goal]
        assert bert.goals() == []
        refused(lambda: bert.cancel(goal.id), "unknown_goal")
        await asyncio.sleep(0.1)
        assert heard == []
        assert root.cancel(goal.id) is goal

    run(test)


def test_a_motion_has_ended_when_its_goal_is_cancelled() -> None:
    program = """
    { include("$jacaros/artifacts.asl") }
    { offer(goal, drive) }
    +!drive <- !use_artifact("wheels", "ArtCmdVel", []); move(1000).
    """

    async def test(lab: Lab) -> None:
        goal = lab.session().achieve("bob", "drive")
        await asyncio.sleep(3)
        robot = next(iter(lab.mas.world.robots.values()))
        assert robot.speed > 0.05
        goal.cancel()
        await goal.wait()
        await asyncio.sleep(0.6)  # it brakes with 0.8 m/s2
        assert goal.state == "cancelled"
        assert abs(robot.speed) < 1e-3

    run(test, program, world="patrol")


def test_of_goals_that_replace_each_other_the_newest_is_pursued() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        first = anna.achieve("bob", "search")
        await asyncio.sleep(1)
        second, third = anna.achieve("bob", "search"), anna.achieve("bob", "search")
        assert (first.state, second.state, third.state) == ("cancelling", "cancelled", "waiting")
        await first.wait()
        await asyncio.sleep(1)
        third.cancel()
        await third.wait()
        assert lab.mas.agent("bob").goals == []

    run(test)


def test_a_goal_that_is_cancelled_immediately_is_not_pursued() -> None:
    program = """
    { offer(goal, go) } { offer(event, seen) }
    +!go <- .print(going); .wait(1000); .print(gone).
    +look <- .announce(seen).
    """

    async def test(lab: Lab) -> None:
        anna = lab.session()
        goals = [anna.achieve("bob", "go")]
        goals[0].cancel()

        def in_a_step(event: Event) -> None:
            if event["event"] == "announced":
                goals.append(anna.achieve("bob", "go"))
                goals[1].cancel()

        await goals[0].wait()
        anna.listen(in_a_step)
        lab.mas.agent("bob").add_belief("look")
        await asyncio.sleep(3)
        assert [each.state for each in goals] == ["cancelled", "cancelled"]

    assert run(test, program) == []


def test_a_plan_that_forks_reports_progress_has_results_and_can_be_cancelled() -> None:
    program = """
    { offer(goal, both(n(out(number)))) }
    +!both(N) <- (!one |&| !two); N = 3.
    +!one <- .wait(1000); .progress(0.5, "one").
    @two[cleanup(tidy)] +!two <- .wait(2000); .progress(0.7, "two").
    +!tidy <- .print(tidied).
    """

    async def test(lab: Lab) -> None:
        anna = lab.session()
        notes: list[str] = []
        anna.listen(lambda event: notes.append(event["note"]))
        goal = anna.achieve("bob", "both")
        await goal.wait()
        assert (goal.state, goal.results, goal.progress) == ("achieved", {"n": 3}, 0.7)
        assert list(dict.fromkeys(notes)) == ["", "one", "two"]
        assert lab.mas.clock.elapsed == pytest.approx(2.0)
        goal = anna.achieve("bob", "both")
        await asyncio.sleep(1.5)
        goal.cancel()
        await goal.wait()
        assert goal.state == "cancelled"
        assert lab.mas.agent("bob").goals == []
        assert lab.mas.clock.elapsed == pytest.approx(3.5)

    assert run(test, program) == ["[bob] tidied"]


def test_goals_end_with_the_run() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        goals = [anna.achieve("bob", name) for name in ("search", "wash", "wash")]
        await asyncio.sleep(0.1)
        lab.mas.stop()
        await lab.mas.ended()
        for each in goals:
            await each.wait()
        assert [each.state for each in goals] == ["failed"] * 3
        refused(lambda: anna.achieve("bob", "wash"), "ended")

    run(test)


def test_the_goals_of_a_session_are_limited() -> None:
    async def test(lab: Lab) -> None:
        warden = lab.session("warden", "warden")
        for _ in range(MOST_ALIVE):
            warden.achieve("bob", "guard")
        refused(lambda: warden.achieve("bob", "guard"), "too_many_requests")
        goal = lab.session("other", "warden").achieve("bob", "guard")
        assert goal.state == "pending"
        warden.close()

    run(test)


@pytest.mark.parametrize("written", ["anything(f(X))", "anything([1, X])", "anything(X)"])
def test_inputs_have_no_variables(written: str) -> None:
    program = "{ offer(goal, anything(x)) } { offer(tell, anything(x)) } +!anything(_). +anything(_)."

    async def test(lab: Lab) -> None:
        anna = lab.session()
        refused(lambda: anna.achieve("bob", written), "invalid_arguments")
        refused(lambda: anna.tell("bob", written), "invalid_arguments")
        assert lab.mas.agent("bob").beliefs == []

    run(test, program)
