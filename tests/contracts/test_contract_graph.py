"""Contract: the contents of the graph, its log, and what each backend can do."""

from typing import Any

import pytest
from expected import CAPABILITIES

from jacaros.robots.ros.errors import RosError

ADD = "example_interfaces/srv/AddTwoInts"
COUNT = "jacaros_interfaces/action/Count"


def test_the_capabilities_are_those_that_were_promised(graph, left):
    assert set(left.capabilities()) == CAPABILITIES[graph.kind]


@pytest.mark.needs("contents")
def test_topics_are_seen_with_their_types_and_ends(graph, left, right, topic):
    left.advertise(topic, "sensor_msgs/msg/LaserScan", reliability="best_effort", depth=3)
    right.subscribe(topic, "sensor_msgs/msg/LaserScan", reliability="best_effort", depth=7)

    def is_seen() -> Any:
        seen = left.contents()["topics"].get(topic)
        return seen if seen and seen["publishers"] and seen["subscriptions"] else None

    graph.wait_until(is_seen, "the topic is seen with both ends")
    seen = is_seen()
    assert seen["name"] == topic
    assert list(seen["types"]) == ["sensor_msgs/msg/LaserScan"]
    for end, peer in (("publishers", left), ("subscriptions", right)):
        [endpoint] = seen[end]
        assert endpoint["node"] in (graph.node_of(peer), "")
        if "qos in the graph" in left.capabilities():
            assert endpoint["qos"]["reliability"] == "best_effort"
            assert endpoint["qos"]["durability"] == "volatile"
        else:
            assert endpoint["qos"] is None


@pytest.mark.needs("contents")
def test_a_topic_without_endpoints_is_gone(graph, left, right, topic):
    left.advertise(topic, "std_msgs/msg/Int32")
    graph.wait_until(lambda: right.contents()["topics"].get(topic, {}).get("publishers"), "the topic is seen")
    left.unadvertise(topic)
    graph.wait_until(
        lambda: not right.contents()["topics"].get(topic, {}).get("publishers"), "the topic is gone"
    )


@pytest.mark.needs("contents", "services")
def test_services_are_seen(graph, left, right, topic):
    right.serve(topic)
    graph.wait_until(lambda: topic in left.contents()["services"], "the service is seen")
    assert left.contents()["services"][topic] in (ADD, "jacaros_interfaces/srv/AddTwoInts", "")


@pytest.mark.needs("contents", "actions")
def test_actions_are_seen_but_not_what_they_are_made_of(graph, left, right, topic):
    right.serve_action(topic)
    graph.wait_until(lambda: left.contents()["actions"].get(topic) == COUNT, "the action is seen")
    seen = left.contents()
    assert not [name for name in (*seen["topics"], *seen["services"]) if name.startswith(topic)]
    left.action_ready(topic)  # makes a client, which alone is not an action
    right.unserve_action(topic)
    graph.wait_until(lambda: topic not in left.contents()["actions"], "the action is gone")


@pytest.mark.needs("contents")
def test_nodes_are_seen(graph, left, right):
    graph.wait_until(
        lambda: {graph.node_of(left), graph.node_of(right)} <= set(left.contents()["nodes"]),
        "both nodes are seen",
    )
    names = list(left.contents()["nodes"])
    assert names == sorted(names)


@pytest.mark.needs("contents", "rosout")
def test_internal_topics_are_omitted(graph, left):
    left.rosout("info", "plumbing")
    seen = left.contents()
    assert not {"/rosout", "/parameter_events"} & set(seen["topics"])
    parts = ("get_parameters", "set_parameters", "describe_parameters", "get_loggers", "set_logger_level")
    assert not [name for name in seen["services"] if name.rsplit("/", 1)[-1] in parts]


@pytest.mark.only("ros2")
def test_services_of_a_node_that_has_ended_are_omitted(graph, left, right, topic):
    own = f"{topic}/get_parameters"
    right.serve("/ended/get_parameters", type_name="rcl_interfaces/srv/GetParameters")
    right.serve(own)
    graph.wait_until(lambda: own in left.contents()["services"], "a service that is only called so is seen")
    assert "/ended/get_parameters" not in left.contents()["services"]


@pytest.mark.needs("rosout")
def test_lines_reach_the_log_of_the_graph(graph, left, right):
    ros1 = left.ros_version() == 1
    right.subscribe("/rosout", "rosgraph_msgs/msg/Log" if ros1 else "rcl_interfaces/msg/Log", depth=1000)
    numbers = (1, 2, 4, 8, 16) if ros1 else (10, 20, 30, 40, 50)
    levels = dict(zip(("debug", "info", "warn", "error", "fatal"), numbers, strict=True))
    for level, number in levels.items():
        graph.wait_until(
            lambda level=level, number=number: _arrives(left, right, level, number),
            f"a line of level {level} arrives",
        )
    with pytest.raises(RosError, match="unknown log level 'loud'"):
        left.rosout("loud", "text")


def _arrives(left: Any, right: Any, level: str, number: int) -> bool:
    text = f"a line of level {level}"
    left.rosout(level, text)
    lines = [line for line in right.received("/rosout") if line["msg"] == text]
    assert {(line["level"], line["name"].strip("/")) for line in lines} <= {
        (number, left.node_name().strip("/"))
    }
    return bool(lines)
