"""An agent's goals at action servers of other processes: every way in which they end reaches plan and server."""

import signal
from collections.abc import Callable
from typing import Any

from graphs import ProcessPeer
from processes import Agents, wait_until


def deeds_of(server: ProcessPeer, target: int) -> list[Any]:
    """What the server did for a goal: its begin, and its end with whether a client wanted it cancelled."""
    return [deed for deed in server.deeds("/count") if deed[1] == target]


def test_every_end_of_a_goal_reaches_plan_and_server(run_agents: Callable[..., Agents], peer) -> None:
    server, mortal = peer("server"), peer("mortal")
    server.serve_action("/count")
    server.serve_action("/fickle/count", "give_up")
    mortal.serve_action("/mortal/count")
    agents = run_agents("counting/count.asl")
    agents.until_line("the mortal one counts")
    mortal.signal(signal.SIGKILL)
    agents.until_line("counting without end")
    wait_until(lambda: deeds_of(server, 1001), "the endless goal has begun")
    agents.signal(signal.SIGINT)
    assert agents.end() == 128 + signal.SIGINT
    assert agents.lines == [
        f"[count] {text}"
        for text in (
            "counted to 3",
            "action_failed rejected",
            'action_failed aborted(0,"cannot count so far")',
            "action_failed timeout(1)",
            "changed my mind",
            "the mortal one counts",
            "action_failed server_lost",
            "counting without end",
        )
    ]
    # Time that was up, an intention that was dropped and a process that ended: the server received each cancellation.
    for target in (1001, 1002, 1003):
        wait_until(lambda: len(deeds_of(server, target)) == 2, f"the goal {target} has ended")  # noqa: B023
        assert deeds_of(server, target)[1] == ["end", target, True]
