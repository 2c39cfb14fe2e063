"""Behaviours that look at properties and hear signals."""

import asyncio

import pytest
from py_trees.blackboard import Blackboard
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Sequence

from jacaros.artifacts import Atom
from jacaros.artifacts.behaviour_trees import (
    Act,
    HasProperty,
    OnSignal,
    PropertiesToBlackboard,
    PropertyCheck,
    Timer,
    WaitForProperty,
    WaitForSignal,
)


def status_of(on_rails, behaviour):
    """How a behaviour ends, and what it says."""

    async def scene(rails):
        return await rails.runner(behaviour).run(), behaviour.feedback_message, rails.told

    return on_rails(scene)


@pytest.mark.parametrize(
    ("behaviour", "status", "feedback"),
    [
        (lambda: PropertyCheck("battery", lambda level: level > 20), Status.SUCCESS, "battery(100)"),
        (lambda: PropertyCheck("battery", lambda level: level < 20), Status.FAILURE, "battery(100)"),
        (lambda: PropertyCheck("battery"), Status.SUCCESS, "battery(100)"),
        (lambda: PropertyCheck("baterry"), Status.FAILURE, "did you mean `battery`"),
        (lambda: PropertyCheck("battery", artifact="cart"), Status.SUCCESS, "battery(100)"),
        (lambda: PropertyCheck("battery", artifact="crat"), Status.FAILURE, "did you mean `cart`"),
        (lambda: HasProperty("moving", "stopped"), Status.SUCCESS, "moving(stopped)"),
        (lambda: HasProperty("moving", Atom("driving")), Status.FAILURE, "moving(stopped)"),
        (lambda: HasProperty("moving"), Status.SUCCESS, "moving(stopped)"),
        (lambda: HasProperty("moving", "stopped", 1), Status.FAILURE, "moving(stopped)"),
    ],
)
def test_conditions(on_rails, behaviour, status, feedback):
    found, said, told = status_of(on_rails, behaviour())
    assert found is status
    assert feedback in said
    assert told == []


async def test_of_several_properties_one_that_fits_is_enough(rails):
    for colour in ("red", "green"):
        await rails.other.act("paint", colour)
    green, blue = (PropertyCheck("colour", lambda c, wanted=w: c == wanted) for w in ("green", "blue"))
    assert await rails.runner(green).run() is Status.SUCCESS
    assert await rails.runner(blue).run() is Status.FAILURE
    assert blue.feedback_message == 'colour("red"), colour("green")'


async def test_a_predicate_that_raises_is_a_failure_logged_once(rails):
    check = WaitForProperty("battery", lambda level: level / 0)
    runner = rails.runner(check, period=0.1)
    runner.tree.add_post_tick_handler(lambda tree: tree.count == 20 and runner.stop())
    assert await runner.run(forever=True) is Status.FAILURE
    told = rails.told
    assert check.feedback_message == "the predicate raised ZeroDivisionError: division by zero"
    assert told[0] == "[tree] behaviour 'battery?': the predicate failed:"
    assert any("test_observing_behaviours.py" in line for line in told)
    assert sum("the predicate failed" in line for line in told) == 1


def test_a_predicate_for_other_values_is_a_failure(on_rails):
    status, feedback, _ = status_of(on_rails, PropertyCheck("battery", lambda level, more: True))
    assert status is Status.FAILURE
    assert "missing 1 required positional argument: 'more'" in feedback


async def test_an_awaited_property_is_noticed_immediately(rails):
    wait = WaitForProperty("battery", lambda level: level < 20)
    await asyncio.gather(rails.runner(wait).run(), rails.at(2.55, "drain", 10))
    assert rails.clock.elapsed == pytest.approx(2.55, abs=0.011)


async def test_properties_go_to_the_blackboard(rails):
    copy = PropertiesToBlackboard({"battery": "power", "at": "place", "colour": "colour"})
    await rails.runner(copy).run()
    assert Blackboard.storage == {"/power": 100, "/place": 0}
    assert copy.feedback_message == "no focused artifact has colour"
    await rails.other.act("paint", "red")
    await rails.runner(copy).run()
    assert Blackboard.storage == {"/power": 100, "/place": 0, "/colour": "red"}
    assert copy.feedback_message == ""
    await rails.other.act("disposeArtifact", rails.other.lookup("cart"))
    await rails.runner(PropertiesToBlackboard("battery")).run()
    await rails.runner(copy).run()
    assert Blackboard.storage == {}


async def test_a_signal_is_received_once(rails, reactive):
    heard = []
    bump = OnSignal("bump", to="bump")
    runner = rails.runner(bump)
    runner.tree.add_post_tick_handler(lambda tree: heard.append((rails.clock.elapsed, bump.status)))

    async def bumps():
        await rails.at(1.03, "bump", "left")
        await rails.other.act("bump", "right")
        await rails.clock.sleep(1)
        runner.stop()

    await asyncio.gather(runner.run(forever=True), bumps())
    assert Blackboard.get("bump") == ("right",)
    # Both came between two ticks.
    assert [round(moment, 2) for moment, status in heard if status is Status.SUCCESS] == [1.03]


async def test_a_signal_in_the_middle_of_a_long_branch_is_not_missed(rails):
    bump = OnSignal("bump", lambda side: side == "left")
    root = Sequence("s", memory=True, children=[Act("drive", 3), bump])
    status, *_ = await asyncio.gather(
        rails.runner(root).run(), rails.at(1.5, "bump", "left"), rails.at(1.7, "bump", "right")
    )
    assert (status, bump.feedback_message) == (Status.SUCCESS, 'bump("left")')


async def test_waiting_for_a_signal_begins_with_its_first_tick(rails):
    bump = WaitForSignal("bump", to="side")
    root = Sequence("s", memory=True, children=[Act("drive", 3), bump])
    await asyncio.gather(
        rails.runner(root).run(), rails.at(1.5, "bump", "left"), rails.at(4.2, "bump", "right")
    )
    assert Blackboard.get("side") == ("right",)
    assert rails.clock.elapsed == pytest.approx(4.2, abs=0.011)


async def test_signals_of_other_names_and_artifacts_are_skipped(rails):
    await rails.make_cart("second")
    rails.session.focus("second")
    waits = [WaitForSignal("crash"), WaitForSignal("bump", artifact="second"), Timer(3)]
    root = Parallel("p", ParallelPolicy.SuccessOnOne(), children=waits)
    await asyncio.gather(rails.runner(root).run(), rails.at(1, "bump", "left"))
    assert ([each.status for each in waits], waits[0].feedback_message) == (
        [Status.INVALID, Status.INVALID, Status.SUCCESS],
        "no crash",
    )


async def test_a_predicate_of_a_signal_that_raises_is_a_failure(rails):
    bump = WaitForSignal("bump", lambda side: side.colour)
    status, _ = await asyncio.gather(rails.runner(bump).run(), rails.at(1, "bump", "left"))
    assert status is Status.FAILURE
    assert (
        bump.feedback_message == "the predicate raised AttributeError: 'str' object has no attribute 'colour'"
    )
    assert rails.told[0] == "[tree] behaviour 'bump!': the predicate failed:"


async def test_nothing_is_received_after_the_end(rails):
    calls = []
    bump = OnSignal("bump", calls.append)
    await rails.runner(bump).run()
    await rails.other.act("bump", "left")
    assert calls == []
