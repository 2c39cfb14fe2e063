"""The node at the broker: joining, being known to the others, losing the broker and finding it again, leaving."""

import asyncio
import json
import os
import time
import uuid
from collections.abc import Callable
from typing import Any

import aiomqtt

from jacaros.robots.ros.backend import Backend, Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.errors import ServiceUnavailable
from jacaros.robots.ros.handoff import in_thread, post
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.node import Capability, NodeSettings, Parts
from jacaros.robots.ros.typestore import DefinitionSchema
from mqtt_driver.topics import MqttMultiplexer, MqttPublisher, MqttSubscription, parts_of

NODES = "jacaros/nodes"
"""Below it each node keeps what it has in the graph; its last will takes that away when it dies."""
RETRY = 0.5
"""Seconds between two attempts to reach the broker."""
SENDING = 0.5
"""Seconds that closing waits for the messages published last to leave."""


class MqttBackend(Backend):
    """A node in a graph that consists of a broker's clients.

    Args:
        settings: names, clock and reports.
        broker: ``HOST:PORT``; ``MQTT_BROKER`` without it, and else port 1883 of this machine.
    """

    name = "mqtt"
    capabilities = frozenset({Capability.TOPICS, Capability.TRANSFORMS, Capability.DISCOVERY})
    parts = Parts(publisher=MqttPublisher, subscription=MqttSubscription)

    def __init__(self, settings: NodeSettings, broker: str | None = None) -> None:
        super().__init__(
            settings,
            DefinitionSchema(settings.interface_paths),
            Lifetime(settings.log, self._send_rest, threaded=True),
        )
        self.broker = broker or os.environ.get("MQTT_BROKER") or "127.0.0.1:1883"
        self.multiplexers: dict[str, MqttMultiplexer] = {}
        self.others: dict[str, dict[str, Any]] = {}
        """What the nodes of the graph have, our own among them, by the number of the node."""
        self.number = uuid.uuid4().hex
        self._client: aiomqtt.Client | None = None
        self._task: asyncio.Task[None] | None = None
        self._unsent: set[object] = set()
        """Something for each piece of work that is not done yet."""
        self._tasks: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Join the graph, or say that the broker is awaited and go on trying in the background."""
        looked = self.join()
        self._task = self.loop.create_task(self._live())
        await looked

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        await self.lifetime.leave()
        self.close_members()
        self.do(lambda client: client.publish(f"{NODES}/{self.number}", b"", qos=1, retain=True))
        await in_thread(self.loop, self._send_rest, "closing")
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        self.left()

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        if not self.connected:
            raise ServiceUnavailable(f"there is no MQTT broker at {self.broker}")
        names = {topic for node in self.others.values() for ends in ("out", "in") for topic in node[ends]}
        return GraphContents(
            {name: TopicInfo(name, *self._ends(name)) for name in sorted(names)},
            nodes=tuple(sorted(node["name"] for node in self.others.values())),
        )

    def types_at(self, topic: str, ends: str) -> list[str]:
        """The types that the nodes have at a topic: ``out`` of those that publish, ``in`` of those that subscribe."""
        return [node[ends][topic] for node in self.others.values() if topic in node[ends]]

    def do(self, work: Callable[[aiomqtt.Client], Any]) -> None:
        """Have the client do something, in the order of the calls; from any thread.  Without a broker nothing is done."""
        token = object()
        self._unsent.add(token)
        post(self.loop, self._do, work, token)

    def announce(self) -> None:
        """Tell the others what we have in the graph."""
        ends = {
            "name": self.node_name,
            "out": {each.topic: each.type_name for each in self.members if isinstance(each, MqttPublisher)},
            "in": {multiplexer.topic: multiplexer.type_name for multiplexer in self.multiplexers.values()},
        }
        document = json.dumps(ends)
        self.do(lambda client: client.publish(f"{NODES}/{self.number}", document, qos=1, retain=True))

    def _do(self, work: Callable[[aiomqtt.Client], Any], token: object) -> None:
        task = self.loop.create_task(self._try(work, token))
        self._tasks.add(task)  # asyncio itself holds tasks weakly
        task.add_done_callback(self._tasks.discard)

    async def _try(self, work: Callable[[aiomqtt.Client], Any], token: object) -> None:
        try:
            if self._client is not None:
                await work(self._client)
        except aiomqtt.MqttError as problem:
            self.log(f"the MQTT broker at {self.broker}: {problem}")
        finally:
            self._unsent.discard(token)

    async def _live(self) -> None:
        host, _, port = self.broker.rpartition(":")
        will = aiomqtt.Will(f"{NODES}/{self.number}", b"", qos=1, retain=True)
        while True:
            try:
                async with aiomqtt.Client(host, int(port), will=will, keepalive=5) as client:
                    await self._serve(client)
            except aiomqtt.MqttError:
                self.others.clear()
                help = "Start it with `mosquitto -p 1883`, or set MQTT_BROKER to where it runs."
                self.missing(f"MQTT broker at {self.broker}", help)
            finally:
                self._client = None
            await asyncio.sleep(RETRY)

    async def _serve(self, client: aiomqtt.Client) -> None:
        self._client = client
        await client.subscribe(f"{NODES}/+", qos=1)
        for member in (*self.multiplexers.values(), *self.members):
            if isinstance(member, MqttMultiplexer | MqttPublisher):
                member.join()
        self.announce()
        self.found()
        async for message in client.messages:
            self._received(str(message.topic), bytes(message.payload), message.retain)

    def _received(self, place: str, payload: bytes, kept: bool) -> None:
        if place.startswith(NODES):
            self._note_node(place.removeprefix(f"{NODES}/"), payload)
            return
        publisher, kind, topic = parts_of(place)
        multiplexer = self.multiplexers.get(topic)
        if multiplexer is not None and kind == multiplexer.type_name:
            multiplexer.received(publisher, payload, kept)

    def _note_node(self, number: str, payload: bytes) -> None:
        self.others.pop(number, None)
        if payload:
            self.others[number] = json.loads(payload)
        for multiplexer in self.multiplexers.values():
            for other in self.types_at(multiplexer.topic, "out"):
                multiplexer.see_type(other)

    def _ends(self, topic: str) -> tuple[tuple[str, ...], tuple[Endpoint, ...], tuple[Endpoint, ...]]:
        there = self.others.values()
        types = sorted({*self.types_at(topic, "out"), *self.types_at(topic, "in")})
        sources = tuple(Endpoint(node["name"]) for node in there if topic in node["out"])
        return tuple(types), sources, tuple(Endpoint(node["name"]) for node in there if topic in node["in"])

    def _send_rest(self) -> None:
        """Wait, in a thread, until the last messages have left."""
        deadline = time.monotonic() + SENDING
        while self._unsent and time.monotonic() < deadline:
            time.sleep(0.005)
