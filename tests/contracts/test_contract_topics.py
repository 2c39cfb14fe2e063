"""Contract: topics."""

from typing import Any

import pytest
from bridges import BRIDGED

from jacaros.robots.ros.errors import MessageMismatch, NameInvalid, RosError, UnknownInterface

Pair = tuple[Any, Any]


def connected(graph: Any, pair: Pair, topic: str, type_name: str, **qos: Any) -> Pair:
    """Let the left peer publish and the right one receive, and wait until they know each other."""
    left, right = pair
    left.advertise(topic, type_name, **qos)
    right.subscribe(topic, type_name, **qos)
    graph.wait_until(lambda: left.subscription_count(topic) == 1, "the publisher sees the subscription")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "the subscription sees the publisher")
    return left, right


def test_the_first_message_of_a_publisher_that_waited_for_its_match_arrives(graph, left, right, topic):
    for number in range(5):
        right.subscribe(f"{topic}/n{number}", "std_msgs/msg/Int32")
        left.publish_first(f"{topic}/n{number}", "std_msgs/msg/Int32", {"data": number})
    for number in range(5):
        graph.wait_until(lambda n=number: right.received(f"{topic}/n{n}"), f"message {number} arrives", 10)
        assert right.received(f"{topic}/n{number}") == [{"data": number}]


def test_messages_go_both_ways(graph, left, right, topic):
    connected(graph, (left, right), topic + "/to", "std_msgs/msg/Int32")
    connected(graph, (right, left), topic + "/fro", "std_msgs/msg/Int32")
    left.publish(topic + "/to", {"data": 1})
    right.publish(topic + "/fro", {"data": -2})
    graph.wait_until(lambda: right.received(topic + "/to") and left.received(topic + "/fro"), "both arrive")
    assert right.received(topic + "/to") == [{"data": 1}]
    assert left.received(topic + "/fro") == [{"data": -2}]


