"""Fault files: all mistakes in one pass, each with its location and a suggested fix."""

from pathlib import Path

import pytest

from jacaros.robots.world.data.world import WorldError
from jacaros.robots.world.files.faults import fault_file_problems, is_fault_file, read_faults
from jacaros.robots.world.files.world import read_world

WORLD = read_world("""
name: two
border: walls
walls:
  - box: {from: [0, -2.5], to: [1, -1.5]}
doors:
  - {name: kitchen, segment: [[2, -1], [2, 1]]}
robots:
  - {name: one, namespace: one}
  - {name: two, namespace: two, pose: {x: 1, y: 1}}
""")


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("{kind: wheel_slp}", "3:13: error: 'kind' is 'wheel_slp'"),
        ("{at: 3}", "3:6: error: 'f' lacks the key 'kind'"),
        ("{kind: wheel_slip}", "'f' lacks the key 'robot'"),
        ("{kind: wheel_slip, robot: three}", "unknown robot 'three'"),
        ("{kind: wheel_slip, robot: one, share: 2}", "'share' is 2, but must lie between 0 and 1"),
        ("{kind: wheel_slip, robot: one, topic: /scan}", "'f' has no key 'topic'"),
        ("{kind: closed_door, door: hall}", "unknown door 'hall'"),
        ("{kind: stuck_door, door: hall}", "unknown door 'hall'"),
        ("{kind: stuck_door, door: kitchen, share: 2}", "'share' is 2, but must lie between 0 and 1"),
        ("{kind: closed_door}", "'f' lacks the key 'door'"),
        ("{kind: closed_door, door: kitchen, robot: one}", "'closed_door' does not concern a robot"),
        ("{kind: dead_dock, dock: home}", "the world has no dock"),
        ("{kind: dirty_contact}", "'f' lacks the key 'dock'"),
        ("{kind: dirty_contact, dock: home, period: 0}", "'period' is 0, but must be at least 0.1"),
        ("{kind: wrong_dock, to: {x: 5}}", "it is about [5, 0], outside the world"),
        ("{kind: wrong_dock}", "'f' lacks the key 'to'"),
        ("{kind: lost_localisation, robot: one, to: {x: 1}, for: 3}", "'lost_localisation' has no duration"),
        ("{kind: lost_localisation, robot: one, to: {y: 9}}", "it is about [0, 9], outside the world"),
        ("{kind: person_in_the_way}", "'f' lacks the key 'robot'"),
        ("{kind: person_in_the_way, robot: one, gap: 9}", "'gap' is 9, but must lie between 0.05 and 5"),
        ("{kind: missed_grasp, robot: one}", "the robot 'one' has no gripper"),
        ("{kind: battery_drop, robot: one}", "'f' lacks the key 'to'"),
        ("{kind: battery_drop, robot: one, to: 15, for: 3}", "'battery_drop' has no duration"),
        ("{kind: kidnapped_robot, robot: one, to: {z: 1}}", "'to' has no key 'z'"),
        (
            "{kind: kidnapped_robot, robot: one, to: {x: -2.9}}",
            "it puts the robot 'one' at [-2.9, 0], in a wall: 0.10 m from it, with a radius of 0.17 m",
        ),
        (
            "{kind: kidnapped_robot, robot: two, to: {x: 5}}",
            "it puts the robot 'two' at [5, 0], outside the world",
        ),
        ("{kind: kidnapped_robot, robot: two, to: {x: 0.2, y: -2}}", "inside a box"),
        ("{kind: person}", "'f' lacks the key 'path'"),
        ("{kind: dead}", "'f' lacks the key 'topic'"),
        ("{kind: aborted_action}", "'f' lacks the key 'action'"),
        ("{kind: dead, topic: /scan, at: -1}", "'at' is -1, but must be at least 0"),
        ("{kind: closed_door, door: kitchen, after: {metres: 1}}", "'f' lacks the key 'robot'"),
        ("{kind: dead, topic: /scan, after: {metres: 1}}", "'f' lacks the key 'robot'"),
        ("{kind: closed_door, door: kitchen, robot: six, after: {tasks: 1}}", "unknown robot 'six'"),
    ],
)
def test_a_mistake_has_a_location(fault: str, message: str) -> None:
    with pytest.raises(WorldError) as told:
        read_faults(f"faults:\n  # one\n  f: {fault}\n", WORLD)
    assert message in str(told.value)
    assert str(told.value).startswith("faults:3:")


def test_a_kidnapped_robot_may_be_put_into_a_doorway() -> None:
    (fault,) = read_faults("faults:\n  {f: {kind: kidnapped_robot, robot: one, to: {x: 2, y: 0}}}", WORLD)
    assert fault.pose == (2.0, 0.0, 0.0)


def test_topics_are_relative_to_the_robot_unless_absolute() -> None:
    text = "faults:\n  a: {kind: dead, robot: two, topic: scan}\n  b: {kind: dead, topic: /clock}\n"
    assert [fault.topic for fault in read_faults(text, WORLD)] == ["/two/scan", "/clock"]


def test_a_fault_file_is_recognised_and_checked_without_a_world(tmp_path: Path) -> None:
    path = tmp_path / "faults.yaml"
    path.write_text("faults:\n  a: {kind: closed_door, door: any}\n  b: {kind: dead}\n", encoding="utf-8")
    assert is_fault_file(path)
    assert [problem.line for problem in fault_file_problems(path)[1]] == [3]
    other = tmp_path / "mapping.yaml"
    other.write_text("properties: {}\n", encoding="utf-8")
    assert not is_fault_file(other)


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match="cannot read the file"):
        read_faults(tmp_path / "none.yaml", WORLD)
