"""What becomes of messages on their way over rosbridge: large ones, packed ones, odd numbers, nonsense."""

from typing import Any

import pytest
from bridges import BehindBridge, heard, talking

pytestmark = pytest.mark.rosbridge


def test_a_big_message_goes_both_ways(bridged: BehindBridge) -> None:
    left, right = bridged.peer("left"), bridged.peer("right")
    left.advertise("/image", "sensor_msgs/msg/Image")
    right.subscribe("/image", "sensor_msgs/msg/Image")
    bridged.wait_until(lambda: left.subscription_count("/image") == 1, "the topic is joined")
    data = [number % 256 for number in range(640 * 480 * 3)]
    left.publish("/image", {"width": 640, "height": 480, "step": 1920, "data": data})
    bridged.wait_until(lambda: right.received("/image"), "the image arrives")
    assert right.received("/image")[0]["data"] == data


def test_a_message_too_large_for_the_server_is_dropped_and_the_connection_stays(
    robot_of_ros2: BehindBridge,
) -> None:
    robot, client = talking(robot_of_ros2)
    client.publish("/to_robot", {"data": "x" * 10_000_000})
    assert any("does not take messages of this size" in line for line in client.log())
    client.publish("/to_robot", {"data": "short"})
    robot_of_ros2.wait_until(heard(robot, "/to_robot", "short"), "the connection is still there")
    assert client.connection() == [True]


NONSENSE = [
    *('{"op": "publish", "topic"', "[]", "7", '"op"', "{}", '{"op": ["publish"]}', '{"op": "publish"}'),
    *('{"op": "publish", "topic": ["/a"], "msg": {}}', '{"op": "publish", "topic": "/to_client", "msg": 7}'),
    *('{"op": "publish", "topic": "/to_client", "msg": {"data": {}}}', '{"op": "never heard of"}'),
    *('{"op": "service_response", "id": ["x"]}', '{"op": "service_response", "values": 7, "result": false}'),
    *('{"op": "call_service", "service": "/sum", "args": 7}', '{"op": "call_service", "service": {}}'),
    *('{"op": "action_result", "id": {}, "status": []}', '{"op": "send_action_goal", "action": []}'),
    '{"op": "status", "level": 7}',
    "[" * 100_000,
]


def test_nonsense_of_the_server_does_no_harm(robot_of_ros2: BehindBridge) -> None:
    robot, client = talking(robot_of_ros2)
    client.serve("/sum")
    for number, nonsense in enumerate(NONSENSE):
        robot_of_ros2.server.do("say", nonsense)
        robot.publish("/to_client", {"data": f"still here {number}"})
        robot_of_ros2.wait_until(heard(client, "/to_client", f"still here {number}"), f"after {nonsense:.60}")
    assert robot.call("/sum", {"a": 1, "b": 2}, timeout=60) == {"sum": 3}
    assert client.connection() == [True]


def test_numbers_that_json_cannot_write_arrive_as_nan(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.advertise("/scan", "sensor_msgs/msg/JointState")
    client.subscribe("/scan", "sensor_msgs/msg/JointState")
    bridged.wait_until(lambda: robot.subscription_count("/scan") == 1, "the topic is joined")
    robot.publish("/scan", {"header": {"frame_id": "x"}, "position": [1.5, float("inf"), float("nan")]})
    bridged.wait_until(lambda: client.received("/scan"), "the message arrives")
    [state] = client.received("/scan")
    assert state["position"][0] == 1.5
    assert [value != value for value in state["position"]] == [False, True, True]


def test_scans_arrive_packed_with_numbers_as_they_are(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.advertise("/scan", "sensor_msgs/msg/LaserScan")
    client.subscribe("/scan", "sensor_msgs/msg/LaserScan")
    bridged.wait_until(lambda: robot.subscription_count("/scan") == 1, "the topic is joined")
    robot.publish("/scan", {"ranges": [1.5, float("inf"), float("nan")], "range_max": float("inf")})
    bridged.wait_until(lambda: client.received("/scan"), "the scan arrives")
    [scan] = client.received("/scan")
    assert scan["ranges"][:2] == [1.5, float("inf")]
    assert scan["ranges"][2] != scan["ranges"][2]
    assert scan["range_max"] == float("inf")


ARRAYS: list[tuple[str, dict[str, Any]]] = [
    ("nav_msgs/msg/OccupancyGrid", {"info": {"width": 3, "height": 1}, "data": [-1, 0, 100]}),
    (
        "sensor_msgs/msg/PointCloud2",
        {"fields": [{"name": "x", "offset": 0, "datatype": 7, "count": 1}], "data": [0, 128, 255]},
    ),
    ("std_msgs/msg/UInt16MultiArray", {"data": [0, 65535]}),
    ("std_msgs/msg/Int64MultiArray", {"data": [-(2**63), 2**63 - 1]}),
    ("std_msgs/msg/UInt64MultiArray", {"data": [2**64 - 1]}),
    ("std_msgs/msg/Float64MultiArray", {"data": [0.1, -1e300]}),
    ("std_msgs/msg/UInt64", {"data": 2**64 - 1}),
    ("nav_msgs/msg/Odometry", {"pose": {"covariance": [0.5] * 36}}),
    ("sensor_msgs/msg/JointState", {"name": ["a", "b"], "position": [0.5, 1.5]}),
]


def test_arrays_of_all_sorts_arrive(robot_of_ros2: BehindBridge) -> None:
    robot, client = robot_of_ros2.peer("robot"), robot_of_ros2.peer("client")
    for number, (kind, fields) in enumerate(ARRAYS):
        topic = f"/a{number}"
        robot.advertise(topic, kind)
        client.subscribe(topic, kind)
        robot_of_ros2.wait_until(lambda t=topic: robot.subscription_count(t) == 1, "the topic is joined")
        robot.publish(topic, fields)
        robot_of_ros2.wait_until(lambda t=topic: client.received(t), f"the {kind} arrives")
        [got] = client.received(topic)
        assert _holds(got, fields), got


def _holds(got: Any, wanted: Any) -> bool:
    """Whether all that is wanted is there; messages may have further fields."""
    if isinstance(wanted, dict):
        return all(_holds(got[name], value) for name, value in wanted.items())
    if isinstance(wanted, list):
        return len(got) == len(wanted) and all(map(_holds, got, wanted))
    return bool(got == wanted)
