"""Patrols over a real graph: the example, judged by its own checker, and one through a restart of the master."""

from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from itertools import pairwise
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker
from graphs import ProcessPeer
from judging import visits
from masters import Master
from processes import Agents, WorldProcess, wait_until

from jacaros.sim import GroundTruth
from jacaros.testing import Verdict
from jacaros.testing.docking import judge_recharging, stays

RUN_DOWN_SOON = {
    "level: 100": "level: 27",
    "drain_per_second: 0.75": "drain_per_second: 0",
    "drain_per_metre: 3": "drain_per_metre: 6.5",
    "charge_per_second: 10": "charge_per_second: 40",
}
"""What makes the example's battery one for tests in real time; only motion drains it, so that a slow machine
makes the robot no hungrier."""

CORNERS = {"0": (0.0, 0.0), "1": (1.0, 0.0), "2": (1.0, 1.0), "3": (0.0, 1.0)}
"""Corners of the patrol in the yard."""


def is_kilted() -> bool:
    """Whether ROS 2 here is the wheels of Kilted."""
    try:
        return version("ros-rclpy").startswith("9.")
    except PackageNotFoundError:
        return False


def charges(truth: GroundTruth) -> int:
    """How often the robot came to the dock and charged its battery to the full."""
    return sum(stay.charged for stay in stays(truth))


def since_the_last_charge(truth: GroundTruth) -> GroundTruth:
    """The path since the battery was last full."""
    later = GroundTruth(truth.robots)
    for sample in truth.path():
        if sample.time > truth.events_of("charged")[-1].time:
            later.record_sample(truth.robots[0], sample)
    return later


@pytest.mark.skipif(is_kilted(), reason="the long run is made on ROS 1 and on Jazzy")
def test_the_patrol_goes_on_after_two_charges(
    run_world: Callable[..., WorldProcess], run_agents: Callable[..., Agents], tmp_path: Path
) -> None:
    text = (EXAMPLES / "04_patrol/patrol.yaml").read_text(encoding="utf-8")
    for old, new in RUN_DOWN_SOON.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    (tmp_path / "patrol.yaml").write_text(text, encoding="utf-8")
    example = checker("04_patrol")

    world = run_world(tmp_path / "patrol.yaml")
    agents = run_agents(EXAMPLES / "04_patrol/patrol.jcm")
    world.until_truth(lambda truth: charges(truth) == 2, "two charges")
    world.until_truth(
        lambda truth: example.visits(since_the_last_charge(truth).path()), "a corner after them"
    )
    agents.stop()
    verdict = example.check(world.close(), cycles=2)
    print(*verdict.lines(), sep="\n")
    assert verdict.complaints == []
    assert agents.complaints == []
    assert len(world.errors) == 2, "the battery became low twice"
    assert all(line.startswith("the battery of turtlebot is at ") for line in world.errors)


@pytest.mark.only("ros1")
def test_a_patrol_outlives_the_ros_master(
    world: WorldProcess,
    run_agents: Callable[..., Agents],
    master: Master,
    peer: Callable[[str], ProcessPeer],
) -> None:
    agents = run_agents("patrol.asl")
    world.until_truth(lambda truth: len(visits(truth, CORNERS)) >= 2, "the first corner")
    master.kill()
    try:
        agents.until_error("waiting for the ROS master")
        before = len(visits(world.truth, CORNERS))
        world.until_truth(lambda truth: len(visits(truth, CORNERS)) > before, "a corner without a master")
    finally:
        master.start()
    for process in (agents, world):
        process.until_error("the ROS master had forgotten")
    late = peer("late")
    late.subscribe("/odom", "nav_msgs/msg/Odometry")
    wait_until(lambda: late.received("/odom"), "odometry reaches a node that came after the master")
    world.until_truth(lambda truth: charges(truth) == 1, "a charge after it")
    world.until_truth(lambda truth: visits(since_the_last_charge(truth), CORNERS), "a corner after that")
    agents.stop()

    truth = world.close()
    verdict = Verdict()
    judge_recharging(verdict, truth, low=50.0)
    assert verdict.complaints == []
    order = visits(truth, CORNERS)
    assert all(int(after) == (int(before) + 1) % 4 for before, after in pairwise(order)), order
