"""A patrol over a real graph goes on while its master is restarted."""

from itertools import pairwise

import pytest
from judging import visits
from masters import Master
from processes import WorldProcess, wait_until

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict
from jacaros.testing.paths import judge_recharging, stays

CORNERS = {"0": (0.0, 0.0), "1": (1.0, 0.0), "2": (1.0, 1.0), "3": (0.0, 1.0)}
"""Corners of the patrol in the yard."""


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


@pytest.mark.only("ros1")
def test_a_patrol_outlives_the_ros_master(world: WorldProcess, run_agents, master: Master, peer) -> None:
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
