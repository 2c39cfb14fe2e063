"""The rule for "did you mean"."""

import pytest

from jacaros.runtime.files.texts import aside, close_matches, did_you_mean, suggestion


@pytest.mark.parametrize(
    ("written", "known", "meant"),
    [
        ("moveForwad", ["turn", "moveForward", "moveBackward"], "moveForward"),
        ("bbo", ["bob", "ann"], "bob"),
        ("nav_msgs/msg/Odometri", ["nav_msgs/msg/Odometry", "nav_msgs/msg/Path"], "nav_msgs/msg/Odometry"),
        ("devices.Heatr", ["devices.Heater", "devices.Barrier"], "devices.Heater"),
        ("driv/2", ["drive/1"], "drive/1"),
        ("distance", ["speed", "distance_remaining"], "distance_remaining"),
        ("/navigate_to", ["/navigate_through_poses", "/navigate_to_pose"], "/navigate_to_pose"),
    ],
)
def test_a_slip_is_recognised(written: str, known: list[str], meant: str) -> None:
    assert close_matches(written, known) == [meant]


@pytest.mark.parametrize(
    ("written", "known"),
    [
        ("tools.Counter", ["tools.Console", "tools.Clock"]),
        ("devices.Heater", ["devices.Barrier", "devices.Latch"]),
        ("acme_msgs/msg/Gripper", ["nav_msgs/msg/GridCells", "control_msgs/msg/GripperCommand"]),
        ("/robot_1/odom", ["/robot_1/scan"]),
        ("idle", ["active"]),
    ],
)
def test_a_common_package_makes_no_names_similar(written: str, known: list[str]) -> None:
    assert close_matches(written, known) == []


def test_suggestions_are_questions() -> None:
    assert did_you_mean([]) == ""
    assert did_you_mean(["a", "b"]) == "did you mean `a` or `b`?"
    assert suggestion("wals", ["walls"]) == "did you mean `walls`?"
    assert suggestion("x", ["walls"], "keys: walls") == "keys: walls"
    assert aside("wals", ["walls", "walks"]) == "; did you mean `walls` or `walks`?"
    assert aside("x", ["walls"]) == ""
