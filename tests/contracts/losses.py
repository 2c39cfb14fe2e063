"""Processes that are killed in the middle of what they do for another one."""

from typing import Any

LOST = 90.0
"""Seconds until it is certainly noticed that a process was killed (DDS: 20 s, and `SERVER_LOST_AFTER`)."""


def lose_a_call(graph: Any, left: Any, service: str, patience: float = LOST) -> None:
    """Kill the server of a call that is under way, and wait until the loss is noticed."""
    mortal = graph.peer("mortal_service")
    mortal.serve(service, "never")
    graph.wait_until(lambda: left.ready(service), "the service is found")
    left.begin_call(service, service, {"a": 1, "b": 1})
    graph.wait_until(lambda: mortal.most_calls_at_once() == 1, "the call is under way")
    graph.kill(mortal)
    graph.wait_until(lambda: left.call_over(service), "the loss is noticed", patience)
