"""Contract: services."""

import pytest
from losses import lose_a_call

from jacaros.robots.ros.errors import (
    CallFailed,
    CallTimedOut,
    MessageMismatch,
    ServerGone,
    ServiceUnavailable,
    UnknownInterface,
)

pytestmark = pytest.mark.needs("services")

TRIGGER = "std_srvs/srv/Trigger"


def serving(graph, left, right, name, behaviour):
    """Let the right peer offer a service, and wait until the left one knows."""
    right.serve(name, behaviour)
    graph.wait_until(lambda: left.ready(name), "the service is found")


def test_each_node_serves_the_other(graph, left, right, topic):
    assert left.serve(topic + "/left") == topic + "/left"
    right.serve(topic + "/right")
    assert left.call(topic + "/right", {"a": 1, "b": 1}, timeout=60) == {"sum": 2}
    assert right.call(topic + "/left", {"a": 1, "b": -3}, timeout=60) == {"sum": -2}


def test_a_node_can_call_its_own_service(graph, left, topic):
    left.serve(topic)
    assert left.call(topic, {"a": 1, "b": 1}, timeout=60) == {"sum": 2}


def test_a_standard_service_needs_no_fields(graph, left, right, topic):
    right.serve(topic, "nothing", TRIGGER)
    assert left.call(topic, {}, timeout=60, type_name=TRIGGER) == {"success": False, "message": ""}


def test_calls_of_a_slow_service_run_concurrently(graph, left, right, topic):
    serving(graph, left, right, topic, "add_together")
    for number in range(5):
        left.begin_call(f"{topic}{number}", topic, {"a": number, "b": 100}, timeout=60)
    assert [left.end_call(f"{topic}{n}")["sum"] for n in range(5)] == [100, 101, 102, 103, 104]
    assert right.most_calls_at_once() == 5


def test_a_missing_service_is_unavailable_after_the_time_out(graph, left, topic):
    assert left.ready(topic) is False
    with pytest.raises(ServiceUnavailable, match=f"{topic}.*within 1 s"):
        left.call(topic, {"a": 1, "b": 1}, timeout=1)
    assert f"waiting for the service {topic} (example_interfaces/srv/AddTwoInts)" in left.log()


@pytest.mark.only("ros2")
def test_a_service_of_another_type_is_reported(graph, left, right, topic):
    right.serve(topic, "nothing", TRIGGER)
    right.serve_action(topic + "/act", "nothing", "nav2_msgs/action/NavigateToPose")
    # Shown to be found, by a client that fits.
    assert right.call(topic, {}, timeout=60, type_name=TRIGGER) == {"success": False, "message": ""}
    with pytest.raises(
        CallFailed, match=f"{topic} is of type {TRIGGER}, not example_interfaces/srv/AddTwoInts"
    ):
        left.call(topic, {"a": 1, "b": 1}, timeout=60)
    with pytest.raises(
        CallFailed, match=f"{topic}/act is of type .*/action/NavigateToPose, not .*/action/Count"
    ):
        left.send_goal(topic, topic + "/act", {"target": 1}, timeout=60)


def test_a_service_that_comes_late_is_used(graph, left, right, topic):
    left.begin_call(topic, topic, {"a": 1, "b": 2}, timeout=60)
    graph.pass_time(0.2)
    right.serve(topic)
    assert left.end_call(topic) == {"sum": 3}


def test_a_service_that_does_not_answer_times_out(graph, left, right, topic):
    serving(graph, left, right, topic, "never")
    with pytest.raises(CallTimedOut, match=f"{topic}.*did not answer within 0.5 s"):
        left.call(topic, {"a": 1, "b": 1}, timeout=0.5)


@pytest.mark.needs("failing services")
def test_a_failing_service_fails_the_call(graph, left, right, topic):
    serving(graph, left, right, topic, "fail")
    if "service errors" in left.capabilities():
        with pytest.raises(CallFailed, match="no sums today"):
            left.call(topic, {"a": 1, "b": 1}, timeout=60)
    else:
        with pytest.raises(CallTimedOut):
            left.call(topic, {"a": 1, "b": 1}, timeout=0.5)
    graph.wait_until(lambda: any("no sums today" in line for line in right.log()), "it is in the log")


