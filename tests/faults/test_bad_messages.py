"""Messages with NaN or infinity, or in wrong frames, while the robot drives."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from faults_lab import Lab, between, in_lab

ODOMETRY = "nav_msgs/msg/Odometry"


def odometry_is(change: Callable[[Any], None], begin: float, end: float) -> Callable[[Lab], None]:
    """Change odometry on its way from one moment to another."""
    return between(begin, end, lambda lab: lab.change("/odom", ODOMETRY, change))


def without_position(number: float) -> Callable[[Any], None]:
    def change(message: Any) -> None:
        message.pose.pose.position.x = number

    return change


def without_heading(message: Any) -> None:
    message.pose.pose.orientation.w = math.nan


def elsewhere(message: Any) -> None:
    """The pose is right, in a map whose origin is somewhere else."""
    message.header.frame_id = "map"
    message.pose.pose.position.x += 5.0


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (without_position(math.nan), "pose.pose.position.x"),
        (without_position(math.inf), "pose.pose.position.x"),
        (without_heading, "pose.pose.orientation.w"),
    ],
    ids=["nan", "infinite", "no heading"],
)
def test_a_robot_stops_while_its_pose_is_unknown(change: Callable[[Any], None], what: str) -> None:
    lab = in_lab("driving.asl", odometry_is(change, 2, 9))
    bad = f'bad /odom not_finite("{what}")'
    assert lab.lines == ["connected /odom", *[bad] * 3, "action_failed no_odometry(5)", "at 2 0", "at 0 0"]
    assert lab.when(bad) <= 2.1
    assert lab.drives(1.9, 2.1)
    assert lab.stands(3.2, 9.0)
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)
    assert len(lab.errors) == 3, "140 messages, of which the first, the 10th and the 100th are logged"


def test_a_few_bad_numbers_are_logged_once_and_the_robot_arrives() -> None:
    lab = in_lab("driving.asl", odometry_is(without_position(math.nan), 2, 2.2))
    assert lab.lines == [
        "connected /odom",
        'bad /odom not_finite("pose.pose.position.x")',
        "at 2 0",
        "at 0 0",
    ]
    assert lab.errors == ["[wheels] /odom: pose.pose.position.x is nan; message dropped"]
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)


def test_a_pose_in_another_frame_is_not_used_for_driving() -> None:
    lab = in_lab("driving.asl", odometry_is(elsewhere, 2, 5))
    assert lab.lines == ["connected /odom", *['bad /odom wrong_frame("map")'] * 2, "at 2 0", "at 0 0"]
    assert lab.stands(3.5, 5.0)
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)


def test_a_motion_does_not_outlive_a_change_of_frames() -> None:
    """A localisation that publishes poses in another frame has been restarted, so earlier goals are other places there."""
    lab = in_lab("driving.asl", odometry_is(elsewhere, 2, 60), seconds=7.5)
    assert lab.lines[-1] == "action_failed no_odometry(4.6)"
    assert 7.0 <= lab.when("action_failed") <= 7.1
    assert lab.stands(3.5, 7.5)
    assert lab.safe


@pytest.mark.parametrize(
    ("change", "mapping", "bad", "told"),
    [
        (elsewhere, "framed.yaml", 'wrong_frame("map")', "expected frame odom, found map"),
        (
            without_position(math.nan),
            *("robot.yaml", 'not_finite("pose.pose.position.x")', "`pose.pose.position.x` is nan"),
        ),
    ],
    ids=["another frame", "nan"],
)
def test_a_mapped_property_expires_and_returns_and_a_timed_motion_ends(change, mapping, bad, told) -> None:
    lab = in_lab("blind.asl", odometry_is(change, 1, 3), mapping=mapping)
    bad = f"bad /odom {bad}"
    assert [line for line in lab.lines if not line.startswith("odom 1")] == [
        *("odom 0 odom", "odom 0.1 odom", bad, "odom 0.2 odom", bad, "odom unknown", "driven"),
        *("odom 0.9 odom", "driven", "driven"),
    ]
    assert lab.stands(6.8, 8.0)
    assert (lab.exit_code, lab.place, lab.safe) == (0, (1.8, 0), True)
    [error] = lab.errors
    assert f"`odom` is not shown: {told}" in error
