"""The graph inside the process: order, time and what only it promises."""

from typing import Any

import pytest
from graph_lab import GraphLab

from jacaros.robots.ros.errors import CallFailed, CallTimedOut
from jacaros.robots.ros.node import Publisher, Sample
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.clock import VIRTUAL_EPOCH

ADD, INT = "example_interfaces/srv/AddTwoInts", "std_msgs/msg/Int32"


def numbers(publisher: Publisher, *numbers: int) -> None:
    for number in numbers:
        publisher.publish(publisher.message(data=number))


async def test_messages_are_delivered_in_the_order_of_publishing_over_all_topics(lab: GraphLab) -> None:
    one, two = await lab.node("one"), await lab.node("two")
    got: list[Sample] = []
    for topic in ("/a", "/b"):
        for node in (one, two):
            node.subscription(topic, INT, got.append, QoS(depth=50))
    a, b = one.publisher("/a", INT), two.publisher("/b", INT)
    for number in range(5):
        numbers(a, number)
        numbers(b, number)
    assert got == []  # never inside publish
    await lab.clock.sleep(0)
    told = [(each.topic, each.message.data) for each in got]
    assert told == [(t, n) for n in range(5) for t in ("/a", "/a", "/b", "/b")]


async def test_a_message_is_passed_by_reference_and_takes_no_time(lab: GraphLab) -> None:
    node = await lab.node("node")
    publisher = node.publisher("/a", INT)
    got: list[Sample] = []
    node.subscription("/a", INT, got.append)
    await lab.clock.sleep(2.5)
    message = publisher.message(data=1)
    publisher.publish(message)
    await lab.clock.sleep(1)
    assert got[0].message is message
    assert got[0].stamp == VIRTUAL_EPOCH + 2.5


async def test_a_message_published_in_a_callback_comes_after_what_waits(lab: GraphLab) -> None:
    node = await lab.node("node")
    publisher = node.publisher("/a", INT)
    got: list[int] = []

    def receive(sample: Sample) -> None:
        got.append(sample.message.data)
        if sample.message.data == 1:
            numbers(publisher, 10)

    node.subscription("/a", INT, receive)
    numbers(publisher, 1, 2, 3)
    await lab.clock.sleep(0.1)
    assert got == [1, 2, 3, 10]


async def test_closing_in_a_callback_stops_what_waits(lab: GraphLab) -> None:
    node = await lab.node("node")
    publisher = node.publisher("/a", INT)
    got: list[int] = []

    def receive(sample: Sample) -> None:
        got.append(sample.message.data)
        subscription.close()

    subscription = node.subscription("/a", INT, receive)
    numbers(publisher, 1, 2, 3)
    await lab.clock.sleep(0.1)
    assert got == [1]
    assert publisher.subscription_count == 0


async def test_nodes_with_different_types_for_a_topic_both_log_it(lab: GraphLab) -> None:
    one, two = await lab.node("one"), await lab.node("two")
    publisher = one.publisher("/a", INT)
    got: list[Sample] = []
    subscription = two.subscription("/a", "std_msgs/msg/String", got.append)
    numbers(publisher, 1)
    await lab.clock.sleep(0)
    assert (got, publisher.subscription_count, subscription.publisher_count) == ([], 0, 0)
    types = ("std_msgs/msg/String", INT)
    assert lab.log == [
        "topic /a: /two expects {} and does not receive what is published here as {}".format(*types),
        "topic /a: /one publishes {1}, not {0}; to receive it, write {1} here".format(*types),
    ]


async def test_an_incompatible_wish_is_reported(lab: GraphLab) -> None:
    node = await lab.node("node")
    node.publisher("/a", INT, QoS(reliability="best_effort"))
    node.subscription("/a", INT, print)
    assert lab.log == [
        (
            "topic /a: incompatible QoS: not connected: the subscription requests reliable, "
            "the publisher offers best_effort; "
            "request at most what the publisher offers"
        )
    ]