def test_messages_keep_their_order(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32", depth=100)
    left.publish_counted(topic, 100)
    graph.wait_until(lambda: len(right.received(topic)) == 100, "all arrive")
    assert [message["data"] for message in right.received(topic)] == list(range(100))


def test_a_nested_message_arrives_as_it_was_sent(graph, pair, topic):
    left, right = connected(graph, pair, topic, "nav_msgs/msg/Odometry")
    fields = {
        "header": {"stamp": 1234.5, "frame_id": "größe"},
        "child_frame_id": "base",
        "pose": {"pose": {"position": {"x": 1, "y": -2.5}}, "covariance": [0.5] * 36},
        "twist": {"twist": {"angular": {"z": 0.25}}},
    }
    left.publish(topic, fields)
    graph.wait_until(lambda: right.received(topic), "the message arrives")
    [message] = right.received(topic)
    assert message["header"]["stamp"] == {"sec": 1234, "nanosec": 500_000_000}
    assert message["header"]["frame_id"] == "größe"
    assert message["pose"]["pose"]["position"] == {"x": 1.0, "y": -2.5, "z": 0.0}
    assert message["pose"]["pose"]["orientation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    assert message["pose"]["covariance"] == [0.5] * 36
    assert message["twist"]["twist"]["angular"]["z"] == 0.25
    assert message["twist"]["covariance"] == [0.0] * 36


def test_arrays_of_all_kinds_arrive_as_they_were_sent(graph, pair, topic):
    left, right = pair
    cases = {
        "sensor_msgs/msg/LaserScan": {"ranges": [0.5, 1, 2.25], "intensities": []},
        "sensor_msgs/msg/Image": {"data": [0, 1, 255], "width": 3},
        "nav_msgs/msg/OccupancyGrid": {"data": [-1, 0, 100]},
        "sensor_msgs/msg/JointState": {"name": ["a", "b"], "position": [1.5, 2.5]},
        "nav_msgs/msg/Path": {"poses": [{"pose": {"position": {"x": 3.0}}}, {}]},
        "diagnostic_msgs/msg/DiagnosticStatus": {"level": 2, "values": [{"key": "k", "value": "v"}]},
        "std_msgs/msg/Empty": {},
    }
    for number, (type_name, fields) in enumerate(cases.items()):
        connected(graph, pair, f"{topic}/t{number}", type_name)
        left.publish(f"{topic}/t{number}", fields)
        graph.wait_until(lambda n=number: right.received(f"{topic}/t{n}"), f"{type_name} arrives")
        [message] = right.received(f"{topic}/t{number}")
        for name, value in fields.items():
            if name != "poses" and name != "values":
                assert message[name] == value, type_name
    assert right.received(f"{topic}/t4")[0]["poses"][0]["pose"]["position"]["x"] == 3.0
    assert right.received(f"{topic}/t4")[0]["poses"][1]["pose"]["orientation"]["w"] == 1.0
    assert right.received(f"{topic}/t5")[0]["values"] == [{"key": "k", "value": "v"}]


def test_a_sample_comes_on_the_thread_of_the_loop_with_topic_time_and_cause(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Bool")
    left.publish(topic, {"data": True})
    graph.wait_until(lambda: right.received(topic), "the message arrives")
    [sample] = right.samples(topic)
    assert sample["topic"] == topic
    assert sample["cause"] == ["sample", topic]
    assert 0 <= sample["age"] < 60
    assert right.callback_threads() == ["MainThread"]


def test_a_latched_message_waits_for_late_subscriptions(graph, left, right, topic):
    latched = {"durability": "transient_local", "depth": 1}
    left.advertise(topic, "std_msgs/msg/String", **latched)
    left.publish(topic, {"data": "old"})
    left.publish(topic, {"data": "map"})
    right.subscribe(topic, "std_msgs/msg/String", **latched)
    graph.wait_until(lambda: {"data": "map"} in right.received(topic), "the latched message arrives")
    right.subscribe(topic, "std_msgs/msg/String", key=topic + "#2", **latched)
    graph.wait_until(lambda: right.received(topic + "#2"), "it arrives at a second subscription, too")
    # What goes over a bridge may still be on its way when the subscription is made, which then sees both.
    assert right.received(topic) == [{"data": "map"}] or graph.kind in BRIDGED
    assert right.received(topic + "#2") == [{"data": "map"}]


@pytest.mark.parametrize("first", ["publisher", "subscription"])
def test_the_best_available_durability_gets_what_a_publisher_stores(graph, left, right, topic, first):
    topic = f"{topic}/{first}"
    if first == "subscription":
        right.subscribe(topic, "std_msgs/msg/String", durability="best_available")
        graph.pass_time(0.5)
    left.advertise(topic, "std_msgs/msg/String", durability="transient_local", depth=1)
    left.publish(topic, {"data": "map"})
    if first == "publisher":
        right.subscribe(topic, "std_msgs/msg/String", durability="best_available")
    graph.wait_until(lambda: {"data": "map"} in right.received(topic), "the stored message arrives")


@pytest.mark.only("memory", "ros1", "ros2")  # over rosbridge the server chooses the durability, once
def test_the_best_available_durability_excludes_no_publisher(graph, left, right, topic):
    left.advertise(topic, "std_msgs/msg/String", durability="transient_local", depth=1)
    left.publish(topic, {"data": "stored"})
    right.subscribe(topic, "std_msgs/msg/String", durability="best_available")
    graph.wait_until(lambda: {"data": "stored"} in right.received(topic), "the stored message arrives")
    right.advertise(topic, "std_msgs/msg/String")

    def heard() -> bool:
        right.publish(topic, {"data": "passing"})
        return {"data": "passing"} in right.received(topic)

    graph.wait_until(heard, "the message of a publisher that stores nothing arrives")


def test_a_volatile_topic_shows_nothing_of_the_past(graph, left, right, topic):
    connected(graph, (left, left), topic, "std_msgs/msg/String")
    left.publish(topic, {"data": "past"})
    graph.wait_until(lambda: left.received(topic), "it is past: who listens has heard it")
    left.unsubscribe(topic)
    graph.wait_until(lambda: left.subscription_count(topic) == 0, "no subscription is left")
    right.subscribe(topic, "std_msgs/msg/String")
    graph.wait_until(lambda: left.subscription_count(topic) == 1, "they know each other")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "they know each other")
    left.publish(topic, {"data": "now"})
    graph.wait_until(lambda: right.received(topic), "the new message arrives")
    assert right.received(topic) == [{"data": "now"}]


def test_best_effort_delivers_between_nodes_of_one_machine(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32", reliability="best_effort")

    def arrives() -> bool:
        left.publish(topic, {"data": 1})
        return bool(right.received(topic))

    graph.wait_until(arrives, "a message arrives")


@pytest.mark.only("memory", "ros2")
@pytest.mark.parametrize("weak", [{"reliability": "best_effort"}, {"durability": "volatile"}])
def test_a_subscription_gets_nothing_from_a_weaker_publisher(graph, left, right, topic, weak):
    topic = f"{topic}/{next(iter(weak))}"
    left.advertise(topic, "std_msgs/msg/Int32", **weak)
    strong = {"reliability": "reliable", "durability": "transient_local"} | {
        name: value for name, value in {"reliability": "reliable"}.items() if "durability" in weak
    }
    right.subscribe(topic, "std_msgs/msg/Int32", **strong)
    right.subscribe(topic, "std_msgs/msg/Int32", key=topic + "#weak", **weak)

    def arrives() -> bool:
        left.publish(topic, {"data": 1})
        return bool(right.received(topic + "#weak"))

    graph.wait_until(arrives, "the weak subscription receives")
    assert right.received(topic) == []


def test_a_slow_receiver_keeps_the_newest_messages(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32", depth=5)
    if graph.separate_processes:
        right.begin_call("stall", "/nowhere", {"a": 1, "b": 1}, timeout=0.01)
    left.publish_counted(topic, 200)
    graph.wait_until(
        lambda: right.received(topic) and right.received(topic)[-1]["data"] == 199, "the last one arrives"
    )
    numbers = [message["data"] for message in right.received(topic)]
    assert numbers == sorted(numbers)
    if not graph.separate_processes:
        assert numbers == [195, 196, 197, 198, 199]


def test_a_closed_subscription_receives_nothing(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32")
    right.subscribe(topic, "std_msgs/msg/Int32", key=topic + "#other")
    right.unsubscribe(topic)

    def arrives() -> bool:
        left.publish(topic, {"data": 1})
        return bool(right.received(topic + "#other"))

    graph.wait_until(arrives, "the other subscription receives")
    assert right.received(topic) == []


def test_a_subscription_closed_and_made_again_receives(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32")
    right.unsubscribe(topic)
    graph.wait_until(lambda: left.subscription_count(topic) == 0, "the publisher notices the leave")
    right.subscribe(topic, "std_msgs/msg/Int32")
    graph.wait_until(lambda: left.subscription_count(topic) == 1, "the publisher notices the return")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "the subscription sees the publisher")
    left.publish(topic, {"data": 4})
    graph.wait_until(lambda: right.received(topic), "the message arrives")


def test_a_closed_publisher_is_gone(graph, pair, topic):
    left, right = connected(graph, pair, topic, "std_msgs/msg/Int32")
    left.unadvertise(topic)
    graph.wait_until(lambda: right.publisher_count(topic) == 0, "the subscription notices")


def test_fields_do_for_a_message(graph, pair, topic):
    left, right = pair
    connected(graph, pair, topic, "geometry_msgs/msg/Twist")
    left.publish_fields(topic, {"linear": {"x": 1.5}})
    graph.wait_until(lambda: right.received(topic), "the message arrives")
    assert right.received(topic)[0]["linear"]["x"] == 1.5
    with pytest.raises(MessageMismatch, match="linaer"):
        left.publish_fields(topic, {"linaer": {"x": 1.5}})


def test_a_message_of_another_type_is_refused(graph, left, topic):
    left.advertise(topic, "std_msgs/msg/Int32")
    with pytest.raises(MessageMismatch, match=rf"{topic}: expected a std_msgs/msg/Int32"):
        left.publish_wrong_message(topic)


def test_wrong_fields_are_named(graph, left, topic):
    left.advertise(topic, "geometry_msgs/msg/Twist")
    with pytest.raises(MessageMismatch, match=r"no field 'liner'.*did you mean `linear`.*angular"):
        left.publish(topic, {"liner": {"x": 1}})
    with pytest.raises(MessageMismatch, match=r"linear\.x is float64, but 'fast' is given"):
        left.publish(topic, {"linear": {"x": "fast"}})


def test_an_unknown_type_is_refused(graph, left, right, topic):
    with pytest.raises(UnknownInterface, match="no_msgs/msg/Nothing"):
        left.advertise(topic, "no_msgs/msg/Nothing")
    with pytest.raises(UnknownInterface, match="std_msgs/msg/Nothing"):
        right.subscribe(topic, "std_msgs/msg/Nothing")


def test_wrong_names_and_wishes_are_refused(graph, left):
    with pytest.raises(NameInvalid, match="no spaces"):
        left.advertise("/no spaces", "std_msgs/msg/Int32")
    with pytest.raises(NameInvalid, match="Int32"):
        left.advertise("/fine", "Int32")
    with pytest.raises(RosError, match="depth"):
        left.advertise("/fine", "std_msgs/msg/Int32", depth=0)
    with pytest.raises(RosError, match="reliability"):
        left.advertise("/fine", "std_msgs/msg/Int32", reliability="good")
