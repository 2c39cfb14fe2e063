"""A robot behind a slow network: a relay in a process of its own delays its commands and its odometry."""

from collections.abc import Callable
from pathlib import Path

from judging import distance, heading_error
from processes import Agents, wait_until

WORLD = Path(__file__).parent / "worlds" / "behind_relay.yaml"
TWIST, ODOMETRY = "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry"
DELAY, JITTER = 0.15, 0.05
"""Seconds each way."""


def test_a_robot_behind_a_slow_network_arrives(run_world, run_agents: Callable[..., Agents], peer) -> None:
    world = run_world(WORLD)
    network = peer("network")
    network.relay("/cmd_vel", "/base/cmd_vel", TWIST, DELAY, JITTER, seed=1)
    network.relay("/base/odom", "/odom", ODOMETRY, DELAY, JITTER, seed=2)
    wait_until(lambda: network.subscription_count("/base/cmd_vel"), "the relay can command the robot")
    wait_until(lambda: network.publisher_count("/base/odom"), "the relay hears the robot")
    agents = run_agents("late.asl")
    assert agents.end() == 0, agents.lines
    assert agents.lines == ["[late] forward", "[late] turned"]
    assert agents.complaints == []
    last = world.close().latest()
    print(f"{last.time:.1f} s: x {last.x:.3f}, y {last.y:.3f}, yaw {last.yaw:.3f}")
    assert distance(last, (1.0, 0.0)) <= 0.05
    assert heading_error(last, 90.0) <= 2.0
