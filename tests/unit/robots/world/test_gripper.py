"""Robots with a gripper take objects, carry them and put them down."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import GoalRejected
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World, WorldError, read_world
from jacaros.runtime.clock import VirtualClock, run

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

    def __init__(self, backend: Backend, world: World, clock: VirtualClock, prefix: str = "") -> None:
        self.world, self.clock = world, clock
        self.client = backend.action_client(
            f"{prefix}/gripper_controller/gripper_cmd", "control_msgs/action/GripperCommand"
        )
        self.feedback: list[Any] = []

    async def grip(self, metres: float) -> Any:
        handle = await self.client.send({"command": {"position": metres}}, self.feedback.append, 5.0)
        return (await handle.outcome()).result

    def events(self) -> list[tuple[str, str, str]]:
        events = self.world.ground_truth.events_of("picked", "placed")
        return [(event.robot, event.kind, event.data["object"]) for event in events]


def with_hand(body: Callable[[Hand, Backend], Awaitable[None]], text: str = TABLE) -> World:
    """Run *body* beside a world."""
    clock, world = VirtualClock(), World.load(text)

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        node = SimNode(world, backend, clock)
        node.start()
        await body(Hand(backend, world, clock), backend)
        node.close()
        await backend.close()

    run(main, clock)
    return world


def test_closing_takes_the_nearest_object_in_reach_that_fits() -> None:
    async def body(hand: Hand, backend: Backend) -> None:
        hand.world.objects.by_name.pop("crate")
        result = await hand.grip(0.0)
        assert (result.stalled, result.reached_goal, result.position) == (True, False, 0.06)
        assert hand.events() == [("robot", "picked", "cup")]
        assert [message.stalled for message in hand.feedback] == [False, False, False, True]
        assert (await hand.grip(0.0)).stalled, "it is still between the fingers"

    with_hand(body)


def test_an_object_that_is_too_wide_is_not_taken() -> None:
    async def body(hand: Hand, backend: Backend) -> None:
        hand.world.objects.by_name.pop("cup")
        result = await hand.grip(0.0)
        assert (result.stalled, result.reached_goal, result.position) == (False, True, 0.0)
        assert hand.events() == []

    with_hand(body)


def test_a_carried_object_moves_along_and_is_put_down_in_front() -> None:
    async def body(hand: Hand, backend: Backend) -> None:
        hand.world.objects.by_name.pop("crate")
        await hand.grip(0.0)
        publisher = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(30):
            publisher.publish(publisher.message(linear={"x": 0.3}))
            await hand.clock.sleep(0.1)
        await hand.clock.sleep(1.0)
        x = hand.world.robot().x
        assert hand.world.objects.by_name["cup"].place == (pytest.approx(x + 0.22), pytest.approx(0.0))
        result = await hand.grip(0.1)
        assert (result.stalled, result.reached_goal) == (False, True)
        placed = hand.world.ground_truth.events_of("placed")[0]
        assert placed.data == {"object": "cup", "x": pytest.approx(x + 0.22), "y": pytest.approx(0.0)}
        assert hand.world.objects.held_by(hand.world.robot()) is None

    with_hand(body)


def test_grippers_do_not_reach_through_closed_doors() -> None:
    text = TABLE + "doors:\n  - {name: locker, segment: [[0.2, -1], [0.2, 1]]}\n"

    async def body(hand: Hand, backend: Backend) -> None:
        hand.world.objects.by_name.pop("crate")
        assert not (await hand.grip(0.0)).stalled
        await hand.grip(0.1)
        assert hand.world.move_door("locker", opened=True) is None
        assert (await hand.grip(0.0)).stalled
        assert hand.events() == [("robot", "picked", "cup")]

    with_hand(body, text)


def test_two_robots_do_not_take_the_same_object() -> None:
    text = """\
robots:
  - {name: a, gripper: true}
  - {name: b, namespace: b, gripper: true, pose: {x: 0.6, yaw_degrees: 180}}
objects:
  - {name: cup, x: 0.3, y: 0}
"""

    async def body(hand: Hand, backend: Backend) -> None:
        other = Hand(backend, hand.world, hand.clock, "/b")
        results = await asyncio.gather(hand.grip(0.0), other.grip(0.0))
        assert [result.stalled for result in results] == [True, False]
        assert hand.events() == [("a", "picked", "cup")]

    with_hand(body, text)


def test_a_newer_goal_preempts_and_an_invalid_position_is_rejected() -> None:
    async def body(hand: Hand, backend: Backend) -> None:
        first = await hand.client.send({"command": {"position": 0.0}}, None, 5.0)
        await hand.clock.sleep(0.15)
        result = await hand.grip(0.1)
        assert result.position == 0.1
        assert (await first.outcome()).status.name == "ABORTED"
        assert hand.events() == []
        with pytest.raises(GoalRejected, match="not a finite number"):
            await hand.grip(float("nan"))

    with_hand(body)


def test_a_robot_without_a_gripper_has_no_gripper_action() -> None:
    async def body(hand: Hand, backend: Backend) -> None:
        assert not any("gripper" in name for name in (await backend.contents()).actions)

    with_hand(body, TABLE.replace(", gripper: true", ""))


def test_two_objects_must_differ_in_name() -> None:
    with pytest.raises(WorldError, match="duplicate object 'cup'"):
        read_world(TABLE.replace("name: far", "name: cup"))
    assert read_world(TABLE.replace("gripper: true", "gripper: {reach: 0.5}")).robots[0].gripper_reach == 0.5
