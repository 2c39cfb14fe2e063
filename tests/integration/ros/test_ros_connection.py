"""``connected(Topic)`` on real graphs: a publisher that dies and comes back, and no restart on our side."""

import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from graphs import InProcesses, ProcessPeer
from masters import Master
from processes import Agents, wait_until

STRING = "std_msgs/msg/String"


def say(talker: ProcessPeer, text: str, agents: Agents) -> None:
    """Publish a text until it is heard: a publisher may know of a subscription that does not know of it yet."""
    talker.advertise("/chatter", STRING)

    def heard() -> bool:
        talker.publish("/chatter", {"data": text})
        return f"[hear] heard {text}" in agents.lines

    wait_until(heard, f"{text!r} is heard")


def test_a_publisher_that_dies_and_comes_back(run_agents: Callable[..., Agents], peer) -> None:
    agents = run_agents("hear.asl")
    agents.until_line("listening")
    first = peer("first_talker")
    say(first, "hello", agents)
    first.signal(signal.SIGKILL)
    agents.until_line("lost /chatter")
    second = peer("second_talker")
    say(second, "again", agents)
    second.publish("/chatter", {"data": "end"})
    assert agents.end() == 0
    # Output can appear before the connection is reported, which is checked twice a second.
    lines = [
        line for n, line in enumerate(agents.lines) if "heard" not in line or line not in agents.lines[:n]
    ]
    assert sorted(lines) == sorted(
        f"[hear] {text}"
        for text in (
            *("listening", "connected /chatter", "heard hello", "lost /chatter", "connected /chatter"),
            "heard again",
        )
    )


@pytest.mark.only("ros1")
def test_topics_stay_connected_when_the_master_dies(kind: str, tmp_path: Path) -> None:
    own = Master(tmp_path)
    own.start()
    graph = InProcesses(kind, own.environment)
    agents = Agents(Path(__file__).parent / "programs" / "hear.asl", kind, own.environment)
    try:
        agents.until_line("listening")
        talker = graph.peer("talker")
        say(talker, "hello", agents)
        agents.until_line("connected /chatter")
        own.kill()
        agents.until_error("waiting for the ROS master")
        talker.publish("/chatter", {"data": "still here"})
        agents.until_line("heard still here")
        talker.publish("/chatter", {"data": "end"})
        assert agents.end() == 0
        assert not [line for line in agents.lines if "lost" in line]
    finally:
        agents.stop()
        graph.close()
        own.close()
