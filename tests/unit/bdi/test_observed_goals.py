"""What observers are told of goals: each begins once and ends once."""

from collections import Counter
from pathlib import Path

import pytest
from recording_host import mind

from jacaros.bdi.act import Act, Completion
from jacaros.bdi.intention import SERIAL
from jacaros.bdi.meta_events import observe_goals
from jacaros.inspector.goal_news import GoalNews

CASES = Path(__file__).parents[2] / "conformance"
BEGUN = ("pursued", "suspended", "resumed")


def test_an_observer_hears_of_every_change_of_a_goal() -> None:
    host = mind("!a. +!a <- !b; .wait(10); .suspend(a); .print(x). +!b <- .fail. -!b.")
    heard: list[tuple[str, str]] = []
    observe_goals(host.agent, lambda state, goal, number, intention, why: heard.append((state, goal)))
    host.run()
    states = [state for state, goal in heard if goal == "!a"]
    assert states == ["executing", "waiting", "executing", "suspended"]
    assert [state for state, goal in heard if goal == "!b"] == [
        "executing",
        "failed",
        "executing",
        "recovered",
        "finished",
    ]


def goals_at_the_end(program):
    """The last text and state of each goal of a program, by number."""
    host, last = mind(program), {}
    news = GoalNews(lambda goal: last.update({goal["id"]: f"{goal['state']} {goal['goal']}"}))
    observe_goals(host.agent, lambda *change: news("bob", *change))
    host.run()
    return list(last.values())


def test_a_goal_whose_variables_get_values_stays_one_goal():
    assert goals_at_the_end("!a. +!a <- !ask(X). +!ask(X) <- X = 3.") == ["achieved !a", "achieved !ask(3)"]


def test_a_goal_that_a_tail_call_replaces_ends():
    program = "!loop(1). +!loop(N) : N < 3 <- !loop(N + 1). +!loop(_)."
    assert goals_at_the_end(program) == ["replaced !loop(1)", "replaced !loop(2)", "achieved !loop(3)"]


def test_goals_below_a_handled_failure_failed_and_the_handled_one_recovered():
    program = "!try. +!try <- !inner. -!try. +!inner <- .fail."
    assert goals_at_the_end(program) == ["recovered !try", "failed !inner"]


def test_a_goal_without_a_plan_whose_failure_plan_ends_has_recovered():
    assert goals_at_the_end("!a. +!a <- !b(1). -!b(_) <- .wait(1).") == ["achieved !a", "recovered !b(1)"]
    assert goals_at_the_end("!b(1). -!b(_) <- .wait(1).") == ["recovered !b(1)"]


def test_goals_whose_failure_plan_fails_have_failed():
    program = "!a. +!a <- !b. -!b <- !c. +!c <- .fail."
    assert goals_at_the_end(program) == ["failed !a", "failed !b", "failed !c"]
    assert goals_at_the_end("!a. +!a <- .fail. -!a : false.") == ["failed !a"]


def test_the_goals_of_a_branch_end_with_it_and_those_around_the_fork_go_on():
    program = "!a(1). +!a(N) <- !b(N) ||| !c(X); .wait(10). +!b(_) <- .wait(20). +!c(3) <- .wait(5)."
    assert goals_at_the_end(program) == ["achieved !a(1)", "dropped !b(1)", "achieved !c(3)"]
    program = "!a(1). +!a(N) <- !b(N) |&| !c(X); .wait(10). +!b(_) <- .wait(20). +!c(3) <- .wait(5)."
    assert goals_at_the_end(program) == ["achieved !a(1)", "achieved !b(1)", "achieved !c(3)"]
    program = "!a(1). +!a(N) <- !b(N) ||| !c(X). +!b(_) <- .wait(20). +!c(3) <- !d. +!d <- .fail."
    assert goals_at_the_end(program) == ["achieved !a(1)", "achieved !b(1)", "failed !c(3)", "failed !d"]


def test_goals_that_are_steered_end():
    program = "!a. +!a <- !b; .print(x). +!b <- !c. +!c <- .wait(1000). !k. +!k <- .wait(5); .{}."
    assert goals_at_the_end(program.format("drop_intention(a)"))[:2] == ["dropped !a", "achieved !k"]
    assert sorted(goals_at_the_end(program.format("fail_goal(b)"))) == [
        "achieved !k",
        "failed !a",
        "failed !b",
        "failed !c",
    ]
    assert sorted(goals_at_the_end(program.format("succeed_goal(b)"))) == [
        "achieved !a",
        "achieved !b",
        "achieved !k",
        "dropped !c",
    ]


@pytest.mark.parametrize(
    "case", sorted(CASES.rglob("*.asl")), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_every_goal_ends_once_unless_it_is_pursued_still(case: Path) -> None:
    if "syntax_errors" in case.parts or not case.with_suffix(".expected").exists():
        return
    ends: Counter[int] = Counter()
    last: dict[int, str] = {}

    def tell(goal: dict[str, object]) -> None:
        number, state = goal["id"], goal["state"]
        assert isinstance(number, int)
        assert not ends[number], goal
        last[number] = str(state)
        ends[number] += state not in (*BEGUN, "failed")

    host = mind(case.read_text(), name=case.stem, path=str(case), complete=no_environment)
    news = GoalNews(tell)
    observe_goals(host.agent, lambda *change: news("bob", *change))
    host.run()
    begun = {which for _, which in news._goals}
    alive = {frame[SERIAL] for intention in host.agent.alive.values() for frame in intention.frames}
    assert begun <= alive
    assert len([state for state in last.values() if state in BEGUN]) == len(begun)


def no_environment(act: Act) -> Completion:
    del act
    return Completion(success=False)
