"""A service of another process: success and failure reach the plan."""

from collections.abc import Callable

from processes import Agents

ADDING = "service /add_two_ints (example_interfaces/srv/AddTwoInts)"
SILENT = "service /silent_add (example_interfaces/srv/AddTwoInts)"


def test_success_and_failure_of_a_service_reach_the_plan(run_agents: Callable[..., Agents], peer) -> None:
    agents = run_agents("add.asl")
    agents.until_line("service_unavailable")
    agents.until_error(f"[ros] waiting for the {ADDING}")
    server = peer("server")
    server.serve("/silent_add", "never")
    server.serve("/add_two_ints")
    assert agents.end() == 0
    # On ROS 2 the first answer may be lost: the server may not know its new client well enough yet.
    first, *_, success, failure = agents.lines
    assert first == f"[add] service_unavailable(add_two_ints): no node offered {ADDING} within 1 s"
    assert success == "[add] sum 42"
    assert failure == f"[add] service_timeout(1): {SILENT} did not answer within 1 s"
