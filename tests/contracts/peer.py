"""A node that does what a test tells it: inside the test's process, or as a program of its own.

    python peer.py KIND NODE_NAME [NAMESPACE]

As a program it reads commands as JSON lines from standard input and answers each with a line ``@{…}`` on
standard output; anything else on standard output breaks the contract of `jacaros run` and fails the test.
"""

import asyncio
import inspect
import json
import os
import random
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any

from peer_actions import ActionCommands
from peer_agents import AgentCommands
from peer_graph import GraphCommands

from jacaros.robots.kit.connection import Matching
from jacaros.robots.ros.handoff import post
from jacaros.robots.ros.message import plain
from jacaros.robots.ros.node import Sample, TopicEvent
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.clock import Clock, WallClock, run
from jacaros.runtime.trace import Cause

ADD = "example_interfaces/srv/AddTwoInts"


class Causes:
    """Makes the causes of one node."""

    def link(self, kind: str, what: str, parent: Cause | None = None, about: object = None) -> Cause:
        return Cause(1, parent.id if parent is not None else 0, kind, what)

    def received_message(self, topic: str, message: Any) -> Cause:
        return Cause(1, 0, "sample", topic)

    def sent_message(self, topic: str, message: Any, parent: Cause | None) -> None:
        pass


class Peer(ActionCommands, AgentCommands, GraphCommands):
    """A node and what it has seen.  Every method without underscore is a command; all values are JSON."""

    def __init__(self, kind: str, clock: Clock, name: str, namespace: str = "", **options: Any) -> None:
        ActionCommands.__init__(self)
        AgentCommands.__init__(self)
        GraphCommands.__init__(self)
        self._clock = clock
        self._lines: list[str] = []
        self._backend = open_backend(kind, clock, name, namespace, log=self._log, **options)
        self._backend.tracer = Causes()
        self._connection: list[bool] = []
        self._backend.on_connection(self._connection.append)
        self._received: dict[str, list[Sample]] = defaultdict(list)
        self._events: dict[str, list[TopicEvent]] = defaultdict(list)
        self._threads: set[str] = set()
        self._publishers: dict[str, Any] = {}
        self._subscriptions: dict[str, Any] = {}
        self._services: dict[str, Any] = {}
        self._clients: dict[str, Any] = {}
        self._calls: dict[str, asyncio.Task[Any]] = {}
        self._numbered = 0
        self._running = 0
        self._most_running = 0

    def _log(self, text: str) -> None:
        self._lines.append(text)
        print(f"[peer] {text}", file=sys.stderr, flush=True)

    async def start(self) -> None:
        await self._backend.start()

    async def close(self) -> None:
        await self.end_agents()
        await self._backend.close()

    def debug(self) -> None:
        """Have asyncio refuse whatever touches the loop in another thread."""
        asyncio.get_running_loop().set_debug(True)

    def log(self) -> list[str]:
        return self._lines

    def processor_seconds(self) -> float:
        """What the process has cost so far."""
        return time.process_time()

    def connection(self) -> list[bool]:
        return self._connection

    def connected(self) -> bool:
        return self._backend.connected

    def capabilities(self) -> list[str]:
        return sorted(self._backend.capabilities)

    def node_name(self) -> str:
        return self._backend.node_name

    def resolve(self, name: str) -> str:
        return self._backend.resolve(name)

    def message(self, type_name: str, **fields: Any) -> Any:
        return plain(self._backend.message(type_name, **fields))

    def fields(self, type_name: str) -> dict[str, str]:
        return {name: str(kind) for name, kind in self._backend.fields(type_name).items()}

    def advertise(self, topic: str, type_name: str, **qos: Any) -> str:
        publisher = self._publishers[topic] = self._backend.publisher(topic, type_name, QoS(**qos))
        return publisher.topic

    def publish(self, topic: str, fields: dict[str, Any], times: int = 1) -> None:
        publisher = self._publishers[topic]
        for _ in range(times):
            publisher.publish(publisher.message(**fields))

    async def publish_first(self, topic: str, type_name: str, fields: dict[str, Any]) -> None:
        """Publish on a new publisher when operations of artifacts do."""
        publisher = self._publishers[topic] = self._backend.publisher(topic, type_name)
        for seconds in Matching(publisher, 60.0, lambda *_: None).pauses():
            await self._clock.sleep(seconds)
        publisher.publish(publisher.message(**fields))

    def publish_fields(self, topic: str, fields: dict[str, Any]) -> None:
        self._publishers[topic].publish(fields)

    def publish_counted(self, topic: str, count: int) -> None:
        publisher = self._publishers[topic]
        for number in range(count):
            publisher.publish(publisher.message(data=number))

    def publish_numbered(self, topic: str, count: int, period: float) -> None:
        """Publish odometry whose x is 1, 2, 3, ..., one in so many seconds; `numbered` tells how far it is."""
        publisher, began = self._publishers[topic], self._clock.now()
        self._numbered = 0

        def again() -> None:
            due = min(count, int((self._clock.now() - began) / period) + 1)
            while self._numbered < due:
                self._numbered += 1
                pose = {"pose": {"position": {"x": float(self._numbered)}, "orientation": {"w": 1.0}}}
                publisher.publish(publisher.message(pose=pose))
            if self._numbered < count:
                self._clock.call_later(period, again)

        again()

    def numbered(self) -> int:
        return self._numbered

    def publish_wrong_message(self, topic: str) -> None:
        self._publishers[topic].publish(self._backend.message("geometry_msgs/msg/Twist"))

    def subscription_count(self, topic: str) -> int:
        return self._publishers[topic].subscription_count

    def unadvertise(self, topic: str) -> None:
        self._publishers.pop(topic).close()

    def subscribe(
        self, topic: str, type_name: str, key: str | None = None, events: bool = False, **qos: Any
    ) -> str:
        """Receive messages; with *events* also trouble, which goes to the log otherwise."""
        seen = self._received[key or topic]

        def receive(sample: Sample) -> None:
            self._threads.add(threading.current_thread().name)
            seen.append(sample)

        on_event = self._events[key or topic].append if events else None
        subscription = self._backend.subscription(topic, type_name, receive, QoS(**qos), on_event)
        self._subscriptions[key or topic] = subscription
        return subscription.topic

    def relay(
        self, source: str, target: str, type_name: str, seconds: float, jitter: float = 0.0, seed: int = 0
    ) -> None:
        """Pass messages on, in their order, each after *seconds* and up to *jitter* more."""
        publisher = self._publishers[target] = self._backend.publisher(target, type_name)
        chance, due = random.Random(seed), 0.0

        def pass_on(sample: Sample) -> None:
            nonlocal due
            now = self._clock.elapsed
            due = max(now + seconds + chance.uniform(0.0, jitter), due + 1e-3)
            self._clock.call_later(due - now, lambda: publisher.publish(sample.message))

        self._subscriptions[source] = self._backend.subscription(source, type_name, pass_on, QoS())

    def events(self, topic: str) -> list[list[str]]:
        return [[str(event.trouble), event.text] for event in self._events[topic]]

    def publisher_count(self, topic: str) -> int:
        return self._subscriptions[topic].publisher_count

    def unsubscribe(self, topic: str) -> None:
        self._subscriptions.pop(topic).close()

    def received(self, topic: str) -> list[Any]:
        return [plain(sample.message) for sample in self._received[topic]]

    def samples(self, topic: str) -> list[Any]:
        now = self._clock.now()
        return [
            {
                "topic": s.topic,
                "stamp": s.stamp,
                "age": now - s.stamp,
                "cause": s.cause and [s.cause.kind, s.cause.what],
            }
            for s in self._received[topic]
        ]

    def callback_threads(self) -> list[str]:
        return sorted(self._threads)

    def serve(self, name: str, behaviour: str = "add", type_name: str = ADD) -> str:
        service = self._services[name] = self._backend.service(
            name, type_name, getattr(self, f"_{behaviour}")
        )
        return service.name

    def unserve(self, name: str) -> None:
        self._services.pop(name).close()

    def most_calls_at_once(self) -> int:
        return self._most_running

    def _add(self, request: Any) -> dict[str, int]:
        return {"sum": request.a + request.b}

    async def _add_together(self, request: Any) -> Any:
        """Answer none of the first five requests before all of them are there."""
        self._running += 1
        self._most_running = max(self._most_running, self._running)
        while self._most_running < 5:
            await self._clock.sleep(0.01)
        self._running -= 1
        return {"sum": request.a + request.b}

    def _fail(self, request: Any) -> None:
        raise ValueError("no sums today")

    def _answer_wrongly(self, request: Any) -> dict[str, Any]:
        return {"total": 1}

    async def _never(self, request: Any) -> None:
        self._running += 1
        self._most_running = max(self._most_running, self._running)
        await asyncio.get_running_loop().create_future()

    def _nothing(self, request: Any) -> None:
        return None

    async def call(
        self, name: str, fields: dict[str, Any], timeout: float | None = None, type_name: str = ADD
    ) -> Any:
        client = self._client(name, type_name)
        return plain(await client.call(fields, timeout=timeout))

    def begin_call(self, key: str, name: str, fields: dict[str, Any], timeout: float | None = None) -> None:
        self._calls[key] = asyncio.get_running_loop().create_task(self.call(name, fields, timeout))

    async def end_call(self, key: str) -> Any:
        return await self._calls.pop(key)

    def call_over(self, key: str) -> bool:
        return self._calls[key].done()

    async def give_up_call(self, key: str) -> bool:
        task = self._calls.pop(key)
        task.cancel()
        await asyncio.wait([task])
        return task.cancelled()

    def ready(self, name: str, type_name: str = ADD) -> bool:
        return self._client(name, type_name).ready

    def close_client(self, name: str) -> None:
        self._clients.pop(name).close()

    def _client(self, name: str, type_name: str) -> Any:
        if name not in self._clients:
            self._clients[name] = self._backend.client(name, type_name)
        return self._clients[name]

    def hook(self, topic: str, fields: dict[str, Any]) -> None:
        publisher = self._publishers[topic]
        message = publisher.message(**fields)
        self._backend.add_exit_hook(lambda: publisher.publish(message))

    def failing_hook(self) -> None:
        def fail() -> None:
            raise ValueError("this hook is broken")

        self._backend.add_exit_hook(fail)

    def keep_publishing(self, topic: str, fields: dict[str, Any], period: float = 0.01) -> None:
        """Publish from now to the end, as a motion does that has not noticed that the process stops."""
        publisher = self._publishers[topic]
        message = publisher.message(**fields)

        def again() -> None:
            publisher.publish(message)
            self._clock.call_later(period, again)

        again()

    def block_loop(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            pass

    def longest_pause(self) -> float:
        """Longest time in which the loop did not run, since `watch_loop`."""
        return self._longest_pause

    def watch_loop(self) -> None:
        self._longest_pause = 0.0
        last = time.monotonic()

        def tick() -> None:
            nonlocal last
            now = time.monotonic()
            self._longest_pause = max(self._longest_pause, now - last)
            last = now
            self._clock.call_later(0.005, tick)

        tick()


ENDINGS = ("return", "exception", "exit", "busy")


async def obey(peer: Peer, commands: "asyncio.Queue[dict[str, Any] | None]") -> None:
    """Execute commands until the input ends or one of them ends the process."""
    pending: set[asyncio.Task[None]] = set()
    while (command := await commands.get()) is not None:
        ending = command["do"]
        if ending in ENDINGS:
            reply({"id": command["id"], "result": None})
            end(ending)
            return
        task = asyncio.get_running_loop().create_task(answer(command, getattr(peer, command["do"])))
        pending.add(task)
        task.add_done_callback(pending.discard)


def end(how: str) -> None:
    """Stop the process in one of the ways in which programs stop."""
    if how == "exception":
        raise RuntimeError("the program has a fault")
    if how == "exit":
        sys.exit(7)
    while how == "busy":  # an endless computation: only a signal can end it
        pass


async def answer(command: dict[str, Any], work: Callable[..., Any]) -> None:
    """Do what one command says and answer."""
    try:
        result = work(*command["args"], **command["kwargs"])
        if inspect.isawaitable(result):
            result = await result
        reply({"id": command["id"], "result": result})
    except Exception as problem:
        error = {
            "error": type(problem).__name__,
            "text": str(problem),
            "reason": getattr(problem, "reason", None),
        }
        reply({"id": command["id"], **error})


def reply(answer: dict[str, Any]) -> None:
    """Answer a command."""
    print("@" + json.dumps(answer), flush=True)


def reading() -> "asyncio.Queue[dict[str, Any] | None]":
    """Return the commands from standard input; None is its end."""
    loop = asyncio.get_running_loop()
    commands: asyncio.Queue[dict[str, Any] | None] = asyncio.Queue()

    def read() -> None:
        for line in sys.stdin:
            post(loop, commands.put_nowait, json.loads(line))
        post(loop, commands.put_nowait, None)

    threading.Thread(target=read, daemon=True).start()
    return commands


async def main(kind: str, name: str, namespace: str = "") -> None:
    """Run a peer that is controlled through standard input."""
    peer = Peer(kind, WallClock(), name, namespace, **json.loads(os.environ.get("PEER_OPTIONS", "{}")))
    await obey(peer, reading())


if __name__ == "__main__":
    run(lambda: main(*sys.argv[1:]), WallClock())
