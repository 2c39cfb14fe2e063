"""``connected(Topic)`` on real graphs: a publisher that dies and comes back, and no restart on our side."""

import signal
from collections.abc import Callable

from graphs import ProcessPeer
from processes import Agents, wait_until

STRING = "std_msgs/msg/String"


def say(talker: ProcessPeer, text: str) -> None:
    """Publish a text when somebody listens."""
    talker.advertise("/chatter", STRING)
    wait_until(lambda: talker.subscription_count("/chatter"), "the agents listen")
    talker.publish("/chatter", {"data": text})


def test_a_publisher_that_dies_and_comes_back(
    run_agents: Callable[..., Agents], peer: Callable[[str], ProcessPeer]
) -> None:
    agents = run_agents("hear.asl")
    agents.until_line("listening")
    first = peer("first_talker")
    say(first, "hello")
    agents.until_line("heard hello")
    first.signal(signal.SIGKILL)
    agents.until_line("lost /chatter")
    second = peer("second_talker")
    say(second, "again")
    agents.until_line("heard again")
    second.publish("/chatter", {"data": "end"})
    assert agents.end() == 0
    # What is heard may be told before the connection is: it is looked at twice a second.
    assert sorted(agents.lines) == sorted(
        f"[hear] {text}"
        for text in (
            "listening",
            "connected /chatter",
            "heard hello",
            "lost /chatter",
            "connected /chatter",
            "heard again",
        )
    )
