"""A robot's process that is killed in the middle of a goal and started anew, and odometry at 1 kHz, on real graphs."""

import signal
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from judging import distance
from processes import Agents, WorldProcess, wait_until

PROGRAMS = Path(__file__).parent / "programs"
YARD = Path(__file__).parent / "worlds" / "yard.yaml"
NAVIGATION = {"ros1": "move_base.yaml", "ros2": "nav2.yaml"}


def test_a_killed_and_restarted_robot_can_be_navigated_again(
    kind: str,
    environment: dict[str, str],
    run_world: Callable[..., WorldProcess],
    run_agents: Callable[..., Agents],
    tmp_path: Path,
) -> None:
    first = run_world(YARD)
    agents = run_agents(
        "there.asl", "--mapping", NAVIGATION[kind], "--mapping", str(PROGRAMS / "odometry.yaml")
    )
    first.until_truth(lambda truth: truth.latest().x > 0.5, "the robot is on its way")
    first.signal(signal.SIGKILL)
    agents.until_line("lost /odom")
    agents.until_line("action_failed server_lost")
    (tmp_path / "second").mkdir()
    second = WorldProcess(YARD, kind, environment, tmp_path / "second")
    try:
        assert agents.end() == 0
        told = [line.removeprefix("[there] ") for line in agents.lines]
        assert told[:2] == ["connected /odom", "on my way"]
        assert told[-1] == "there"
        assert told.count("connected /odom") == 2
        assert told.count("lost /odom") == 1
        failures = {line for line in told if line.startswith("action_failed")}
        # A server whose end the graph has not noticed yet may be asked once more, in vain.
        assert failures <= {
            f"action_failed {reason}" for reason in ("server_lost", "server_unavailable", "timeout(5)")
        }
        # While the server is missing each try has three lines: waiting, missing, found.
        reports = [line for line in agents.errors if line.startswith("[ros]")]
        assert len(reports) <= 3 * told.count("on my way") + 4, reports
        truth = second.close()
        assert distance(truth.latest(), (3.0, 0.0)) <= 0.3
        assert truth.events_of("bump") == []
    finally:
        second.stop()


def test_an_agent_that_is_slower_than_its_odometry_thinks_of_what_is_now(run_agents, peer) -> None:
    robot = peer("robot")
    robot.advertise("/fast_odom", "nav_msgs/msg/Odometry", depth=10)
    robot.subscribe("/answers", "std_msgs/msg/Float64", depth=1000)
    agents = run_agents("busy.asl", "--mapping", str(PROGRAMS / "answer.yaml"))
    agents.until_line("listening")
    wait_until(lambda: robot.subscription_count("/fast_odom"), "the agent listens")
    wait_until(lambda: robot.publisher_count("/answers"), "the agent can answer")
    messages = 3000
    robot.publish_numbered("/fast_odom", messages, 0.001)
    wait_until(lambda: robot.numbered() == messages, "all is published")
    before = len(robot.received("/answers"))
    wait_until(
        lambda: robot.received("/answers")[-1:] == [{"data": messages}], "the last place is thought about"
    )
    answers = [answer["data"] for answer in robot.received("/answers")]
    assert all(earlier < later for earlier, later in pairwise(answers)), "never a place from before"
    assert len(answers) < messages / 2, "the agent is slower than its odometry"
    assert len(answers) - before <= messages / 10, "what was on the way at the end, not what had piled up"
    agents.stop()
    assert agents.complaints == []
