"""Contract: transforms are sent, heard, looked up and awaited."""

import math
from typing import Any

import pytest

from jacaros.robots.ros.errors import CapabilityMissing, TransformUnavailable

Pair = tuple[Any, Any]
pytestmark = [pytest.mark.needs("listening", "transforms")]
HALF = math.sqrt(0.5)


@pytest.fixture
def frame(own_name: str) -> str:
    """The beginning of names of frames that belong to this test."""
    return own_name


def hearing(graph: Any, pair: Pair, frame: str) -> Pair:
    """Let the right peer listen until it hears the left one."""
    left, right = pair
    right.listen_to_transforms()

    def heard() -> bool:
        left.send_transform(f"{frame}_root", f"{frame}_probe", 1.0, stamp=1.0)
        try:
            right.look_up(f"{frame}_root", f"{frame}_probe")
        except TransformUnavailable:
            return False
        return True

    graph.wait_until(heard, "transforms arrive")
    return left, right


def test_transforms_are_a_capability(graph, left):
    if "transforms" in left.capabilities():
        left.listen_to_transforms()
        left.send_transform("capable_root", "capable", 1.0)
        return
    with pytest.raises(CapabilityMissing, match="tf2_msgs"):
        left.send_transform("root", "child", 1.0)
    with pytest.raises(CapabilityMissing, match="tf2_msgs"):
        left.look_up("root", "child")


def test_a_way_over_several_frames_and_nodes_is_found(graph, pair, frame):
    left, right = hearing(graph, pair, frame)
    base, laser, world = f"{frame}_base", f"{frame}_laser", f"{frame}_world"
    left.send_transform(world, base, 2.0, HALF, HALF, stamp=5.0)  # turned by 90 degrees
    right.send_transform(base, laser, 0.5, static=True)
    found = right.wait_for_transform(world, laser, timeout=60)
    assert found["x"] == pytest.approx(2.0)
    assert found["y"] == pytest.approx(0.5)
    assert found["yaw"] == pytest.approx(math.pi / 2)
    assert found["stamp"] == pytest.approx(5.0)
    back = right.look_up(laser, world)
    assert (back["x"], back["y"]) == (pytest.approx(-0.5), pytest.approx(2.0))


def test_static_transforms_of_several_nodes_reach_late_listeners(graph, left, right, frame):
    left.send_transform(f"{frame}_base", f"{frame}_laser", 0.5, static=True)
    right.send_transform(f"{frame}_base", f"{frame}_camera", 0.25, static=True)
    late = graph.peer("late_listener")
    found = late.wait_for_transform(f"{frame}_camera", f"{frame}_laser", timeout=60)
    assert (found["x"], found["stamp"]) == (pytest.approx(0.25), 0.0)


def test_one_latched_message_has_all_static_transforms_of_a_node(graph, left, right, frame):
    children = [f"{frame}_laser", f"{frame}_bumper"]
    for child in children:
        left.send_transform(f"{frame}_base", child, 0.5, static=True)
    right.subscribe("/tf_static", "tf2_msgs/msg/TFMessage", durability="transient_local", depth=1)

    def both_arrive() -> bool:
        told = [[each["child_frame_id"] for each in m["transforms"]] for m in right.received("/tf_static")]
        return any(names[-2:] == children for names in told)

    graph.wait_until(both_arrive, "both arrive in one message")
    right.unsubscribe("/tf_static")


def test_between_two_times_it_is_interpolated(graph, pair, frame):
    left, right = hearing(graph, pair, frame)
    for stamp in (10.0, 11.0):
        left.send_transform(f"{frame}_odom", f"{frame}_base", stamp, stamp=stamp)
    found = right.wait_for_transform(f"{frame}_odom", f"{frame}_base", 10.25, timeout=60)
    assert (found["x"], found["stamp"]) == (pytest.approx(10.25), pytest.approx(10.25))


@pytest.mark.parametrize(("stamp", "reason"), [(9.0, "too_old"), (12.0, "too_new")])
def test_a_time_that_is_not_known_is_refused(graph, pair, frame, stamp, reason):
    left, right = hearing(graph, pair, frame)
    for moment in (10.0, 11.0):
        left.send_transform(f"{frame}_odom", f"{frame}_base", moment, stamp=moment)
    right.wait_for_transform(f"{frame}_odom", f"{frame}_base", 11.0, timeout=60)
    with pytest.raises(TransformUnavailable, match="known from 10") as caught:
        right.look_up(f"{frame}_odom", f"{frame}_base", stamp)
    assert caught.value.reason == reason


def test_missing_things_are_reported(graph, pair, frame):
    left, right = hearing(graph, pair, frame)
    with pytest.raises(TransformUnavailable, match=f"{frame}_nowhere") as caught:
        right.look_up(f"{frame}_root", f"{frame}_nowhere")
    assert caught.value.reason == "unknown_frame"
    left.send_transform(f"{frame}_other_root", f"{frame}_other", 1.0, static=True)
    right.wait_for_transform(f"{frame}_other_root", f"{frame}_other", timeout=60)
    with pytest.raises(TransformUnavailable, match="not connected") as caught:
        right.look_up(f"{frame}_root", f"{frame}_other")
    assert caught.value.reason == "not_connected"


def test_a_transform_that_comes_late_is_awaited(graph, pair, frame):
    left, right = hearing(graph, pair, frame)
    right.begin_wait_for_transform(frame, f"{frame}_odom", f"{frame}_base", 20.5, timeout=60)
    for stamp in (20.0, 21.0):
        graph.pass_time(0.05)
        left.send_transform(f"{frame}_odom", f"{frame}_base", stamp, stamp=stamp)
    assert right.end_wait_for_transform(frame)["x"] == pytest.approx(20.5)


def test_waiting_ends_with_the_reason(graph, right, frame):
    with pytest.raises(TransformUnavailable, match=rf"{frame}_nowhere.*waited 0\.2 s") as caught:
        right.wait_for_transform(f"{frame}_root", f"{frame}_nowhere", timeout=0.2)
    assert caught.value.reason == "unknown_frame"
