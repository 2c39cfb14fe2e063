"""The agents' process ends in the middle of a motion: the robot stops, and a new process continues."""

import signal
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from judging import distance, stands, standstill
from processes import Agents, WorldProcess, wait_until

COMMANDED_ZERO = 0.6
"""Seconds from the end of the agents to a commanded velocity of zero."""
STANDING = 1.0
"""Seconds from the end of the agents to a robot that stands."""
RAMP = 0.8
"""Metres per second squared by which the robot slows down when it is commanded to stop."""


def drive_at_full_speed(world: WorldProcess, agents: Agents) -> None:
    """Wait until the robot is well on its way."""
    world.until_truth(lambda truth: truth.odometer() > 0.7, "the robot drives")
    assert not agents.over


def test_sigterm_stops_the_robot(world: WorldProcess, run_agents: Callable[..., Agents], peer) -> None:
    watcher = peer("watcher")
    watcher.subscribe("/cmd_vel", "geometry_msgs/msg/Twist", depth=1000)
    agents = run_agents("away.asl")
    wait_until(lambda: watcher.received("/cmd_vel"), "the watcher hears the commands")
    drive_at_full_speed(world, agents)
    ended = agents.signal(signal.SIGTERM)
    assert agents.end() == 128 + signal.SIGTERM
    world.until_truth(lambda truth: stands(truth, world.time_of(ended)), "the robot stands")

    commands = [message["linear"]["x"] for message in watcher.received("/cmd_vel")]
    assert commands[-1] == 0.0, "the last word is zero"
    first_zero = len(commands) - next(n for n, speed in enumerate(reversed(commands)) if speed)
    zero_at = watcher.samples("/cmd_vel")[first_zero]["stamp"]
    truth = world.close()
    stood_at = standstill(truth, RAMP) - world.time_of(ended)
    print(f"SIGTERM: zero commanded after {zero_at - ended:.2f} s, standing after {stood_at:.2f} s")
    assert not truth.events_of("command_timeout"), "it received a stop command"
    assert zero_at - ended <= COMMANDED_ZERO
    assert stood_at <= STANDING


def test_sigkill_stops_the_robot_and_a_new_process_continues(world: WorldProcess, run_agents) -> None:
    agents = run_agents("far.asl")
    drive_at_full_speed(world, agents)
    ended = world.time_of(agents.signal(signal.SIGKILL))
    assert agents.end() == -signal.SIGKILL
    world.until_truth(lambda truth: stands(truth, ended), "the robot stands")
    [missed] = world.truth.events_of("command_timeout")
    print(f"SIGKILL: stopped by the base after {missed.time - ended:.2f} s")
    assert missed.time - ended <= COMMANDED_ZERO
    # The base brakes at once when it misses commands, without a ramp.
    resting = world.truth.latest()
    still = [sample for sample in world.truth.path() if sample.time > missed.time]
    assert all(sample.odometer == resting.odometer for sample in still)
    assert missed.time - ended <= STANDING
    assert resting.odometer < 1.8

    again = run_agents("far.asl")
    assert again.end() == 0
    x, y = (float(number) for number in again.lines[0].split()[-2:])
    assert distance(resting, (x, y)) <= 0.01, "it knows where the robot stands"
    assert again.lines[1:] == ["[far] arrived"]
    path = world.close().path()
    assert distance(path[-1], (3.0, 0.0)) <= 0.05
    assert all(after.x >= before.x - 0.01 for before, after in pairwise(path))


WORLDS = Path(__file__).parent / "worlds"
NAVIGATION = {"ros1": "move_base.yaml", "ros2": "nav2.yaml"}


def test_the_goal_of_a_killed_process_is_cancelled_when_the_next_one_starts(
    kind: str, run_world: Callable[[str | Path], WorldProcess], run_agents: Callable[..., Agents]
) -> None:
    world = run_world(WORLDS / "slow.yaml")
    options = ("--mapping", NAVIGATION[kind], "--node-name", "errand")
    agents = run_agents("errand.asl", *options)
    world.until_truth(lambda truth: truth.odometer() > 0.2, "the robot drives")
    agents.signal(signal.SIGKILL)
    agents.end()
    again = run_agents("listen.asl", *options)
    again.until(lambda: again.lines, "the next run knows where it is")
    heard = world.time_of(time.time())
    world.until_truth(lambda truth: stands(truth, heard), "the robot stands")
    assert world.truth.latest().x < 3.8, "it has not driven to the goal"
    assert any(
        "is still executing a goal of an earlier run of this node; cancelling it" in line
        for line in again.errors
    )
