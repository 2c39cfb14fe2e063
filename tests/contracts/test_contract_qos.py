"""Contract: problems of topics are reported: other types, weak offers, missed deadlines."""

from typing import Any

import pytest

from jacaros.robots.ros.errors import CapabilityMissing

INT, TEXT = "std_msgs/msg/Int32", "std_msgs/msg/String"
NOTHING_MORE = 0.7
"""Seconds in which nothing more is to come."""


def troubles(peer: Any, key: str) -> list[str]:
    return [trouble for trouble, _ in peer.events(key)]


@pytest.mark.needs("events")
@pytest.mark.parametrize("first", ["publisher", "subscription"])
def test_a_topic_of_another_type_is_reported(graph, left, right, topic, first):
    topic = f"{topic}/{first}"
    if first == "publisher":
        left.advertise(topic, INT)
        graph.pass_time(0.2)
    right.subscribe(topic, TEXT, events=True)
    if first == "subscription":
        graph.pass_time(0.2)
        left.advertise(topic, INT)
    graph.wait_until(lambda: "other_type" in troubles(right, topic), "the problem is reported")
    [text] = {text for trouble, text in right.events(topic) if trouble == "other_type"}
    assert topic in text
    assert INT in text
    assert TEXT in text
    left.publish(topic, {"data": 1})
    graph.pass_time(0.1)
    assert right.received(topic) == []


@pytest.mark.needs("events")
def test_problems_without_a_callback_are_logged(graph, left, right, topic):
    left.advertise(topic, INT)
    right.subscribe(topic, TEXT)
    graph.wait_until(
        lambda: any(topic in line and INT in line and TEXT in line for line in right.log()),
        "it is in the log",
    )


@pytest.mark.needs("events")
@pytest.mark.parametrize("weak", [{"reliability": "best_effort"}, {"durability": "volatile"}])
def test_an_offer_that_is_too_weak_is_reported(graph, left, right, topic, weak):
    [word] = weak
    topic = f"{topic}/{word}"
    strong = {"reliability": "reliable"} if word == "reliability" else {"durability": "transient_local"}
    left.advertise(topic, INT, **weak)
    right.subscribe(topic, INT, events=True, **strong)
    if "qos" in right.capabilities():
        graph.wait_until(lambda: troubles(right, topic) == ["incompatible_qos"], "the problem is reported")
        assert topic in right.events(topic)[0][1]
        assert right.received(topic) == []
    else:  # there is no such thing as a weak offer: the message arrives
        graph.wait_until(lambda: right.publisher_count(topic) == 1, "they know each other")
        graph.wait_until(lambda: left.subscription_count(topic) == 1, "they know each other")
        left.publish(topic, {"data": 1})
        graph.wait_until(lambda: right.received(topic), "the message arrives")
        assert troubles(right, topic) == []


@pytest.mark.needs("deadlines", "events")
def test_a_missed_deadline_is_reported(graph, left, right, topic):
    if "deadlines" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="deadline"):
            left.advertise(topic, INT, deadline=0.5)
        with pytest.raises(CapabilityMissing, match="deadline"):
            right.subscribe(topic, INT, deadline=0.5)
        return
    left.advertise(topic, INT, deadline=0.5)
    right.subscribe(topic, INT, events=True, deadline=0.5)
    graph.wait_until(lambda: left.subscription_count(topic) == 1, "they know each other")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "they know each other")
    left.publish(topic, {"data": 1})
    graph.wait_until(lambda: right.received(topic), "the message arrives")
    graph.wait_until(lambda: "deadline_missed" in troubles(right, topic), "the deadline is missed")
    assert topic in right.events(topic)[0][1]
    assert set(troubles(right, topic)) == {"deadline_missed"}


@pytest.mark.needs("deadlines", "events")
def test_a_promise_longer_than_the_wish_is_too_weak(graph, left, right, topic):
    if "deadlines" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="deadline"):
            left.advertise(topic, INT, deadline=2.0)
        return
    left.advertise(topic, INT, deadline=2.0)
    right.subscribe(topic, INT, events=True, deadline=0.5)
    graph.wait_until(lambda: "incompatible_qos" in troubles(right, topic), "the problem is reported")
    left.publish(topic, {"data": 1})
    graph.pass_time(0.2)
    assert right.received(topic) == []


@pytest.mark.needs("events")
def test_nothing_is_logged_without_a_problem(graph, left, right, topic):
    left.advertise(topic, INT)
    right.subscribe(topic, INT, events=True)
    graph.wait_until(lambda: left.subscription_count(topic) == 1, "they know each other")
    graph.wait_until(lambda: right.publisher_count(topic) == 1, "they know each other")
    left.publish(topic, {"data": 1})
    graph.wait_until(lambda: right.received(topic), "the message arrives")
    graph.pass_time(NOTHING_MORE)
    assert right.events(topic) == []
