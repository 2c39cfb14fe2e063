"""Contract: names, namespaces and the fields of messages."""

import pytest


def test_names_are_resolved_in_the_namespace(graph):
    robot = graph.peer("brain", namespace="robot1", remap={"scan": "/front/scan", "~x": "y"})
    assert robot.node_name() == "/robot1/brain"
    assert robot.resolve("odom") == "/robot1/odom"
    assert robot.resolve("/odom") == "/odom"
    assert robot.resolve("~goal") == "/robot1/brain/goal"
    assert robot.resolve("scan") == "/front/scan"
    assert robot.resolve("~x") == "/robot1/y"


@pytest.mark.needs("services")
def test_namespaces_reach_the_graph(graph, right, own_name):
    robot = graph.peer("brain2", namespace=f"/{own_name}", remap={"scan": f"/other/{own_name}"})
    assert robot.advertise("odom", "std_msgs/msg/Int32") == f"/{own_name}/odom"
    assert robot.advertise("scan", "std_msgs/msg/Int32") == f"/other/{own_name}"
    assert robot.serve("~add") == f"/{own_name}/brain2/add"
    for written, absolute in (("odom", f"/{own_name}/odom"), ("scan", f"/other/{own_name}")):
        right.subscribe(absolute, "std_msgs/msg/Int32")
        graph.wait_until(lambda w=written: robot.subscription_count(w) == 1, "they know each other")
        graph.wait_until(lambda a=absolute: right.publisher_count(a) == 1, "they know each other")
        robot.publish(written, {"data": 5})
        graph.wait_until(lambda a=absolute: right.received(a), "the message arrives")
    assert right.call(f"/{own_name}/brain2/add", {"a": 1, "b": 2}, timeout=60) == {"sum": 3}


def test_two_robots_do_not_receive_each_others_messages(graph, own_name):
    one = graph.peer("one", namespace=f"{own_name}/r1")
    two = graph.peer("two", namespace=f"{own_name}/r2")
    for robot in (one, two):
        robot.advertise("cmd", "std_msgs/msg/String")
        robot.subscribe("cmd", "std_msgs/msg/String")
        graph.wait_until(lambda r=robot: r.subscription_count("cmd") == 1, "each hears itself")
    one.publish("cmd", {"data": "one"})
    two.publish("cmd", {"data": "two"})
    graph.wait_until(lambda: one.received("cmd") and two.received("cmd"), "both arrive")
    assert one.received("cmd") == [{"data": "one"}]
    assert two.received("cmd") == [{"data": "two"}]


def test_a_started_node_is_connected(left):
    assert left.connected() is True
    assert left.connection() == [True]


def test_fields_are_described_alike_everywhere(left):
    assert left.fields("geometry_msgs/Twist") == {
        "linear": "geometry_msgs/msg/Vector3",
        "angular": "geometry_msgs/msg/Vector3",
    }
    pose = left.fields("geometry_msgs/msg/PoseWithCovariance")
    assert pose == {"pose": "geometry_msgs/msg/Pose", "covariance": "float64[36]"}
    scan = left.fields("sensor_msgs/msg/LaserScan")
    assert (scan["header"], scan["ranges"], scan["range_max"]) == (
        "std_msgs/msg/Header",
        "float32[]",
        "float32",
    )
    assert left.fields("std_msgs/msg/Header")["stamp"] == "builtin_interfaces/msg/Time"
    assert left.fields("std_msgs/msg/Empty") == {}
