"""Odometry and commands that arrive late, twice, out of order, or not at all."""

import pytest
from faults_lab import disturbed, in_lab

from jacaros.robots.ros.drivers.memory.graph import Disturbance, both, delayed, dropped, duplicated


@pytest.mark.parametrize("topic", ["/odom", "/cmd_vel"])
@pytest.mark.parametrize(
    "disturbance",
    [
        delayed(0.05),
        delayed(0.0, jitter=0.3, seed=1),
        duplicated(3, apart=0.1),
        dropped(0.5, seed=1),
        both(dropped(0.3, seed=2), both(duplicated(2, apart=0.05), delayed(0.02, jitter=0.1, seed=3))),
    ],
    ids=["late", "overtaking", "repeated", "lost", "all of it"],
)
def test_a_robot_arrives_despite_a_bad_connection(topic: str, disturbance: Disturbance) -> None:
    lab = in_lab("driving.asl", lambda lab: lab.at(1, lambda: lab.graph.disturb(topic, disturbance)))
    assert [line for line in lab.lines if not line.startswith("bad /odom out_of_order")] == [
        "connected /odom",
        "at 2 0",
        "at 0 0",
    ]
    assert len(lab.errors) <= 3, "the first, the 10th and the 100th are logged"
    assert lab.exit_code == 0
    assert lab.safe
    assert abs(lab.place[0]) <= 0.05


def test_a_robot_stops_when_odometry_becomes_late() -> None:
    lab = in_lab("driving.asl", disturbed("/odom", delayed(1.0), 1, 12))
    told = [line.split("(")[0] for line in lab.lines if not line.startswith("bad /odom out_of_order")]
    assert told == [
        "connected /odom",
        "lost /odom",
        "connected /odom",
        *["bad /odom late"] * 2,
        "action_failed no_odometry",
        "bad /odom late",
        "at 2 0",
        "at 0 0",
    ]
    assert lab.stands(2.6, 12.0)
    assert "arrived 0.999 s later than earlier ones" in lab.errors[0]
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)


def test_odometry_that_is_a_little_late_makes_a_robot_overshoot_a_little() -> None:
    lab = in_lab("driving.asl", disturbed("/odom", delayed(0.3), 1, 60))
    assert max(moment.x for moment in lab.moments) < 2.0 + 0.3 * 0.65
    assert lab.safe
    assert lab.errors == []


def test_without_odometry_the_robot_stops_and_the_motion_fails() -> None:
    lab = in_lab("driving.asl", disturbed("/odom", dropped(), 2, 10))
    assert lab.lines == [
        *("connected /odom", "lost /odom", "action_failed no_odometry(5)", "connected /odom", "at 2 0"),
        "at 0 0",
    ]
    assert 2.9 <= lab.when("lost") <= 3.5
    assert lab.stands(3.6, 10.0)
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)


def test_odometry_that_pauses_makes_the_robot_pause() -> None:
    lab = in_lab("driving.asl", disturbed("/odom", dropped(), 2, 5))
    assert lab.lines == ["connected /odom", "lost /odom", "connected /odom", "at 2 0", "at 0 0"]
    assert lab.stands(3.6, 5.0)
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)


def test_a_robot_without_commands_stops_and_the_motion_is_blocked() -> None:
    lab = in_lab("driving.asl", disturbed("/cmd_vel", dropped(), 2, 8))
    first, *others = [line for line in lab.lines if line.startswith("action_failed")]
    assert first.startswith("action_failed blocked(")
    assert all(each.startswith("action_failed blocked(") for each in others)
    assert lab.stands(2.7, 8.0)
    assert lab.lines[-2:] == ["at 2 0", "at 0 0"]
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)
