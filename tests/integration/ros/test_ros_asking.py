"""`jacaros ros` on real graphs: what it finds of a world in another process, and the mapping that it writes is run."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from masters import Master
from presence import own_domain
from processes import Agents, Program, WorldProcess

PROGRAM = """
!look.

+!look
  <- .wait(odom(X, Y, _));
     .print("at ", math.round(X), " ", math.round(Y));
     drive(0.2, 0, 1);
     ?odom(Z, _, _);
     if (Z > X) { .print("has moved") };
     .stopMAS.
"""


def test_a_world_is_listed_shown_mapped_and_checked_and_the_mapping_is_run(
    kind: str,
    world: WorldProcess,
    ask: Callable[..., Program],
    run_agents: Callable[..., Agents],
    tmp_path: Path,
) -> None:
    lines = ask("list").lines
    assert "topic /odom nav_msgs/msg/Odometry publishers=1 subscriptions=0" in lines
    assert "topic /cmd_vel geometry_msgs/msg/Twist publishers=0 subscriptions=1" in lines
    drive = {
        "ros1": "action /move_base move_base_msgs/action/MoveBase",
        "ros2": "action /navigate_to_pose nav2_msgs/action/NavigateToPose",
    }
    assert drive[kind] in lines
    assert "node /world" in lines

    shown = [" ".join(line.split()) for line in ask("show", "/odom").lines]
    assert "latest message" in shown
    assert any(line.startswith("pose.pose.position.x float64 m ") for line in shown)
    if kind == "ros2":
        assert "publishers: /world (reliable, volatile)" in shown

    file, program = tmp_path / "robot.yaml", tmp_path / "look.asl"
    assert ask("map", "-o", str(file)).code == 0
    checked = ask("check", str(file))
    assert (checked.code, checked.lines) == (0, [f"{file} matches this graph"])
    program.write_text(PROGRAM, encoding="utf-8")
    agents = run_agents(program, "--mapping", str(file))
    assert agents.end() == 0
    assert agents.lines == ["[look] at 0 0", "[look] has moved"]


def test_problems_of_a_mapping_are_reported(kind: str, peer, ask, tmp_path: Path) -> None:
    robot = peer("robot")
    robot.advertise("/odom", "nav_msgs/msg/Odometry", reliability="best_effort")
    file = tmp_path / "robot.yaml"
    file.write_text(
        "properties:\n"
        "  odom: {topic: odom, type: nav_msgs/msg/Path}\n"
        "  scan: {topic: odmo}\n"
        "  pose: {topic: odom, qos: default}\n",
        encoding="utf-8",
    )
    checked = ask("check", str(file))
    told = "\n".join(checked.lines)
    assert checked.code == 1
    assert "robot.yaml:2:29: expected the type `nav_msgs/msg/Odometry`, found `nav_msgs/msg/Path`" in told
    assert "robot.yaml:3:17: no node publishes `/odmo`" in told
    assert "did you mean `odom`?" in told
    assert ("the subscription requests reliable, the publisher offers best_effort" in told) == (
        kind == "ros2"
    )


@pytest.fixture
def empty_graph(kind: str, tmp_path: Path) -> Iterator[tuple[str, str]]:
    """An option that leads to a graph of this test alone: a master remembers nodes that were killed in other tests."""
    if kind == "ros2":
        yield "--domain-id", own_domain()
        return
    master = Master(tmp_path)
    master.start()
    yield "--master", master.environment["ROS_MASTER_URI"]
    master.close()


def test_an_empty_graph_is_reported(ask: Callable[..., Program], empty_graph: tuple[str, str]) -> None:
    asked = ask("list", *empty_graph, "--timeout", "5")
    assert asked.code == 1, asked.lines
    assert any("no other node is in the" in line for line in asked.errors)


def test_a_run_in_a_graph_without_anybody_says_so(kind: str, run_agents, empty_graph, tmp_path: Path) -> None:
    seconds = 5 if kind == "ros1" else 100  # on a busy machine others get more time to be found
    program = tmp_path / "alone.asl"
    program.write_text(f"!wait. +!wait <- .wait({1000 * seconds}); .stopMAS.", encoding="utf-8")
    agents = run_agents(program, *empty_graph)
    if kind == "ros2":
        agents.until_error(f"no other node is in the ROS 2 graph of domain {empty_graph[1]}")
        return
    assert agents.end() == 0
    assert not any("no other node is in" in line for line in agents.errors), "a wrong address is reported"
