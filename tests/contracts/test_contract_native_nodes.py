"""Contract: nodes written without us, in plain rospy and rclpy, understand us and we them."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.errors import CallTimedOut

pytestmark = pytest.mark.only("ros1", "ros2")


def program(graph: Any) -> list[str]:
    return [sys.executable, str(Path(__file__).with_name(f"native_{graph.kind}.py"))]


@pytest.fixture
def native(graph: Any) -> Iterator[None]:
    """The plain node, running."""
    process = subprocess.Popen(
        program(graph), env=os.environ | graph.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    assert process.stdout is not None
    try:
        while (line := process.stdout.readline()) != b"ready\n":  # Fast DDS 2 may report something there
            assert line, "the plain node ended"
        yield
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:  # a plain rclpy node sometimes misses its signal
            process.kill()
            process.wait()
        process.stdout.close()


def test_a_plain_node_echoes_our_message(graph, left, native):
    left.advertise("/native/in", "nav_msgs/msg/Odometry")
    left.subscribe("/native/out", "nav_msgs/msg/Odometry")
    graph.wait_until(lambda: left.subscription_count("/native/in") == 1, "the plain node listens")
    graph.wait_until(lambda: left.publisher_count("/native/out") == 1, "the plain node publishes")

    def arrives() -> bool:
        left.publish("/native/in", {"header": {"stamp": 7.25}, "pose": {"pose": {"position": {"x": 1.5}}}})
        return bool(left.received("/native/out"))

    graph.wait_until(arrives, "the echo arrives")
    message = left.received("/native/out")[0]
    assert message["pose"]["pose"]["position"]["x"] == 1.5
    assert message["header"]["stamp"] == {"sec": 7, "nanosec": 250_000_000}


def test_a_plain_nodes_latched_map_reaches_us(graph, right, native):
    right.subscribe("/native/map", "nav_msgs/msg/OccupancyGrid", durability="transient_local", depth=1)
    graph.wait_until(lambda: right.received("/native/map"), "the map arrives")
    assert right.received("/native/map")[0]["data"] == [0, 100, -1]


def test_a_plain_nodes_map_reaches_a_subscription_that_asks_for_what_is_available(graph, right, native):
    right.subscribe("/native/map", "nav_msgs/msg/OccupancyGrid", durability="best_available")
    graph.wait_until(lambda: right.received("/native/map"), "the map arrives")
    assert right.received("/native/map")[0]["data"] == [0, 100, -1]


def test_we_call_a_plain_nodes_service(graph, left, native):
    answers: list[Any] = []

    def answered() -> bool:
        # What a ROS 2 server answers before it has discovered the client's reader is lost.
        with suppress(CallTimedOut):
            answers.append(left.call("/native/add", {"a": 2, "b": 40}, timeout=5))
        return bool(answers)

    graph.wait_until(answered, "the plain node answers")
    assert answers == [{"sum": 42}]


def test_a_plain_node_calls_our_service(graph, left, topic):
    left.serve(topic)
    answer = subprocess.run(
        [*program(graph), topic],
        env=os.environ | graph.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        timeout=60,
        check=False,
    )
    assert answer.stdout.splitlines()[-1] == b"42"
