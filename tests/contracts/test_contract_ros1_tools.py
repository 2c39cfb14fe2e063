"""ROS 1 alone: its own tools and libraries (actionlib, rosparam, tf2_ros) understand us and we them."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.errors import GoalRejected, ParameterUnknown, ServerLost

pytestmark = [pytest.mark.only("ros1"), pytest.mark.slow]
PROGRAM = str(Path(__file__).with_name("native_ros1_tools.py"))
PATIENCE = 60.0


@contextmanager
def running(graph: Any, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A native program that runs until it is stopped."""
    process = subprocess.Popen(
        [sys.executable, PROGRAM, *arguments],
        env=os.environ | graph.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    assert process.stdout is not None
    try:
        assert process.stdout.readline() == b"ready\n"
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


@pytest.fixture
def native(graph: Any) -> Callable[..., str]:
    """Run a native program to its end and give the last line that it prints."""

    def run(*arguments: str) -> str:
        answer = subprocess.run(
            [sys.executable, PROGRAM, *arguments],
            env=os.environ | graph.environment,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
        assert answer.returncode == 0, answer.stderr
        return (answer.stdout.strip().splitlines() or [""])[-1]

    return run


def test_an_actionlib_server_executes_our_goals(graph, left):
    with running(graph, "serve"):
        left.send_goal("native", "/native/count", {"target": 4, "period": 0.05}, timeout=60)
        end = left.outcome("native", timeout=60)
        assert end == {"status": "succeeded", "result": {"last": 4, "message": ""}, "text": ""}
        # A server that has just been found may not have us among those who hear its feedback yet.
        assert left.feedback("native")[:3] in ([1, 2, 3], [2, 3, 4])
        left.send_goal("unlucky", "/native/count", {"target": 13}, timeout=60)
        end = left.outcome("unlucky", timeout=60)
        assert (end["status"], end["result"]["last"], end["text"]) == ("aborted", 13, "an unlucky number")
        left.send_goal("long", "/native/count", {"target": 1000, "period": 0.02}, timeout=60)
        assert left.cancel_goal("long", timeout=60) is True
        end = left.outcome("long", timeout=60)
        assert (end["status"], end["text"]) == ("canceled", "stopped")
        left.send_goal("older", "/native/count", {"target": 1000, "period": 0.02}, timeout=60)
        left.send_goal("newer", "/native/count", {"target": 1}, timeout=60)
        assert left.outcome("older", timeout=60)["status"] == "canceled"  # preempted by the newer one
        assert left.outcome("newer", timeout=60)["status"] == "succeeded"
    left.close_action_client("/native/count")


def test_a_genuine_server_refuses_and_is_deaf_and_recalls(graph, pair, native):
    left, right = pair
    with running(graph, "crowd"):
        with pytest.raises(GoalRejected, match="rejected the goal: not two"):
            left.send_goal("two", "/native/count", {"target": 2}, timeout=60)
        left.send_goal("three", "/native/count", {"target": 3}, timeout=60)
        # A server that has been asked is PREEMPTING at once, whatever its code does.
        assert left.cancel_goal("three", timeout=60) is True
        left.begin_send("one", "/native/count", {"target": 1})
        graph.wait_until(lambda: right.action_ready("/native/count"), "the other client sees the server")
        right.send_goal("four", "/native/count", {"target": 4}, timeout=60)
        assert right.outcome("four", timeout=60)["result"]["last"] == 4
        assert left.outcome("three", timeout=60)["status"] == "succeeded"
        native("cancel", "/native/count")  # cancelled before the server has begun with it: recalled
        left.end_send("one")
        assert left.outcome("one", timeout=60)["text"] == "never begun"
        assert left.outcome("one", timeout=60)["status"] == "canceled"
    for peer in pair:
        peer.close_action_client("/native/count")


def test_a_genuine_server_that_freezes_or_dies_is_lost(graph, left):
    with running(graph, "serve") as server:
        left.send_goal("frozen", "/native/count", {"target": 1000, "period": 0.02}, timeout=60)
        server.send_signal(signal.SIGSTOP)
        with pytest.raises(ServerLost):
            left.outcome("frozen", timeout=60)
        server.send_signal(signal.SIGCONT)
        left.send_goal("killed", "/native/count", {"target": 1000, "period": 0.02}, timeout=60)
        server.kill()
        with pytest.raises(ServerLost):
            left.outcome("killed", timeout=60)
    assert left.action_ready("/native/count") is False
    with running(graph, "serve"):
        left.send_goal("again", "/native/count", {"target": 1}, timeout=60)
        assert left.outcome("again", timeout=60)["status"] == "succeeded"
    left.close_action_client("/native/count")


def test_a_native_server_restarted_immediately_does_not_know_our_goal(graph, left):
    with running(graph, "serve") as server:
        left.send_goal("old", "/native/count", {"target": 1000, "period": 0.02}, timeout=60)
        server.kill()
    with running(graph, "serve"), pytest.raises(ServerLost):
        left.outcome("old", timeout=60)
    left.close_action_client("/native/count")


@pytest.mark.parametrize(
    ("behaviour", "target", "cancel", "end"),
    [
        ("count", "3", "", {"state": "SUCCEEDED", "last": 3, "feedback": [1, 2, 3], "text": "counted"}),
        ("count_and_tell_where", "1000", "cancel", {"state": "PREEMPTED", "feedback": [1, 2, 3]}),
        ("count", "-1", "", {"state": "REJECTED", "text": "the target is negative", "last": 0}),
        ("give_up", "5", "", {"state": "ABORTED", "text": "cannot count so far", "last": 1}),
        ("count", "100", "again", {"state": "SUCCEEDED", "last": 1}),
    ],
)
def test_a_genuine_client_uses_our_server(right, native, topic, behaviour, target, cancel, end):
    right.serve_action(topic, behaviour, preempt=True)
    answer = json.loads(native("use", topic, target, cancel))
    right.unserve_action(topic)
    assert answer["found"]
    assert answer["done"]
    wanted = end.get("feedback", [])
    # A client that was just found hears the first words, or comes too late for one.
    assert not wanted or answer["feedback"] in (wanted, wanted[1:], [number + 1 for number in wanted])
    assert {key: answer[key] for key in end} == end | ({"feedback": answer["feedback"]} if wanted else {})


def test_a_genuine_request_cancels_all_goals_of_our_server(graph, left, right, native, topic):
    right.serve_action(topic, "count")
    for key in ("a", "b"):
        left.send_goal(key, topic, {"target": 1000, "period": 0.05}, timeout=60)
    native("cancel", topic)
    for key in ("a", "b"):
        assert left.outcome(key, timeout=60)["status"] == "canceled"
    right.unserve_action(topic)


def test_rosparam_and_we_see_the_same_parameters(graph, left, right, native):
    left.set_parameter("wheels/radius", 0.25)
    left.set_parameter("rooms", ["hall", "kitchen"])
    assert native("rosparam", "get", "/left/wheels/radius") == "0.25"
    assert native("rosparam", "get", "/left/rooms") == "- kitchen"
    right.watch_parameters("left", "/left")
    graph.wait_until(
        lambda: (left.set_parameter("ping", 1), right.parameter_changes("left"))[1], "changes are reported"
    )
    native("rosparam", "set", "/left/wheels", "{radius: 0.5, spokes: {count: 12}}")
    graph.wait_until(
        lambda: {"wheels/spokes/count": 12} in right.parameter_changes("left"),
        "the change made by rosparam is reported",
    )
    assert right.get_parameter("wheels/spokes/count", "/left") == 12
    assert {"ping", "rooms", "wheels/radius", "wheels/spokes/count"} <= set(left.parameter_names())
    with pytest.raises(ParameterUnknown, match="is a mapping; read its parts: wheels/radius, wheels/spokes"):
        left.get_parameter("wheels")
    native("rosparam", "delete", "/left/wheels")
    assert not [name for name in left.parameter_names() if name.startswith("wheels")]
    left.set_parameter("/everywhere", True)
    assert right.get_parameter("everywhere", "/") is True
    right.unwatch_parameters("left")


def test_another_version_of_a_definition_is_reported(graph, left, topic):
    left.subscribe(topic, "std_msgs/msg/Int32", events=True)
    with running(graph, "other_definition", topic):
        graph.wait_until(lambda: left.events(topic), "the other version is reported")
    [[trouble, text]] = left.events(topic)
    assert trouble == "other_type"
    assert text.startswith(
        f"topic {topic}: a publisher has another definition of std_msgs/msg/Int32 "
        "(md5 sum 0123456789abcdef0123456789abcdef, here da5909fbe378aeaf85e547e830cc1bb7)"
    )


def test_tf2_and_we_see_the_same_frames(graph, left, right, native):
    with running(graph, "send_tf"):
        found = left.wait_for_transform("native_odom", "native_laser", timeout=60)
        assert found["x"] == pytest.approx(2.5)
    right.send_transform("our_odom", "our_base", 3.0, static=True)
    right.send_transform("our_base", "our_laser", 0.25, static=True)
    assert float(native("look_up_tf", "our_odom", "our_laser")) == pytest.approx(3.25)
