"""Contract: the last messages of a process."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

TWIST = "geometry_msgs/msg/Twist"
FAST = {"linear": {"x": 0.5}}
STOP = {"linear": {"x": 0.0}, "angular": {"z": 0.125}}  # the mark tells it from other zeros


def driving(graph: Any, watcher: Any, topic: str) -> Any:
    """A node that drives the robot on *topic* and has an exit hook that stops it."""
    driver = graph.peer("driver" + topic.strip("/").replace("/", "_"))
    driver.advertise(topic, TWIST)
    watcher.subscribe(topic, TWIST)
    graph.wait_until(lambda: driver.subscription_count(topic) == 1, "they know each other")
    driver.hook(topic, STOP)
    driver.keep_publishing(topic, FAST)
    graph.wait_until(lambda: len(watcher.received(topic)) > 3, "the robot drives")
    return driver


@contextmanager
def late(graph: Any, receiver: Any) -> Iterator[None]:
    """Keep *receiver* from receiving meanwhile, and for a moment longer, as a busy machine or a poor network does."""
    receiver.signal(signal.SIGSTOP)
    try:
        yield
        graph.pass_time(0.3)
    finally:
        receiver.signal(signal.SIGCONT)


def assert_stopped(graph: Any, watcher: Any, topic: str) -> None:
    def is_stop(message: Any) -> bool:
        return bool(message["angular"]["z"] == STOP["angular"]["z"])

    graph.wait_until(lambda: any(map(is_stop, watcher.received(topic))), "the stop arrives")
    graph.pass_time(0.1)
    messages = watcher.received(topic)
    assert is_stop(messages[-1]), "the stop is the last word"


def test_closing_stops_the_robot(graph, right, topic):
    driver = driving(graph, right, topic)
    driver.close()
    assert_stopped(graph, right, topic)


def test_a_failing_hook_keeps_no_other_back(graph, right, topic):
    driver = graph.peer("driver_with_a_broken_hook")
    driver.advertise(topic, TWIST)
    right.subscribe(topic, TWIST)
    graph.wait_until(lambda: driver.subscription_count(topic) == 1, "they know each other")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "they know each other")
    driver.failing_hook()
    driver.hook(topic, STOP)
    driver.close()
    assert_stopped(graph, right, topic)
    assert "an exit hook failed: ValueError: this hook is broken" in driver.log()


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
@pytest.mark.parametrize("how", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_stops_the_robot(graph, right, topic, how):
    driver = driving(graph, right, f"{topic}/{how}")
    driver.signal(signal.Signals[how])
    code = driver.wait()
    assert_stopped(graph, right, f"{topic}/{how}")
    assert code == {"SIGINT": -2, "SIGTERM": 143, "SIGHUP": 129}[how]


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
@pytest.mark.parametrize(("how", "code"), [("exception", 1), ("exit", 7), ("return", 0)])
def test_the_end_of_the_program_stops_the_robot(graph, right, topic, how, code):
    driver = driving(graph, right, f"{topic}/{how}")
    getattr(driver, how)()
    assert driver.wait() == code
    assert_stopped(graph, right, f"{topic}/{how}")


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_busy_program_stops_the_robot_at_a_signal(graph, right, topic):
    driver = driving(graph, right, topic)
    driver.busy()
    driver.signal(signal.SIGTERM)
    assert driver.wait() == 143
    assert_stopped(graph, right, topic)


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_closed_node_costs_nothing(graph, right, topic):
    node = graph.peer("resting")
    node.advertise(topic, TWIST)
    right.subscribe(topic, TWIST)
    graph.wait_until(lambda: node.subscription_count(topic) == 1, "they know each other")
    node.close()
    graph.pass_time(0.3)  # the ends of its threads
    before = node.processor_seconds()
    graph.pass_time(1.0)
    assert node.processor_seconds() - before < 0.2


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_the_last_message_reaches_a_late_receiver_although_its_publisher_is_closed(graph, left, right, topic):
    right.subscribe(topic, TWIST)
    for number in range(1, 6):  # whether it is lost otherwise is a race in the receiver
        left.advertise(topic, TWIST)
        graph.wait_until(lambda: left.subscription_count(topic) == 1, "they know each other")
        left.publish(topic, FAST, times=2)
        last = {"linear": {"x": 0.0}, "angular": {"z": float(number)}}
        with late(graph, right):
            left.publish(topic, last)
            left.unadvertise(topic)
        graph.wait_until(
            lambda last=last: last["angular"]["z"] in [m["angular"]["z"] for m in right.received(topic)],
            f"message {number} arrives",
        )


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_signal_stops_a_robot_that_receives_late(graph, right, topic):
    for name in ("first", "second", "third"):
        driver = driving(graph, right, f"{topic}/{name}")
        with late(graph, right):
            driver.signal(signal.SIGTERM)
        assert driver.wait() == 143
        assert_stopped(graph, right, f"{topic}/{name}")


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_signal_cancels_goals_of_a_server_that_receives_late(graph, topic):
    server = graph.peer("late_server")
    server.serve_action(topic)
    for target in (1001, 1002, 1003):
        driver = graph.peer(f"sender_{target}")
        driver.send_goal("goal", topic, {"target": target, "period": 0.05}, timeout=30)
        with late(graph, server):
            driver.signal(signal.SIGTERM)
        assert driver.wait() == 143
        end = ["end", target, True]
        graph.wait_until(lambda end=end: end in server.deeds(topic), "the goal is cancelled")


@pytest.mark.only("ros2")
def test_the_last_line_of_the_log_reaches_a_late_receiver(graph, right):
    right.subscribe("/rosout", "rcl_interfaces/msg/Log", depth=1000, durability="transient_local")

    def heard(text: str) -> bool:
        return any(message["msg"] == text for message in right.received("/rosout"))

    for number in range(3):
        speaker = graph.peer(f"speaker_{number}")
        speaker.rosout("info", f"first line {number}")
        graph.wait_until(lambda number=number: heard(f"first line {number}"), "they know each other")
        with late(graph, right):
            speaker.rosout("info", f"last line {number}")
            speaker.signal(signal.SIGTERM)
        assert speaker.wait() == 143
        graph.wait_until(lambda number=number: heard(f"last line {number}"), "the last line arrives")
