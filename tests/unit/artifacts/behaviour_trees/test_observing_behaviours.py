"""Behaviours that look at properties."""

import asyncio

import pytest
from py_trees.common import Status
from py_trees.decorators import FailureIsRunning

from jacaros.artifacts import Atom
from jacaros.artifacts.behaviour_trees import (
    HasProperty,
    PropertyCheck,
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
    check = PropertyCheck("battery", lambda level: level / 0)
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
    wait = FailureIsRunning("low", PropertyCheck("battery", lambda level: level < 20))
    await asyncio.gather(rails.runner(wait).run(), rails.at(2.55, "drain", 10))
    assert rails.clock.elapsed == pytest.approx(2.55, abs=0.011)
