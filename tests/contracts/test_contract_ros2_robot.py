"""Contract on ROS 2: actions and parameters of plain rclpy nodes, and plain rclpy nodes that use ours."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.errors import GoalRejected, ParameterRefused, ParameterUnknown, ServerLost

pytestmark = pytest.mark.only("ros2")
COUNT = "/native/count"
PROGRAM = [sys.executable, str(Path(__file__).with_name("native_ros2_robot.py"))]
LONG = {"target": 1000, "period": 0.1}
LOST = 60.0
"""Seconds after which a dead server must be noticed; the graph itself needs up to 20."""


@contextmanager
def running(graph: Any, mode: str) -> Iterator[subprocess.Popen[bytes]]:
    """A plain node."""
    process = subprocess.Popen(
        [*PROGRAM, mode],
        env=os.environ | graph.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    assert process.stdout is not None
    try:
        while (line := process.stdout.readline()) != b"ready\n":
            assert line, "the plain node ended"
        yield process
    finally:
        process.kill()  # plain nodes sometimes miss other signals
        process.wait()
        process.stdout.close()


def asked(graph: Any, *arguments: str) -> list[str]:
    """What a plain node prints that uses something of ours."""
    answer = subprocess.run(
        [*PROGRAM, *arguments],
        env=os.environ | graph.environment,
        capture_output=True,
        text=True,
        timeout=90,
        check=False,
    )
    assert answer.returncode == 0, answer.stderr
    words = ("counted", "cancelled", "accepted", "names", "put", "got")
    return [line for line in answer.stdout.splitlines() if line.startswith(words)]


@pytest.fixture
def native(graph: Any) -> Iterator[subprocess.Popen[bytes]]:
    """The plain node whose threads let it answer while it counts."""
    with running(graph, "serve") as process:
        yield process


def test_goals_of_a_plain_server(graph, left, topic, native):
    left.send_goal(topic, COUNT, {"target": 3, "period": 0.05}, timeout=60)
    assert left.outcome(topic, timeout=60) == {
        "status": "succeeded",
        "result": {"last": 3, "message": "counted natively"},
        "text": "counted natively",
    }
    heard = left.feedback(topic)
    assert heard == [1, 2, 3][3 - len(heard) :], "a server may not know yet who hears its first words"
    with pytest.raises(GoalRejected):
        left.send_goal(topic + "refused", COUNT, {"target": -1}, timeout=60)
    left.send_goal(topic + "long", COUNT, LONG, timeout=60)
    graph.wait_until(lambda: len(left.feedback(topic + "long")) > 2, "it is under way")
    heard = left.feedback(topic + "long")
    assert heard == list(range(heard[0], heard[0] + len(heard)))
    assert left.cancel_goal(topic + "long", timeout=60) is True
    end = left.outcome(topic + "long", timeout=60)
    assert (end["status"], end["text"]) == ("canceled", "as you wish")
    assert left.cancel_goal(topic + "long", timeout=60) is False


def test_many_goals_of_a_plain_server_at_once(graph, left, topic, native):
    for number in range(1, 9):
        left.begin_send(f"{topic}{number}", COUNT, {"target": number, "period": 0.01}, timeout=60)
    for number in range(1, 9):
        left.end_send(f"{topic}{number}")
    ends = [left.outcome(f"{topic}{number}", timeout=60)["result"]["last"] for number in range(1, 9)]
    assert ends == list(range(1, 9))


def test_a_plain_server_that_is_killed_is_lost(graph, left, topic, native):
    left.send_goal(topic, COUNT, LONG, timeout=60)
    graph.wait_until(lambda: len(left.feedback(topic)) > 10, "it is under way")
    left.begin_outcome(topic)
    native.send_signal(signal.SIGKILL)
    graph.wait_until(lambda: left.outcome_known(topic), "the loss is noticed", LOST)
    with pytest.raises(ServerLost, match=COUNT):
        left.end_outcome(topic)
    with running(graph, "serve"):  # and the next one is found by the same client
        left.send_goal(topic + "again", COUNT, {"target": 1}, timeout=60)
        assert left.outcome(topic + "again", timeout=60)["status"] == "succeeded"


def test_a_plain_server_that_cannot_answer_while_it_works_is_not_lost(graph, left, topic):
    with running(graph, "block"):
        for goal in ("first", "second"):
            left.send_goal(topic + goal, COUNT, {"target": 1, "period": 8.0}, timeout=60)
            assert left.outcome(topic + goal, timeout=60)["text"] == "counted natively"


def test_a_plain_client_uses_our_action(graph, right, topic):
    right.serve_action(topic)
    assert asked(graph, "goal", topic) == ["counted 4 3 3", "cancelled 0 1 5", "accepted False"]


def test_parameters_of_a_plain_node(graph, left, right, topic, native):
    node = "/native_serve"
    assert {"speed", "rooms", "use_sim_time"} <= set(left.parameter_names(node, timeout=60))
    assert left.get_parameter("speed", node, timeout=60) == 0.5
    assert left.get_parameter("rooms", node, timeout=60) == ["kitchen", "hall"]
    right.watch_parameters(topic, node)

    def told() -> bool:
        left.set_parameter("speed", 0.25, node, timeout=60)
        return {"speed": 0.25} in right.parameter_changes(topic)

    graph.wait_until(told, "the change is reported")
    left.set_parameter("rooms", [], node, timeout=60)
    assert left.get_parameter("rooms", node, timeout=60) == []
    with pytest.raises(ParameterRefused, match="range"):
        left.set_parameter("speed", 7.0, node, timeout=60)
    with pytest.raises(ParameterRefused, match="type"):
        left.set_parameter("speed", "fast", node, timeout=60)
    with pytest.raises(ParameterUnknown, match="colour"):
        left.set_parameter("colour", "red", node, timeout=60)
    with pytest.raises(ParameterUnknown, match="colour"):
        left.get_parameter("colour", node, timeout=60)


def test_parameters_of_a_killed_and_restarted_node_are_read(graph, left):
    """The one that was killed is still in the graph, and alone there for a moment: it is asked, and never answers."""
    node = "/native_serve"
    with running(graph, "serve"):
        assert "speed" in left.parameter_names(node, timeout=60)
    with running(graph, "serve"):
        assert "speed" in left.parameter_names(node, timeout=40)
        assert left.get_parameter("speed", node, timeout=60) == 0.5


def test_a_question_about_parameters_is_repeated_when_the_response_is_lost(graph, left):
    """A server that discovers the client late, as on a busy machine, loses its first response."""
    with running(graph, "forget"):
        assert left.parameter_names("/native_forget", timeout=60) == ["speed"]


def test_a_plain_node_uses_our_parameters(graph, pair):
    cruiser = graph.peer("cruiser")
    cruiser.declare("lanes", 4, minimum=0, maximum=10)
    assert asked(graph, "ask", "/cruiser") == ["names True True", "put True False", "got 6"]
    assert cruiser.get_parameter("lanes") == 6


@pytest.mark.parametrize("ending", ["signal", "return", "exception"])
def test_goals_of_a_process_that_stops_are_cancelled(graph, right, topic, ending):
    leaver, name = graph.peer(f"leaver_{ending}"), f"{topic}_{ending}"
    right.serve_action(name)
    graph.wait_until(lambda: leaver.action_ready(name), "the action is found")
    leaver.send_goal(name, name, {"target": 500, "period": 0.05}, timeout=60)
    graph.wait_until(lambda: leaver.feedback(name), "it is under way")
    if ending == "signal":
        leaver.signal(signal.SIGTERM)
    else:
        getattr(leaver, ending)()
    graph.wait_until(lambda: ["end", 500, True] in right.deeds(name), "the goal is cancelled")
    graph.wait_until(leaver.is_over, "the process ends")
