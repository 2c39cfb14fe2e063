"""Contract on ROS 2: who was killed is missed long before the graph takes them off its list."""

import pytest
from losses import lose_a_call

from jacaros.robots.ros.errors import ServerGone, ServerLost

pytestmark = pytest.mark.only("ros2")
LONG = {"target": 1000, "period": 0.1}
LOST = 60.0
STRING = "std_msgs/msg/String"


def test_a_server_that_is_killed_as_soon_as_it_has_accepted_is_lost(graph, left, topic):
    mortal = graph.peer("short_lived_server")
    mortal.serve_action(topic)
    left.send_goal(topic, topic, LONG, timeout=60)
    left.begin_outcome(topic)
    graph.kill(mortal)
    graph.wait_until(lambda: left.outcome_known(topic), "the loss is noticed", LOST)
    assert left.action_ready(topic), "the graph has noticed it first"
    with pytest.raises(ServerLost, match=topic):
        left.end_outcome(topic)


def test_a_server_that_is_killed_before_it_has_accepted_is_lost(graph, left, topic):
    mortal = graph.peer("never_accepting_server")
    mortal.serve_action(topic)
    graph.wait_until(lambda: left.action_ready(topic), "the action is found")
    graph.kill(mortal)
    left.begin_send(topic, topic, LONG)
    with pytest.raises(ServerLost, match=topic):
        left.end_send(topic)
    assert left.action_ready(topic), "the graph has noticed it first"


def test_a_call_of_a_service_that_is_killed_fails(graph, left, topic):
    lose_a_call(graph, left, topic, LOST)
    assert left.ready(topic), "the graph has noticed it first"
    with pytest.raises(ServerGone, match=topic):
        left.end_call(topic)


def test_a_killed_publisher_no_longer_counts(graph, left, topic):
    mortal = graph.peer("short_lived_publisher")
    left.subscribe(topic, STRING)
    mortal.advertise(topic, STRING)
    mortal.keep_publishing(topic, {"data": "alive"}, 0.1)
    graph.wait_until(lambda: len(left.received(topic)) > 80, "messages came for a while")
    assert left.publisher_count(topic) == 1
    graph.kill(mortal)
    graph.wait_until(lambda: left.publisher_count(topic) == 0, "the loss is noticed", LOST)
    assert left.contents()["topics"][topic]["publishers"], "the graph has noticed it first"
