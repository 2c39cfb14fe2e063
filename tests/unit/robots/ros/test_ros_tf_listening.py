"""Listening to transforms: reports, bad messages, clocks that go back."""

import asyncio
from typing import Any

import pytest
from graph_lab import GraphLab

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import TransformUnavailable


class Lab(GraphLab):
    """A node that sends, and one that listens."""

    async def open(self) -> tuple[Backend, Backend]:
        robot, brain = await self.node("robot"), await self.node("brain")
        brain.tf_listen()
        return robot, brain


def stamped(x: float, stamp: float, child: str = "base", **rotation: float) -> dict[str, Any]:
    transform = {"translation": {"x": x}, "rotation": rotation}
    return {"header": {"frame_id": "odom", "stamp": stamp}, "child_frame_id": child, "transform": transform}


async def test_a_short_wait_is_silent_and_a_long_one_is_logged(lab: Lab) -> None:
    robot, brain = await lab.open()
    for delay in (0.5, 5.0):
        target = lab.clock.now() + delay
        waiting = asyncio.get_running_loop().create_task(brain.tf_wait("odom", "base", target))
        await lab.clock.sleep(delay)
        robot.tf_broadcast(stamped(1.0, target))
        assert (await waiting).stamp == pytest.approx(target)
    assert lab.log == [
        "waiting for the transform from base to odom",
        "the transform from base to odom is missing; still trying; is the node that publishes it running?",
        "found the transform from base to odom",
    ]


async def test_waiting_for_the_past_ends_immediately(lab: Lab) -> None:
    robot, brain = await lab.open()
    robot.tf_broadcast(stamped(1.0, 100.0))
    await lab.clock.sleep(0.0)
    with pytest.raises(TransformUnavailable) as caught:
        await brain.tf_wait("odom", "base", 99.0)
    assert caught.value.reason == "too_old"
    assert lab.clock.elapsed == 0.0


async def test_a_wait_whose_moment_has_passed_meanwhile_ends(lab: Lab) -> None:
    robot, brain = await lab.open()
    waiting = asyncio.get_running_loop().create_task(brain.tf_wait("odom", "base", 99.0, timeout=60.0))
    await lab.clock.sleep(0.1)
    robot.tf_broadcast(stamped(1.0, 100.0))
    with pytest.raises(TransformUnavailable) as caught:
        await waiting
    assert (caught.value.reason, round(lab.clock.elapsed, 3)) == ("too_old", 0.1)


async def test_a_bad_transform_is_logged_once(lab: Lab) -> None:
    robot, brain = await lab.open()
    for stamp in (1.0, 2.0):
        robot.tf_broadcast(stamped(float("nan"), stamp))
        robot.tf_broadcast(stamped(1.0, stamp, child="arm", w=0.5))
    await lab.clock.sleep(0.0)
    assert lab.log == [
        "/tf: transform of frame base contains NaN or infinity; transform ignored",
        "/tf: rotation of frame arm is not a unit quaternion: (0.0, 0.0, 0.0, 0.5); transform ignored",
    ]
    with pytest.raises(TransformUnavailable, match="no transforms have arrived"):
        brain.tf_lookup("odom", "base")


async def test_a_clock_that_goes_back_empties_the_buffer(lab: Lab) -> None:
    robot, brain = await lab.open()
    robot.tf_broadcast({**stamped(0.5, 0.0, child="wheel"), "header": {"frame_id": "base"}}, static=True)
    await lab.clock.sleep(30.0)
    robot.tf_broadcast(stamped(1.0, 30.0))
    await lab.clock.sleep(0.0)
    assert brain.tf_lookup("odom", "wheel").translation[0] == 1.5
    lab.clock.elapsed -= 0.05  # a correction
    robot.tf_broadcast(stamped(2.0, 29.95))
    await lab.clock.sleep(0.0)
    assert lab.log == []
    lab.clock.elapsed -= 20.0
    robot.tf_broadcast(stamped(3.0, 9.95))
    await lab.clock.sleep(0.0)
    assert lab.log == ["the clock went back by 20 s; the transforms known so far are forgotten"]
    found = brain.tf_lookup("odom", "wheel")
    assert (found.translation[0], found.stamp) == (3.5, pytest.approx(9.95))
