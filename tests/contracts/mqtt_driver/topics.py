"""Topics over MQTT: a message is JSON at the broker's topic of that name and type."""

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from jacaros.robots.ros.message import plain
from jacaros.robots.ros.node import SharedSubscription, SubscriptionOptions, TopicMultiplexer, TopicPublisher
from jacaros.robots.ros.qos import QoS

if TYPE_CHECKING:
    from mqtt_driver.backend import MqttBackend


MESSAGES = "jacaros/messages"


def place_of(publisher: str, type_name: str, topic: str) -> str:
    """Where the broker has the messages of a node (``+``: of all) at a topic.

    The broker keeps one message at each place, so each publisher has its own. Messages of another type are not read.
    """
    return f"{MESSAGES}/{publisher}/{type_name.replace('/', '.')}{topic}"


def parts_of(place: str) -> tuple[str, str, str]:
    """Publisher, type and topic of a place."""
    publisher, kind, topic = place.removeprefix(f"{MESSAGES}/").split("/", 2)
    return publisher, kind.replace(".", "/"), f"/{topic}"


class MqttPublisher(TopicPublisher["MqttBackend"]):
    """Publisher of `MqttBackend`."""

    def __init__(self, node: "MqttBackend", topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self._place = place_of(node.number, type_name, topic)
        self._last: Any = None
        node.loop.call_soon(node.announce)  # when it is among the node's members

    @property
    def subscription_count(self) -> int:
        """How many nodes subscribe."""
        return self._node.types_at(self.topic, "in").count(self.type_name)

    def join(self) -> None:
        """Say again what late subscriptions are to hear, at a broker that may have forgotten it."""
        if self._last is not None:
            self._send(self._last)

    def _send(self, message: Any) -> None:
        payload = json.dumps(plain(message))
        level = 0 if self.qos.reliability == "best_effort" else 1
        self._last = message if self.latched else None
        self._node.do(lambda client: client.publish(self._place, payload, qos=level, retain=self.latched))

    def _leave(self) -> None:
        if self._last is not None:
            self._node.do(lambda client: client.publish(self._place, b"", qos=1, retain=True))
        self._node.announce()


class MqttMultiplexer(TopicMultiplexer["MqttSubscription"]):
    """The node's one subscription of a topic at the broker."""

    def __init__(self, node: "MqttBackend", topic: str, type_name: str) -> None:
        super().__init__(topic, type_name)
        self._node = node
        self._place = place_of("+", type_name, topic)
        self._kept: dict[str, bytes] = {}
        self.join()
        node.loop.call_soon(node.announce)  # when it is among the node's multiplexers

    @property
    def publisher_count(self) -> int:
        """How many nodes publish."""
        return self._node.types_at(self.topic, "out").count(self.type_name)

    def join(self) -> None:
        """Subscribe at a broker that does not know us yet."""
        self._kept.clear()
        self._node.do(lambda client: client.subscribe(self._place, qos=1))

    def latched(self, reader: "MqttSubscription") -> Iterable[bytes]:
        """What each publisher said last, for those who ask for it."""
        return self._kept.values() if reader.latched else ()

    def received(self, publisher: str, payload: bytes, kept: bool) -> None:
        """Take a message; *kept*: it is from the time before we subscribed."""
        self._kept.pop(publisher, None)
        if payload:  # else the publisher has gone
            self._kept[publisher] = payload
        for reader in self.readers:
            if payload and (reader.latched or not kept):
                reader.put(payload)

    def _leave(self) -> None:
        self._node.do(lambda client: client.unsubscribe(self._place))
        self._node.loop.call_soon(self._node.announce)


class MqttSubscription(SharedSubscription["MqttBackend"]):
    """Subscription of `MqttBackend`; messages are decoded when it is their turn."""

    def __init__(self, node: "MqttBackend", wanted: SubscriptionOptions) -> None:
        super().__init__(node, wanted, node.multiplexers, MqttMultiplexer)

    def deliver(self, message: bytes) -> None:
        """Decode a message and hand it over."""
        super().deliver(self._node.factory.make(self.type_name, json.loads(message)))
        self._node.delivered()