async def test_transient_local_keeps_as_many_messages_as_its_depth(lab: GraphLab) -> None:
    node = await lab.node("node")
    kept = QoS(durability="transient_local", depth=3)
    numbers(node.publisher("/a", INT, kept), *range(5))
    got: list[Sample] = []
    node.subscription("/a", INT, got.append, kept)
    await lab.clock.sleep(0.1)
    assert [each.message.data for each in got] == [2, 3, 4]


async def test_leaving_nodes_take_their_topics_and_services_along(lab: GraphLab) -> None:
    one, two = await lab.node("one"), await lab.node("two")
    publisher = one.publisher("/a", INT)
    two.subscription("/a", INT, print)
    two.service("/add", ADD, lambda r: {"sum": r.a + r.b})
    client = one.client("/add", ADD)
    assert (publisher.subscription_count, client.ready) == (1, True)
    await two.close()
    assert (publisher.subscription_count, client.ready) == (0, False)
    assert two.connected is False


async def test_time_outs_are_measured_on_the_clock(lab: GraphLab) -> None:
    node = await lab.node("node")

    async def slow(request: Any) -> dict[str, int]:
        await lab.clock.sleep(100)
        return {"sum": request.a}

    node.service("/slow", ADD, slow)
    client = node.client("/slow", ADD)
    with pytest.raises(CallTimedOut):
        await client.call({"a": 1}, timeout=99)
    assert lab.clock.elapsed == 99
    assert (await client.call(client.request(a=7), timeout=101)).sum == 7
    assert lab.clock.elapsed == 199


async def test_waiting_for_the_server_uses_up_the_time_out(lab: GraphLab) -> None:
    node = await lab.node("node")

    async def slow(request: Any) -> None:
        await lab.clock.sleep(3)

    lab.clock.call_later(2, lambda: node.service("/slow", ADD, slow))
    with pytest.raises(CallTimedOut):
        await node.client("/slow", ADD).call({}, timeout=4)
    assert lab.clock.elapsed == 4


async def test_closing_a_service_fails_the_calls_under_way(lab: GraphLab) -> None:
    node = await lab.node("node")

    async def never(request: Any) -> None:
        await lab.clock.sleep(1e9)

    service = node.service("/never", ADD, never)
    lab.clock.call_later(5, service.close)
    with pytest.raises(CallFailed, match="closed during the call"):
        await node.client("/never", ADD).call({})


async def test_a_call_of_another_type_fails(lab: GraphLab) -> None:
    node = await lab.node("node")
    node.service("/add", ADD, lambda r: None)
    with pytest.raises(
        CallFailed, match="is of type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Empty"
    ):
        await node.client("/add", "std_srvs/srv/Empty").call()


async def test_a_newer_service_replaces_the_older_one(lab: GraphLab) -> None:
    node = await lab.node("node")
    old = node.service("/add", ADD, lambda r: {"sum": 1})
    node.service("/add", ADD, lambda r: {"sum": 2})
    old.close()
    assert (await node.client("/add", ADD).call()).sum == 2


def test_two_runs_are_the_same() -> None:
    def once() -> list[tuple[float, int]]:
        got: list[tuple[float, int]] = []

        async def scene(nodes: GraphLab) -> None:
            one, two = await nodes.node("one"), await nodes.node("two")
            publisher = one.publisher("/a", INT)
            two.subscription("/a", INT, lambda s: got.append((s.stamp, s.message.data)))
            two.service("/add", ADD, lambda r: {"sum": r.a + r.b})
            client = one.client("/add", ADD)
            for number in range(20):
                await nodes.clock.sleep(0.1)
                publisher.publish(publisher.message(data=(await client.call({"a": number, "b": 1})).sum))
            await nodes.clock.sleep(1)

        GraphLab.play(scene)
        return got

    assert once() == once()
    assert len(once()) == 20


def test_publishing_after_the_end_of_the_loop_does_nothing() -> None:
    publishers: list[Any] = []

    async def scene(nodes: GraphLab) -> None:
        node = await nodes.node("node")
        node.subscription("/a", INT, print)
        publishers.append(node.publisher("/a", INT))

    GraphLab.play(scene)
    publishers[0].publish(publishers[0].message(data=1))
