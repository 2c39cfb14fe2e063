"""Eleven mistakes of beginners whose programs once passed `jacaros check`, and whose runs said nothing."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.checks.files import check_files

CART = """
properties:
  pose:                                  # pose(X, Y, Yaw): metres and degrees
    topic: odom
    type: nav_msgs/msg/Odometry
    fields:
      - pose.pose.position.x
      - pose.pose.position.y
      - {path: pose.pose.orientation, as: yaw, unit: degrees}
  clearance:                             # clearance(Ahead): metres
    topic: scan
    type: sensor_msgs/msg/LaserScan
    fields: [{path: ranges, sample: [0.5], otherwise: range_max}]
operations:
  roll:                                  # roll(Speed, Turn, Seconds)
    parameters: [speed, turn, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed, angular.z: {value: $turn, unit: degrees}}
    rate: 10
    duration: $seconds
"""
PROJECT = """mas yard {
    agent cart
    workspace yard {
        artifact base: "cart.yaml"
    }
}
"""


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("!tour.\n+!tour <- roll(0.1, 0, 3);\n ?pose(X, _);\n .print(X).", 3, "pose(X, Y, Yaw)"),
        ('gate("shut").\n!pass.\n+!pass : gate(shut) <- .print(shut).', 3, '"shut"'),
        ("!work.\n+!work : rested <- .print(work).", 2, "rested"),
        ("!set.\n+!set <- -+lamp(on).\n+lmap(on) <- .print(on).", 3, "lamp"),
        (
            "!trip.\n+!trip <- !drive_to(2).\n+!drive_to(X) : X > 3.\n-!driveto(X) <- .print(X).",
            4,
            "drive_to",
        ),
        ("!trip.\n+!trip <- roll(0.1, 0, 3).\n+pose(x, y, yaw) <- .print(moved).", 3, "pose"),
        ("@near[urgent(9)]\n+clearance(D) : D < 1 <- roll(0, 9, 1).", 1, "urgency"),
        ("!trip.\n+!trip <- leave; .print(gone).\n+!leave <- .print(leaving).", 2, "!leave"),
        ("!spin.\n+!spin <- !spin.", 2, "waits"),
        ("!trip.\n+!trip <- navigate_to(1, 2, 0).", 2, "nav2.yaml"),
    ],
    ids=[
        "number of arguments",
        "string for an atom",
        "what no plan adds",
        "misspelt event",
        "misspelt handler",
        "lower case in an event",
        "word for another annotation",
        "goal without its sign",
        "loop without a wait",
        "operation of a shipped mapping",
    ],
)
def test_check_reports_the_mistake_at_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    (tmp_path / "cart.yaml").write_text(CART, encoding="utf-8")
    program = tmp_path / "cart.asl"
    program.write_text(text, encoding="utf-8")
    found = check_files([program], [str(tmp_path / "cart.yaml")]).diagnostics
    (one,) = [each for each in found if each.span is not None and each.span.line == line]
    assert words in f"{one.message} {one.help}"


def test_check_reports_an_artifact_that_no_agent_focuses(tmp_path: Path) -> None:
    (tmp_path / "cart.yaml").write_text(CART, encoding="utf-8")
    (tmp_path / "cart.asl").write_text("!t.\n+!t <- .wait(pose(_, _, _)); .print(seen).", encoding="utf-8")
    (tmp_path / "yard.jcm").write_text(PROJECT, encoding="utf-8")
    codes = [each.code for each in check_files([tmp_path / "yard.jcm"]).diagnostics]
    assert "unfocused-artifact" in codes
