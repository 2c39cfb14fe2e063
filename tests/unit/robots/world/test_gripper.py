"""Robots with a gripper take objects, carry them and put them down."""

import asyncio
from typing import Any

import pytest
from navigation_lab import Lab

from jacaros.robots.ros.errors import GoalRejected
from jacaros.robots.world import WorldError, read_world

TABLE = """\
robots:
  - {name: robot, gripper: true}
objects:
  - {name: cup, x: 0.3, y: 0.1}
  - {name: crate, x: 0.25, y: 0, radius: 0.2}
  - {name: far, x: 0.5, y: 0}
  - {name: behind, x: -0.25, y: 0}
"""


class Hand:
    """The gripper of one robot, and what it did."""

    def __init__(self, lab: Lab, prefix: str = "") -> None:
        self.world = lab.world
        self.client = lab.backend.action_client(
            f"{prefix}/gripper_controller/gripper_cmd", "control_msgs/action/GripperCommand"
        )
        self.feedback: list[Any] = []

    async def grip(self, metres: float) -> Any:
        handle = await self.client.send({"command": {"position": metres}}, self.feedback.append, 5.0)
        return (await handle.outcome()).result

    def events(self) -> list[tuple[str, str, str]]:
        events = self.world.ground_truth.events_of("picked", "placed")
        return [(event.robot, event.kind, event.data["object"]) for event in events]


def hand_without(lab: Lab, thing: str) -> Hand:
    """The gripper, where one object is not on the table."""
    lab.world.objects.by_name.pop(thing)
    return Hand(lab)


pytestmark = pytest.mark.world(TABLE)


async def test_closing_takes_the_nearest_object_in_reach_that_fits(lab: Lab) -> None:
    hand = hand_without(lab, "crate")
    result = await hand.grip(0.0)
    assert (result.stalled, result.reached_goal, result.position) == (True, False, 0.06)
    assert hand.events() == [("robot", "picked", "cup")]
    assert [message.stalled for message in hand.feedback] == [False, False, False, True]
    assert (await hand.grip(0.0)).stalled, "it is still between the fingers"


@pytest.mark.world(TABLE, None, "faults:\n  f: {kind: missed_grasp, at: 0, for: 5}\n")
async def test_a_missed_grasp_closes_on_nothing(lab: Lab) -> None:
    hand = hand_without(lab, "crate")

    def states() -> list[str]:
        return [each.data["state"] for each in lab.world.log if each.kind == "fault"]

    assert states() == ["begins"]
    result = await hand.grip(0.0)
    assert (result.stalled, result.reached_goal, result.position) == (False, True, 0.0)
    await hand.grip(0.1)
    await lab.clock.sleep(5.0)
    assert states() == ["begins", "acts", "ends"]
    assert hand.events() == []
    assert (await hand.grip(0.0)).stalled


async def test_an_object_that_is_too_wide_is_not_taken(lab: Lab) -> None:
    hand = hand_without(lab, "cup")
    result = await hand.grip(0.0)
    assert (result.stalled, result.reached_goal, result.position) == (False, True, 0.0)
    assert hand.events() == []


async def test_a_carried_object_moves_along_and_is_put_down_in_front(lab: Lab) -> None:
    hand = hand_without(lab, "crate")
    await hand.grip(0.0)
    await lab.drive(3.0, 0.3)
    await lab.clock.sleep(1.0)
    x = lab.world.robot().x
    assert lab.world.objects.by_name["cup"].place == (pytest.approx(x + 0.22), pytest.approx(0.0))
    result = await hand.grip(0.1)
    assert (result.stalled, result.reached_goal) == (False, True)
    placed = lab.world.ground_truth.events_of("placed")[0]
    assert placed.data == {"object": "cup", "x": pytest.approx(x + 0.22), "y": pytest.approx(0.0)}
    assert lab.world.objects.held_by(lab.world.robot()) is None


@pytest.mark.world(TABLE + "doors:\n  - {name: locker, segment: [[0.2, -1], [0.2, 1]]}\n")
async def test_grippers_do_not_reach_through_closed_doors(lab: Lab) -> None:
    hand = hand_without(lab, "crate")
    assert not (await hand.grip(0.0)).stalled
    await hand.grip(0.1)
    assert lab.world.move_door("locker", opened=True) is None
    assert (await hand.grip(0.0)).stalled
    assert hand.events() == [("robot", "picked", "cup")]


FACING = """\
robots:
  - {name: a, gripper: true}
  - {name: b, namespace: b, gripper: true, pose: {x: 0.6, yaw_degrees: 180}}
objects:
  - {name: cup, x: 0.3, y: 0}
"""


@pytest.mark.world(FACING)
async def test_two_robots_do_not_take_the_same_object(lab: Lab) -> None:
    hand, other = Hand(lab), Hand(lab, "/b")
    results = await asyncio.gather(hand.grip(0.0), other.grip(0.0))
    assert [result.stalled for result in results] == [True, False]
    assert hand.events() == [("a", "picked", "cup")]


async def test_a_newer_goal_preempts_and_an_invalid_position_is_rejected(lab: Lab) -> None:
    hand = Hand(lab)
    first = await hand.client.send({"command": {"position": 0.0}}, None, 5.0)
    await lab.clock.sleep(0.15)
    assert (await hand.grip(0.1)).position == 0.1
    assert (await first.outcome()).status.name == "ABORTED"
    assert hand.events() == []
    with pytest.raises(GoalRejected, match="not a finite number"):
        await hand.grip(float("nan"))


@pytest.mark.world(TABLE.replace(", gripper: true", ""))
async def test_a_robot_without_a_gripper_has_no_gripper_action(lab: Lab) -> None:
    assert not any("gripper" in name for name in (await lab.backend.contents()).actions)


def test_two_objects_must_differ_in_name() -> None:
    with pytest.raises(WorldError, match="duplicate object 'cup'"):
        read_world(TABLE.replace("name: far", "name: cup"))
    assert read_world(TABLE.replace("gripper: true", "gripper: {reach: 0.5}")).robots[0].gripper_reach == 0.5
