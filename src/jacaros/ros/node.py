"""The common part of all backends: names, messages, log, connection, exit hooks, transforms."""

import asyncio
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, NoReturn, TypeVar
from weakref import WeakKeyDictionary

from jacaros.ros.action import ActionPolicy, ActionServer, Execute
from jacaros.ros.action_client import ActionClient, LeavingGoals, OrphanPolicy, Orphans
from jacaros.ros.backend import (
    DEADLINES,
    DEFAULT_POLICY,
    Client,
    Closable,
    Handler,
    Publisher,
    Sample,
    Service,
    Subscription,
    TopicEvent,
)
from jacaros.ros.errors import CapabilityMissing, RosError
from jacaros.ros.fields import FieldType
from jacaros.ros.graph import GraphContents
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.message import MessageFactory, Schema
from jacaros.ros.names import NodeNames, action_type, message_type, service_type
from jacaros.ros.parameter import GivenParameters, Parameters, ParameterValue
from jacaros.ros.protocols.transform import Transform
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.rosout import RosoutWriter
from jacaros.ros.tf import TransformBroadcaster, TransformListener
from jacaros.ros.waiting import Waiting
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import Tracer


def to_stderr(text: str) -> None:
    """Write a line to standard error, the default log."""
    print(f"[ros] {text}", file=sys.stderr)


@dataclass(frozen=True)
class NodeSettings:
    """The arguments of `jacaros.ros.open.open_backend`.

    Attributes:
        clock: the run's clock.
        node_name: plain name of the node.
        namespace: prefix of relative names.
        remap: replacements of names.
        log: called with one line about the connection: waiting, missing, found, lost.
        interface_paths: folders with further definitions (``memory`` and, for services, ``ros1``).
        parameters: values of parameters of our node from outside, in place of declared defaults.
        orphans: what to do with action goals that an earlier run of the node left.
    """

    clock: Clock
    node_name: str
    namespace: str = ""
    remap: Mapping[str, str] = field(default_factory=dict)
    log: Callable[[str], None] = to_stderr
    interface_paths: Sequence[Path] = ()
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    orphans: OrphanPolicy = "keep"


M = TypeVar("M", bound=Closable)


@dataclass(frozen=True, slots=True)
class Wanted:
    """The arguments of a subscription.

    Attributes:
        topic: absolute name.
        type_name: message type in full form.
        callback: called with each message, on the loop.
        qos: requested quality of service.
        on_event: called with problems, on the loop; without it they are logged.
    """

    topic: str
    type_name: str
    callback: Callable[[Sample], None]
    qos: QoS = DEFAULT_QOS
    on_event: Callable[[TopicEvent], None] | None = None


@dataclass(frozen=True)
class Parts:
    """The classes of a driver; each is called with the node, an absolute name and a type in full form.

    Attributes:
        publisher: also with the quality of service.
        subscription: with `Wanted` in place of name and type.
        service: also with the handler.
        client: of a service.
        action_client: with no further argument.
        action_server: also with the code of goals, and the policy for several.
    """

    publisher: Callable[..., Publisher]
    subscription: Callable[..., Subscription]
    service: Callable[..., Service] | None = None
    client: Callable[..., Client] | None = None
    action_client: Callable[..., ActionClient] | None = None
    action_server: Callable[..., ActionServer] | None = None


