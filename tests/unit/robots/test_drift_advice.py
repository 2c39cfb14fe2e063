"""One line of advice where a robot drives by odometry alone, and localisation finds it elsewhere."""

import math
import re
from types import SimpleNamespace
from typing import Any

import pytest
from robot_lab import Lab, in_lab

from jacaros.artifacts import Structure
from jacaros.robots.artifacts import odometry as drift
from jacaros.robots.artifacts.drive_model import Velocity
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.plane.pose import Pose

SLIPPERY = """
seed: 3
robots:
  - {name: turtlebot, odometry: {noise_per_metre: 0.05, noise_degrees_per_turn: 5, noise_degrees_per_metre: 3}}
"""
EXACT = "robots: [{name: turtlebot}]\nseed: 1\n"
ADVICE = re.compile(
    r"note: odometry and localisation have drifted 0\.\d\d m and \d+\.\d degrees apart; "
    r"the option `frame\(map\)` corrects it"
)


def advice(lab: Lab) -> list[str]:
    return [text for text in lab.logged if "localisation" in text]


async def around(lab: Lab, *options: object) -> None:
    wheels = await lab.make(ArtCmdVel, *options)
    for x, y in ((1, 0), (1, 1), (0, 1), (0, 0)) * 2:
        await lab.do(wheels, "driveTo", x, y)


def test_a_drift_of_more_than_five_centimetres_is_noted_once_and_no_goal_fails() -> None:
    lab = in_lab(around, SLIPPERY)
    assert len(advice(lab)) == 1
    assert ADVICE.search(advice(lab)[0]), advice(lab)


def test_an_exact_floor_gets_no_advice() -> None:
    assert not advice(in_lab(around, EXACT))


def test_a_robot_that_follows_the_map_gets_no_advice() -> None:
    assert not advice(in_lab(lambda lab: around(lab, Structure("frame", ("map",))), SLIPPERY))


def test_a_robot_that_stands_gets_no_advice_whatever_moves_it() -> None:
    async def body(lab: Lab) -> None:
        await lab.make(ArtCmdVel)
        twist = lab.backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(400):
            twist.publish({"linear": {"x": 0.5}, "angular": {"z": 0.5}})
            await lab.sleep(0.1)

    assert not advice(in_lab(body, SLIPPERY))


def test_a_pose_that_is_set_by_hand_does_not_count_as_drift() -> None:
    async def body(lab: Lab) -> None:
        wheels = await lab.make(ArtCmdVel)
        await lab.do(wheels, "moveForward", 0.5)
        place = lab.backend.publisher("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        pose = {"position": {"x": 2.0, "y": 1.0}, "orientation": {"w": 1.0}}
        place.publish({"header": {"frame_id": "map"}, "pose": {"pose": pose}})
        await lab.do(wheels, "moveForward", 0.5)

    assert not advice(in_lab(body, EXACT))


class Wheels:
    """Odometry of a robot that drives and turns, and poses of a localisation that is late."""

    def __init__(self) -> None:
        self.noted: list[str] = []
        self.newest: Any = None
        self.driving = self.trusted = True
        self.drift = drift.Drift(Graph(), self, lambda: self.driving, self.noted.append)  # type: ignore[arg-type]

    def at(self, moment: float) -> tuple[float, float, float]:
        """On a circle: 0.5 m/s, 1 rad/s."""
        return 0.5 * math.sin(moment), 0.5 - 0.5 * math.cos(moment), moment

    def odometry(self, moment: float) -> None:
        x, y, heading = self.at(moment)
        stamp = SimpleNamespace(sec=math.floor(moment), nanosec=round(moment % 1.0 * 1e9))
        message = SimpleNamespace(header=SimpleNamespace(stamp=stamp))
        pose, velocity = Pose(x, y, heading), Velocity(0.5, 1.0)
        self.newest = SimpleNamespace(pose=pose, velocity=velocity, sample=SimpleNamespace(message=message))

    def localised(self, moment: float, off: float = 0.0) -> None:
        """A pose of this moment, *off* metres beside the true one."""
        x, y, heading = self.at(moment)
        stamp = SimpleNamespace(sec=math.floor(moment), nanosec=round(moment % 1.0 * 1e9))
        turn = SimpleNamespace(x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))
        pose = SimpleNamespace(position=SimpleNamespace(x=x + off, y=y), orientation=turn)
        message = SimpleNamespace(header=SimpleNamespace(stamp=stamp), pose=SimpleNamespace(pose=pose))
        self.drift.take(SimpleNamespace(message=message))  # type: ignore[arg-type]


class Graph:
    """A graph, by its identity."""


@pytest.mark.parametrize("late", [0.0, 0.1, 0.2])
def test_a_pose_that_is_computed_late_is_compared_with_odometry_of_its_time(late: float) -> None:
    wheels = Wheels()
    for tick in range(200):
        wheels.odometry(10.0 + 0.05 * tick)
        wheels.localised(10.0 + 0.05 * tick - late)
    assert wheels.noted == []
    wheels.localised(19.95 - late, off=0.06)
    assert len(wheels.noted) == 1


def test_a_pose_far_from_the_time_of_odometry_is_not_compared() -> None:
    wheels = Wheels()
    wheels.localised(9.0)
    wheels.odometry(10.0)
    wheels.localised(10.0)
    for moment in (8.0, 10.2, 12.0, math.nan):
        wheels.localised(moment if moment == moment else 1e6, off=0.1)
    assert wheels.noted == []
    wheels.localised(10.0, off=0.1)
    assert len(wheels.noted) == 1


def test_a_leap_begins_anew_and_the_tolerance_counts_from_there() -> None:
    wheels = Wheels()
    wheels.odometry(10.0)
    for off in (0.0, 0.04, 1.0, 1.04):
        wheels.localised(10.0, off)
        assert wheels.noted == []
    wheels.driving = False
    wheels.localised(10.0, 1.1)
    assert wheels.noted == []
    wheels.driving = True
    wheels.localised(10.0, 1.1)
    wheels.localised(10.0, 1.2)
    assert len(wheels.noted) == 1, "once"
