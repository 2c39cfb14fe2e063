"""Doubt about one's place: what makes a robot less sure of its pose, and how it finds it again, judged by the true pose."""

import math
from typing import Any

import pytest
from navigation_lab import Lab

from jacaros.robots.ros.qos import LATCHED

SURE = (0.0025, 0.001)
PLAIN = """
name: plain
size: [6, 6]
robots: [{name: robot}]
"""
TURTLEBOT2 = """
name: turtlebot2
size: [5, 4]
border: walls
walls: [{box: {from: [-2.5, 1], to: [-1, 2]}}, {segment: [[1, -2], [1, 0]]}]
robots: [{name: robot, kind: turtlebot2}]
"""


def poses(lab: Lab) -> list[Any]:
    return lab.hear("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped", LATCHED)


def variances(message: Any) -> tuple[float, float]:
    return float(message.pose.covariance[0]), float(message.pose.covariance[35])


def error(lab: Lab, message: Any) -> float:
    """Metres between the published and the true pose."""
    robot, place = lab.world.robot(), message.pose.pose.position
    return math.hypot(robot.x - place.x, robot.y - place.y)


def carry(lab: Lab, x: float, y: float, yaw: float = 1.0) -> None:
    lab.world.place(lab.world.robot().name, x, y, yaw)


async def relocalise(lab: Lab, service: str = "/reinitialize_global_localization") -> None:
    await lab.call(service, "std_srvs/srv/Empty")


@pytest.mark.world("house")
async def test_a_carried_robot_keeps_its_estimate_and_doubts_it_more_and_more(lab: Lab) -> None:
    heard = poses(lab)
    await lab.clock.sleep(1.0)
    carry(lab, 2.0, 2.0)
    await lab.clock.sleep(4.0)
    spreads = [variances(each)[0] for each in heard]
    assert spreads[0] == SURE[0]
    assert spreads == sorted(spreads)
    assert spreads[-1] > 1.0
    assert error(lab, heard[-1]) == pytest.approx(math.hypot(2, 2), abs=0.01)


@pytest.mark.world("house")
async def test_a_robot_put_down_a_few_centimetres_away_is_found(lab: Lab) -> None:
    heard = poses(lab)
    await lab.clock.sleep(1.0)
    carry(lab, 0.1, 0.1, 0.1)
    await lab.clock.sleep(1.0)
    await lab.drive(4.0, 0.0, 0.5)
    assert error(lab, heard[-1]) < 0.05
    assert variances(heard[-1]) == SURE


@pytest.mark.parametrize(
    ("service", "x", "y"),
    [
        pytest.param("/reinitialize_global_localization", 2.0, 2.0, marks=pytest.mark.world("house")),
        pytest.param("/global_localization", 0.0, 2.0, marks=pytest.mark.world("house")),
        pytest.param("/global_localization", 2.0, 0.0, marks=pytest.mark.world("patrol")),
        pytest.param("/global_localization", 5.0, 3.0, marks=pytest.mark.world("office")),
        pytest.param("/global_localization", 2.0, 1.0, marks=pytest.mark.world(TURTLEBOT2)),
    ],
)
async def test_a_relocalising_robot_finds_its_place_by_turning(
    lab: Lab, service: str, x: float, y: float
) -> None:
    heard = poses(lab)
    await lab.clock.sleep(1.0)
    carry(lab, x, y)
    await relocalise(lab, service)
    await lab.clock.sleep(2.0)
    assert variances(heard[-1])[0] > 1.0, "nothing is found at rest"
    await lab.drive(12.0, 0.0, 1.0)
    assert variances(heard[-1]) == pytest.approx(SURE, abs=0.01)
    assert error(lab, heard[-1]) < 0.05


@pytest.mark.world(PLAIN)
async def test_without_walls_in_reach_a_robot_neither_notices_nor_finds(lab: Lab) -> None:
    heard = poses(lab)
    await lab.clock.sleep(1.0)
    carry(lab, 2.0, 2.0)
    await lab.clock.sleep(3.0)
    assert [variances(each) for each in heard] == [SURE]
    await relocalise(lab)
    await lab.drive(8.0, 0.0, 1.0)
    assert variances(heard[-1])[0] > 1.0


@pytest.mark.world("house")
async def test_a_bump_makes_a_robot_less_sure_until_it_has_driven_on(lab: Lab) -> None:
    heard = poses(lab)
    await lab.drive(4.0, -0.4)
    assert lab.world.robot().touching
    assert variances(heard[-1])[0] == pytest.approx(SURE[0] + 0.01)
    await lab.drive(5.0, 0.3)
    assert variances(heard[-1]) == SURE


@pytest.mark.world("house")
async def test_slip_makes_a_robot_less_sure_while_it_lasts(lab: Lab) -> None:
    heard = poses(lab)
    lab.world.robot().grip = lambda: 0.5
    await lab.drive(3.0, 0.4)
    assert SURE[0] < variances(heard[-1])[0] < 0.05
    lab.world.robot().grip = None
    await lab.drive(6.0, 0.0, 1.0)
    assert variances(heard[-1]) == SURE
