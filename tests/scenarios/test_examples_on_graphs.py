"""The five examples of the thesis on real graphs, with the world and the agents in separate processes."""

import shutil
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker, passed
from processes import Agents, Program, WorldProcess

import jacaros.robots.world
from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict
from jacaros.testing.paths import stays

RunWorld = Callable[..., WorldProcess]
RunAgents = Callable[..., Agents]

HOUSE = Path(jacaros.robots.world.__file__).parent / "worlds" / "house.yaml"


def is_kilted() -> bool:
    """Whether ROS 2 here is the wheels of Kilted."""
    try:
        return version("ros-rclpy").startswith("9.")
    except PackageNotFoundError:
        return False


not_on_kilted = pytest.mark.skipif(is_kilted(), reason="the longer runs are made on ROS 1 and on Jazzy")


def changed(folder: Path, original: Path, changes: Mapping[str, str]) -> Path:
    """A copy of a file with some places changed."""
    text = original.read_text(encoding="utf-8")
    for old, new in changes.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = folder / original.name
    path.write_text(text, encoding="utf-8")
    return path


def judge(verdict: Verdict, program: Program) -> None:
    """Expect no complaints of the example's checker and of the program."""
    passed(verdict)
    assert program.complaints == []


PATROL_BATTERY = {
    "level: 100": "level: 27",
    "drain_per_second: 0.75": "drain_per_second: 0",
    "drain_per_metre: 3": "drain_per_metre: 6.5",
    "charge_per_second: 10": "charge_per_second: 40",
}
"""Only motion drains this battery, so a slow machine does not drain it faster."""


def is_back_on_patrol(truth: GroundTruth) -> bool:
    """Whether the robot has visited a corner after a recharge."""
    charged = [stay.begin for stay in stays(truth) if stay.charged]
    return bool(charged) and checker("04_patrol").visits(truth.path())[-1].begin > charged[0]


def test_the_robot_drives_out_and_back(run_world: RunWorld, run_agents: RunAgents) -> None:
    world = run_world("empty")
    agents = run_agents(EXAMPLES / "01_out_and_back/out_and_back.jcm")
    assert agents.end() == 0
    # The robot drives by time alone: a pause of one process for one command period makes the path 65 mm longer.
    judge(checker("01_out_and_back").check(world.close(), near=0.15), agents)
    assert agents.lines[:2] == ["[robot] driving out", "[robot] driving back"]
    assert world.errors == []


def test_the_robot_drives_the_square(run_world: RunWorld, run_agents: RunAgents) -> None:
    world = run_world("empty")
    agents = run_agents(EXAMPLES / "02_square/square.jcm")
    assert agents.end() == 0
    judge(checker("02_square").check(world.close()), agents)
    assert [line.split(" done")[0] for line in agents.lines] == [f"[robot] side {n}" for n in (1, 2, 3, 4)]
    assert world.errors == []


@not_on_kilted
def test_the_agent_prints_every_state_of_the_robots_battery(
    run_world: RunWorld, run_agents: RunAgents
) -> None:
    # This robot does not move, so its world can be much faster.
    world = run_world(EXAMPLES / "03_fake_battery/weak_battery.yaml", "--speed", "5")
    agents = run_agents(EXAMPLES / "03_fake_battery/robot_battery.jcm", "--clock", "ros")
    assert agents.end() == 0
    # The agent joins when the battery has begun to run down, as with a real robot.
    joined, *later = agents.lines
    assert joined.endswith(" %: Full Battery")
    lines = ["[robot] 100 %: Full Battery", *later]
    judge(checker("03_fake_battery").check(lines, world.close()), agents)


@not_on_kilted
def test_the_patrol_continues_after_a_recharge(
    run_world: RunWorld, run_agents: RunAgents, tmp_path: Path
) -> None:
    world = run_world(changed(tmp_path, EXAMPLES / "04_patrol/patrol.yaml", PATROL_BATTERY))
    agents = run_agents(EXAMPLES / "04_patrol/patrol.jcm")
    world.until_truth(is_back_on_patrol, "a corner after a recharge")
    agents.stop()
    judge(checker("04_patrol").check(world.close(), cycles=1), agents)
    assert [line.split(" at ")[0] for line in world.errors] == ["warning: the battery of `turtlebot` is"]


@not_on_kilted
def test_the_house_is_cleaned_with_a_recharge_between_two_tasks_of_a_room(
    run_world: RunWorld, run_agents: RunAgents, tmp_path: Path
) -> None:
    project = tmp_path / "example"
    shutil.copytree(EXAMPLES / "05_house_cleaning", project)
    changed(project, EXAMPLES / "05_house_cleaning/robot.asl", {"rounds(4).": "rounds(1)."})
    battery = {"level: 100": "level: 37.8", "charge_per_second: 5": "charge_per_second: 40"}
    world = run_world(changed(tmp_path, HOUSE, battery))
    agents = run_agents(project / "house_cleaning.jcm")
    assert agents.end() == 0
    judge(checker("05_house_cleaning").check(world.close(), rounds=1), agents)
