"""A patrol with recharging over a real graph, and through a restart of the ROS master."""

from collections.abc import Callable
from itertools import pairwise

import pytest
from graphs import ProcessPeer
from judging import visits
from masters import Master
from processes import Agents, WorldProcess, wait_until

from jacaros.sim.ground_truth import GroundTruth

CORNERS = {"0": (0.0, 0.0), "1": (1.0, 0.0), "2": (1.0, 1.0), "3": (0.0, 1.0)}


def charges(truth: GroundTruth) -> int:
    """How often the battery was charged to its full."""
    return len(truth.events_of("charged"))


def assert_charged_in_the_dock_only(truth: GroundTruth) -> None:
    assert not truth.events_of("battery_empty")
    docked = False
    for event in truth.events_of("docked", "undocked", "charging"):
        docked = event.kind == "docked" or (docked and event.kind != "undocked")
        assert docked or event.kind == "undocked", event


def assert_no_corner_left_out(truth: GroundTruth) -> None:
    order = visits(truth, CORNERS)
    assert all(int(after) == (int(before) + 1) % 4 for before, after in pairwise(order)), order


def corners_after_the_last_charge(truth: GroundTruth) -> int:
    """How many corners the robot has come to since its battery was last full."""
    full = truth.events_of("charged")[-1].time
    later = GroundTruth(truth.robots)
    for sample in truth.path():
        if sample.time > full:
            later.record_sample(truth.robots[0], sample)
    return len(visits(later, CORNERS))


def test_a_patrol_goes_on_after_two_charges(world: WorldProcess, run_agents: Callable[..., Agents]) -> None:
    agents = run_agents("patrol.asl")
    world.until_truth(lambda truth: charges(truth) == 2, "two charges")
    world.until_truth(lambda truth: corners_after_the_last_charge(truth) >= 1, "a corner after them")
    agents.stop()
    truth = world.close()
    assert_charged_in_the_dock_only(truth)
    assert_no_corner_left_out(truth)


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
    world.until_truth(lambda truth: corners_after_the_last_charge(truth) >= 1, "a corner after that")
    agents.stop()
    truth = world.close()
    assert_charged_in_the_dock_only(truth)
    assert_no_corner_left_out(truth)
