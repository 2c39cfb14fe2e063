"""Odometry at 1 kHz: the agent reacts to the current value."""

from typing import Any

import pytest
from faults_lab import Lab, in_lab

ODOMETRY = "nav_msgs/msg/Odometry"


def flood(lab: Lab) -> None:
    """Tell the robot's true place a thousand times a second, each number once."""
    end = lab.clock.elapsed + 4.0
    publisher = lab.node().publisher("/fast_odom", ODOMETRY)

    def tick() -> None:
        robot = lab.world.robot()
        lab.sim.time.catch_up()
        pose: Any = {
            "pose": {"position": {"x": robot.x + 1e-7 * lab.clock.elapsed}, "orientation": {"w": 1.0}}
        }
        header = {"frame_id": "odom", "stamp": lab.clock.now()}
        publisher.publish(publisher.message(header=header, pose=pose))
        if lab.clock.elapsed < end:
            lab.clock.call_later(0.001, tick)

    tick()


def test_a_busy_agent_stops_its_robot_at_the_right_place() -> None:
    lab = in_lab("meeting.asl", flood, seconds=5)
    place, _, thoughts = lab.lines[0].removeprefix("seen at ").removesuffix(" thoughts").partition(" after ")
    seen = float(place)
    # A thought takes 2 ms and more; there were 140 messages, and each would be thought about with latest_only(false).
    assert 5 <= int(thoughts) <= 40
    assert lab.lines[1].startswith("stopped aborted(")
    # At 0.65 m/s a message is 0.65 mm; the true place has 20 ms steps of 13 mm.
    assert seen == pytest.approx(1.0, abs=0.02)
    assert lab.stands(4.0, 5.0)
    assert lab.safe
    braking = lab.place[0] - seen
    assert 0.0 <= braking < 0.45, "0.65 m/s and 0.5 m/s2"
    assert lab.errors == []