class Node:
    """A backend without its driver, which defines how to start and to close, and provides the parts.

    Args:
        settings: names, clock and log.
        schema: the library's family of message classes.
        lifetime: how it joins and leaves.

    Attributes:
        members: the node's entities in the graph, in the order of creation.
        actions: its action clients and servers, which send messages when they are closed.
    """

    name = "none"
    ros_version = 2
    capabilities: frozenset[str] = frozenset()
    parts: ClassVar[Parts]

    def __init__(self, settings: NodeSettings, schema: Schema, lifetime: Lifetime) -> None:
        self.clock = settings.clock
        self.log = settings.log
        self.names = NodeNames(settings.node_name, settings.namespace, settings.remap)
        self.factory = MessageFactory(schema)
        self.lifetime = lifetime
        self.connected = False
        self.delivered: Callable[[], None] = lambda: None
        """Called on the loop when a message from outside has been delivered."""
        self.tracer: Tracer | None = None
        self.orphans = Orphans(self.names.full_name, settings.orphans, settings.log)
        self.leaving_goals: LeavingGoals = {}
        """Goals of all action clients that are being cancelled."""
        self.given_parameters = GivenParameters(settings.parameters)
        self.members: dict[Closable, None] = {}
        self.actions: WeakKeyDictionary[ActionClient | ActionServer, None] = WeakKeyDictionary()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._first_look: asyncio.Future[None] | None = None
        self._waiting: Waiting | None = None
        self._on_connection: list[Callable[[bool], None]] = []
        self._transforms = TransformBroadcaster(self)
        self._frames = TransformListener(self, self.log)
        self._rosout = RosoutWriter(self)

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self.names.full_name

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The loop on which the node was started. Raises `RosError` before."""
        if self._loop is None:
            raise RosError(
                f"the {self.name} backend of {self.node_name} is not started: await backend.start() first"
            )
        return self._loop

    async def start(self) -> None:
        """Join the graph."""
        raise NotImplementedError

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        raise NotImplementedError

    def add_interfaces(self, folder: Path) -> None:
        """Search *folder* for type definitions, too; see `jacaros.ros.backend.Backend`."""
        self.factory.schema.look_in(folder)

    def on_connection(self, callback: Callable[[bool], None]) -> None:
        """Call *callback* on the loop whenever `connected` changes."""
        self._on_connection.append(callback)

    def set_connected(self, connected: bool) -> None:
        """Note that the graph was found or lost, and inform the callbacks; on the loop."""
        self.lifetime.connected(connected)
        if connected != self.connected:
            self.connected = connected
            for callback in list(self._on_connection):
                callback(connected)

    def join(self) -> asyncio.Future[None]:
        """Store the running loop. Return a future that is done when the graph was found, or is known to be missing."""
        self._loop = asyncio.get_running_loop()
        self._first_look = self._loop.create_future()
        self.lifetime.join()
        return self._first_look

    def found(self) -> None:
        """Note, on the loop, that the graph was found."""
        if self._waiting is not None:
            self._waiting.__exit__(None, None, None)
            self._waiting = None
        self.set_connected(True)
        self.looked()

    def missing(self, what: str, help: str) -> None:
        """Note, on the loop, that the graph is missing or lost, and awaited.

        Args:
            what: its name for the log.
            help: what the user can do about it.
        """
        if self._waiting is None and not self.lifetime.leaving:
            self._waiting = Waiting(self.clock, self.log, what, help).__enter__()
        self.set_connected(False)
        self.looked()

    def looked(self) -> None:
        """Let `join` stop waiting."""
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def left(self) -> None:
        """Note, on the loop, that the node has left, and stop waiting."""
        if self._waiting is not None:
            self._waiting.__exit__(RosError, None, None)
            self._waiting = None
        self.set_connected(False)

    def keep(self, member: M) -> M:
        """Close *member* with the node, which must be started. Raises `RosError` otherwise."""
        assert self.loop is not None
        self.members[member] = None
        return member

    def forget(self, member: Closable) -> None:
        """Deregister an entity that has left."""
        self.members.pop(member, None)

    def receivers(self, topic: str) -> int:
        """Return the number of subscriptions of this node that receive the messages of a topic (absolute name)."""
        return sum(getattr(member, "received_topic", None) == topic for member in self.members)

    async def other_publishers(self, topic: str) -> list[str]:
        """Return the other nodes that publish a topic; also one of our own name, if it has more than we opened."""
        nodes = Counter(await self._publishers(topic))
        nodes[self.node_name] -= sum(getattr(member, "sent_topic", None) == topic for member in self.members)
        return sorted(node or "an unknown node" for node, number in nodes.items() if number > 0)

    async def _publishers(self, topic: str) -> list[str]:
        """Return the node of each publisher of a topic, as the graph reports them."""
        info = (await self.contents()).topics.get(topic)
        return [] if info is None else [each.node for each in info.publishers]

    def close_actions(self) -> None:
        """Close the clients and servers of actions, which inform their peers."""
        for action in list(self.actions):
            action.close()

    def close_members(self) -> None:
        """Close the node's entities in the graph."""
        for member in list(self.members):
            with suppress(Exception):  # a failure of one must not keep the others open
                member.close()
        self.members.clear()

    def after_delivery(self, callback: Callable[[], None]) -> None:
        """Call *callback* after messages of other processes have been delivered."""
        self.delivered = callback

    def resolve(self, name: str) -> str:
        """Return the absolute, remapped form of a name."""
        return self.names.resolve(name)

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a message type."""
        return self.factory.fields(message_type(type_name))

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message."""
        return self.factory.make(message_type(type_name), fields)

    def tf_broadcast(self, transform: Any, static: bool = False) -> None:
        """Publish a transform."""
        self._transforms.send(transform, static)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher."""
        self._check_deadline(qos)
        return self.keep(self.parts.publisher(self, self.resolve(topic), message_type(type_name), qos))

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Subscription:
        """Call *callback* with every message."""
        self._check_deadline(qos)
        full_type = message_type(type_name)
        self.factory.fields(full_type)
        name = self.resolve(topic)
        return self.keep(self.parts.subscription(self, Wanted(name, full_type, callback, qos, on_event)))

    def service(self, name: str, type_name: str, handler: Handler) -> Service:
        """Offer a service."""
        make = self.parts.service or self._unable("services")
        return self.keep(make(self, self.resolve(name), service_type(type_name), handler))

    def client(self, name: str, type_name: str) -> Client:
        """Make a client of a service."""
        make = self.parts.client or self._unable("services")
        return self.keep(make(self, self.resolve(name), service_type(type_name)))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Make a client of an action."""
        make = self.parts.action_client or self._unable("action clients")
        made = make(self, self.resolve(name), action_type(type_name))
        self.actions[made] = None
        return made

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer an action."""
        make = self.parts.action_server or self._unable("action servers")
        made = make(self, self.resolve(name), action_type(type_name), execute, policy)
        self.actions[made] = None
        return made

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Call *hook* when the process ends or the backend is closed."""
        return self.lifetime.add(hook)

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log."""
        self._rosout.write(level, text)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        self._unable("looking at the graph")

    def parameters(self, node: str | None = None) -> Parameters:
        """Return the parameters of our own node, or of another."""
        self._unable("parameters")

    def tf_listen(self) -> None:
        """Subscribe to transforms."""
        self._frames.listen()

    def tf_lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Look up a transform."""
        return self._frames.lookup(target, source, stamp)

    async def tf_wait(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> Transform:
        """Look up a transform as soon as it is possible."""
        return await self._frames.wait(target, source, stamp, timeout)

    def _check_deadline(self, qos: QoS) -> None:
        """Reject a deadline if the backend does not support them."""
        if qos.deadline is not None and DEADLINES not in self.capabilities:
            raise CapabilityMissing(
                f"the {self.name} backend does not support deadlines (a deadline of {qos.deadline:g} s was requested); "
                "leave it out, or use --ros ros2 or --ros memory"
            )

    def _unable(self, what: str) -> NoReturn:
        raise CapabilityMissing(f"{what}: the {self.name} backend cannot do this")
