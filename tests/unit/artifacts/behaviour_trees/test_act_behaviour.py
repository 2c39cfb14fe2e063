"""``Act``: operations as behaviours."""

import asyncio

import pytest
from py_trees.blackboard import Blackboard
from py_trees.common import Status

from jacaros.artifacts import Out, Structure
from jacaros.artifacts.behaviour_trees import (
    Act,
    Failure,
    FromBlackboard,
    HasProperty,
    PropertyCheck,
    ToBlackboard,
)


async def test_an_operation_runs_and_succeeds(rails):
    drive = Act("drive", 3)
    assert await rails.runner(drive).run() is Status.SUCCESS
    assert drive.outcome.ok
    assert rails.session.value("at") == 3
    assert rails.clock.elapsed == pytest.approx(3.0, abs=0.01)


async def test_a_short_operation_succeeds_in_its_first_tick(rails):
    await rails.runner(Act("drain", 5)).run()
    assert (rails.ticks, rails.session.value("battery")) == ([0], 5)


async def test_while_it_is_under_way_the_tree_runs(rails):
    drive = Act("drive", 2)
    runner = rails.runner(drive)
    seen = []
    runner.tree.add_post_tick_handler(lambda tree: seen.append((drive.status, drive.feedback_message)))
    await runner.run()
    assert set(seen) == {(Status.RUNNING, "running"), (Status.SUCCESS, "")}


async def test_a_failure_logs_its_reason_and_writes_it_to_the_blackboard(rails):
    drive = Act("drive", 20, name="to the end")
    assert await rails.runner(drive).run() is Status.FAILURE
    assert drive.feedback_message == "a wall [aborted(10)]"
    reason = Structure("aborted", (10,))
    assert (Blackboard.get("failure"), Blackboard.get("failure.reason")) == (
        Failure("to the end", "a wall", reason),
        reason,
    )


@pytest.mark.parametrize(
    ("act", "told"),
    [
        (lambda: Act("fly"), "has an operation fly/0 [unknown_operation"),
        (lambda: Act("drive"), "drive/0; did you mean `drive/1` of 'cart'?"),
        (lambda: Act("drive", "far"), "metres"),
        (lambda: Act("drive", 1, artifact="plane"), "unknown artifact `plane`"),
        (lambda: Act("break_down"), "no wheels"),
        (lambda: Act("drive", FromBlackboard("far")), "the blackboard has no key `far` [not_on_blackboard"),
        (lambda: Act("wait_for_ever", timeout=2), "did not end within 2 s [operation_timeout"),
    ],
)
async def test_whatever_is_wrong_is_a_failure_with_its_reason(rails, act, told):
    behaviour = act()
    assert await rails.runner(behaviour).run() is Status.FAILURE
    assert told in behaviour.feedback_message
    assert behaviour.feedback_message.startswith(Blackboard.get("failure.message"))


@pytest.mark.parametrize(
    ("act", "told"),
    [
        (
            lambda: Act("drive"),
            [
                (
                    "[tree] behaviour 'drive': no artifact of workspace /main has an operation drive/0; "
                    "did you mean `drive/1` of 'cart'?"
                )
            ],
        ),
        (lambda: Act("drive", 20), []),
    ],
)
async def test_a_mistake_in_the_tree_is_logged_once(rails, act, told):
    runner = rails.runner(act())
    rails.clock.call_later(30, runner.stop)
    await runner.run(forever=True)
    assert rails.told == told


async def test_it_starts_again_when_it_is_ticked_again(rails):
    runner = rails.runner(Act("drive", 2))
    runner.tree.add_post_tick_handler(lambda _: rails.session.value("at") == 4 and runner.stop())
    await runner.run(forever=True)
    assert rails.clock.elapsed == pytest.approx(4.1, abs=0.02)  # it rests a period between two rounds


async def test_an_interrupted_operation_is_cancelled(rails, reactive):
    drive = Act("drive", 9)
    root = reactive("sequence", PropertyCheck("battery", lambda level: level > 20), drive)
    status, _ = await asyncio.gather(rails.runner(root).run(), rails.at(2.5, "drain", 10))
    assert status is Status.FAILURE
    assert drive.status is Status.INVALID
    assert drive.feedback_message == "cancelled"
    await rails.session.until(lambda: rails.session.value("moving") == "stopped")
    assert rails.session.value("at") == 2
    assert rails.clock.elapsed == pytest.approx(2.5, abs=0.02)


async def test_what_takes_its_place_begins_when_it_has_ended(rails, reactive):
    low = reactive(
        "sequence", HasProperty("battery", 10), Act("paint", "red"), Act("where", ToBlackboard("place"))
    )
    root = reactive("selector", low, Act("drive", 9))
    await asyncio.gather(rails.runner(root).run(), rails.at(2.5, "drain", 10))
    assert Blackboard.get("place") == 2


async def test_arguments_and_results_go_by_the_blackboard(rails, reactive):
    Blackboard.set("goal", Out())
    Blackboard.get("goal").set(4)
    drive = Act("drive", FromBlackboard("goal.value"))
    where = Act("where", ToBlackboard("place"))
    assert await rails.runner(reactive("sequence", drive)).run() is Status.SUCCESS
    assert await rails.runner(where).run() is Status.SUCCESS
    assert [drive.name, where.name] == ["drive(goal.value)", "where(-> place)"]
    assert where.feedback_message == "place = 4"
    assert Blackboard.get("place") == 4


async def test_the_artifact_can_be_named(rails):
    first = rails.other.lookup("cart")
    await rails.make_cart("second")
    await rails.runner(Act("drain", 1, artifact="second")).run()
    await rails.runner(Act("drain", 2, artifact=first)).run()
    rails.session.focus("second")
    assert [rails.session.value("battery", artifact=name) for name in ("cart", "second")] == [2, 1]


async def test_an_artifact_disposed_under_way_is_a_failure(rails):
    async def dispose():
        await rails.clock.sleep(1.5)
        await rails.other.act("disposeArtifact", rails.other.lookup("cart"))

    drive = Act("drive", 9)
    status, _ = await asyncio.gather(rails.runner(drive).run(), dispose())
    assert status is Status.FAILURE
    assert "artifact_disposed" in drive.feedback_message
    assert await rails.runner(drive).run() is Status.FAILURE
    assert "drive/1" in drive.feedback_message


def test_without_a_session_the_error_has_help():
    with pytest.raises(
        TypeError, match=r"behaviour `drive\(1\)` has no session; tick its tree with a TreeRunner"
    ):
        Act("drive", 1).setup()


def test_names_show_the_call():
    assert Act("say", "hello", 1.0).name == 'say("hello", 1)'
    assert Act("stop").name == "stop"
    assert Act("stop", name="halt").name == "halt"
