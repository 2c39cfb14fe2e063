"""Contract: the last messages of a process."""

import signal
from typing import Any

import pytest

Pair = tuple[Any, Any]
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


def assert_stopped(graph: Any, watcher: Any, topic: str) -> None:
    def is_stop(message: Any) -> bool:
        return bool(message["angular"]["z"] == STOP["angular"]["z"])

    graph.wait_until(lambda: any(map(is_stop, watcher.received(topic))), "the stop arrives")
    graph.pass_time(0.1)
    messages = watcher.received(topic)
    assert is_stop(messages[-1]), "the stop is the last word"


def test_closing_stops_the_robot(graph: Any, pair: Pair, topic: str) -> None:
    _, watcher = pair
    driver = driving(graph, watcher, topic)
    driver.close()
    assert_stopped(graph, watcher, topic)


def test_a_failing_hook_keeps_no_other_back(graph: Any, pair: Pair, topic: str) -> None:
    _, watcher = pair
    driver = graph.peer("driver_with_a_broken_hook")
    driver.advertise(topic, TWIST)
    watcher.subscribe(topic, TWIST)
    graph.wait_until(lambda: driver.subscription_count(topic) == 1, "they know each other")
    graph.wait_until(lambda: watcher.publisher_count(topic) == 1, "they know each other")
    driver.failing_hook()
    driver.hook(topic, STOP)
    driver.close()
    assert_stopped(graph, watcher, topic)
    assert "an exit hook failed: ValueError: this hook is broken" in driver.log()


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
@pytest.mark.parametrize("how", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_stops_the_robot(graph: Any, pair: Pair, topic: str, how: str) -> None:
    _, watcher = pair
    driver = driving(graph, watcher, f"{topic}/{how}")
    driver.signal(signal.Signals[how])
    code = driver.wait()
    assert_stopped(graph, watcher, f"{topic}/{how}")
    assert code == {"SIGINT": -2, "SIGTERM": 143, "SIGHUP": 129}[how]


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
@pytest.mark.parametrize(("how", "code"), [("exception", 1), ("exit", 7), ("return", 0)])
def test_the_end_of_the_program_stops_the_robot(
    graph: Any, pair: Pair, topic: str, how: str, code: int
) -> None:
    _, watcher = pair
    driver = driving(graph, watcher, f"{topic}/{how}")
    getattr(driver, how)()
    assert driver.wait() == code
    assert_stopped(graph, watcher, f"{topic}/{how}")


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_busy_program_stops_the_robot_at_a_signal(graph: Any, pair: Pair, topic: str) -> None:
    _, watcher = pair
    driver = driving(graph, watcher, topic)
    driver.busy()
    driver.signal(signal.SIGTERM)
    assert driver.wait() == 143
    assert_stopped(graph, watcher, topic)


@pytest.mark.only("ros1", "ros2", "rosbridge-ros2")
def test_a_closed_node_costs_nothing(graph: Any, pair: Pair, topic: str) -> None:
    _, watcher = pair
    node = graph.peer("resting")
    node.advertise(topic, TWIST)
    watcher.subscribe(topic, TWIST)
    graph.wait_until(lambda: node.subscription_count(topic) == 1, "they know each other")
    node.close()
    graph.pass_time(0.3)  # the ends of its threads
    before = node.processor_seconds()
    graph.pass_time(1.0)
    assert node.processor_seconds() - before < 0.2