@pytest.mark.needs("failing services")
def test_a_wrong_response_fails_the_call(graph, left, right, topic):
    serving(graph, left, right, topic, "answer_wrongly")
    told = "service errors" in left.capabilities()
    with pytest.raises(CallFailed if told else CallTimedOut):
        left.call(topic, {"a": 1, "b": 1}, timeout=60 if told else 0.5)
    graph.wait_until(lambda: any("no field 'total'" in line for line in right.log()), "it is in the log")


def test_the_server_survives_a_failing_call(graph, left, right, topic):
    right.serve(topic + "/bad", "fail")
    right.serve(topic + "/good")
    graph.wait_until(lambda: left.ready(topic + "/bad"), "the service is found")
    with pytest.raises((CallFailed, CallTimedOut)):
        left.call(topic + "/bad", {"a": 1, "b": 1}, timeout=0.3)
    assert left.call(topic + "/good", {"a": 1, "b": 1}, timeout=60) == {"sum": 2}


def test_a_wrong_request_is_refused_before_it_is_sent(graph, left, topic):
    with pytest.raises(MessageMismatch, match="no field 'c'"):
        left.call(topic, {"a": 1, "c": 1}, timeout=1)
    with pytest.raises(MessageMismatch, match="a is int64"):
        left.call(topic, {"a": 1.5}, timeout=1)


def test_a_closed_service_becomes_unavailable(graph, left, right, topic):
    right.serve(topic)
    assert left.call(topic, {"a": 1, "b": 1}, timeout=60) == {"sum": 2}
    # A call may succeed before the client's picture of the graph shows the service: its absence would tell nothing.
    graph.wait_until(lambda: left.ready(topic), "the service is found")
    right.unserve(topic)
    graph.wait_until(lambda: not left.ready(topic), "the client notices")
    with pytest.raises(ServiceUnavailable):
        left.call(topic, {"a": 1, "b": 1}, timeout=1)


def test_a_call_can_be_cancelled(graph, left, right, topic):
    serving(graph, left, right, topic, "never")
    left.begin_call(topic, topic, {"a": 1, "b": 1})
    graph.pass_time(0.05)
    assert left.give_up_call(topic) is True


def test_closing_a_client_ends_its_calls(graph, left, right, topic):
    serving(graph, left, right, topic, "never")
    left.begin_call(topic, topic, {"a": 1, "b": 1})
    graph.pass_time(0.05)
    left.close_client(topic)
    with pytest.raises(CallFailed, match="closed"):
        left.end_call(topic)


@pytest.mark.parametrize("asked", [False, True])
def test_closing_a_node_ends_its_calls_on_the_loop(graph, topic, own_name, asked):
    """Before the server has got the request, and after that."""
    server, node = graph.peer(f"{own_name}_server"), graph.peer(f"{own_name}_caller")
    server.serve(topic, "never")
    graph.wait_until(lambda: node.ready(topic), "the service is found")
    node.debug()
    node.begin_call(topic, topic, {"a": 1, "b": 1})
    if asked:
        graph.wait_until(server.most_calls_at_once, "the server is asked")
    node.close()
    graph.wait_until(lambda: node.call_over(topic), "the caller has an answer", patience=10.0)
    with pytest.raises(CallFailed):
        node.end_call(topic)


def test_an_unknown_service_type_is_refused(graph, left, right, topic):
    with pytest.raises(UnknownInterface, match="no_srvs/srv/Nothing"):
        right.serve(topic, "add", "no_srvs/srv/Nothing")
    with pytest.raises(UnknownInterface, match="no_srvs/srv/Nothing"):
        left.ready(topic, "no_srvs/srv/Nothing")


@pytest.mark.needs("dying servers")
def test_a_call_whose_server_dies_fails(graph, left, topic):
    lose_a_call(graph, left, topic)
    # A rosbridge server of ROS 1 passes on only the text of the failure.
    told = CallFailed if graph.kind.startswith("rosbridge-ros1") else ServerGone
    with pytest.raises(told, match=topic):
        left.end_call(topic)
