"""Three robots of one program on a real graph: by one process, and each by a process of its own."""

from collections.abc import Callable

import pytest
from examples_lab import EXAMPLES, checker
from processes import Agents

from jacaros.robots.world import GroundTruth

ROBOTS = ("robot_1", "robot_2", "robot_3")
module = checker("09_three_robots")

pytestmark = pytest.mark.only("ros2")


def test_one_process_for_three_robots(run_world, run_agents: Callable[..., Agents]) -> None:
    """Each comes to its places and bumps into nothing."""
    world = run_world("three_robots")
    agents = run_agents(EXAMPLES / "09_three_robots/three_robots.jcm")

    def all_have_been_everywhere() -> bool:
        truth = world.truth
        return all(module.looks(truth, robot, place) for robot in ROBOTS for place in module.PLACES[robot])

    agents.until(all_have_been_everywhere, "each robot has been at its places")
    assert agents.complaints == []
    agents.stop()
    assert world.close().events_of("bump", "collision") == []


def test_one_process_for_each_robot(run_world, run_agents: Callable[..., Agents]) -> None:
    """The namespace of the command line stands before names and frames."""
    world = run_world("three_robots")
    runs = [
        run_agents(
            "two_stops.asl", "--mapping", "nav2.yaml", "--namespace", robot, "--node-name", f"mind_of_{robot}"
        )
        for robot in ROBOTS
    ]
    for run in runs:
        assert run.end() == 0, run.errors
        assert any("is there" in line for line in run.lines)
    truth: GroundTruth = world.close()
    assert truth.events_of("bump", "collision") == []
    for robot, y in zip(ROBOTS, (2.3, 0.0, -2.3), strict=True):
        end = truth.pose(robot)
        assert (end.x, end.y) == pytest.approx((-1.4, y + 0.4), abs=0.15)
