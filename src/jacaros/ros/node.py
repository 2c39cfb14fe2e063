"""What all backends have in common: names, messages, reports, connection, exit hooks, transforms."""

import asyncio
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, NoReturn, Protocol, TypeVar
from weakref import WeakKeyDictionary

from jacaros.clock import Clock
from jacaros.ros.action import ActionClient, ActionPolicy, ActionServer, Execute
from jacaros.ros.backend import (
    DEADLINES,
    DEFAULT_POLICY,
    Client,
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
from jacaros.ros.orphans import OrphanPolicy, Orphans
from jacaros.ros.parameter import GivenParameters, Parameters, ParameterValue
from jacaros.ros.pending_goal import LeavingGoals
from jacaros.ros.protocols.transform import Transform
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.rosout import RosoutWriter
from jacaros.ros.tf import TransformBroadcaster, TransformListener
from jacaros.ros.waiting import Waiting
from jacaros.trace import Tracer


def to_stderr(text: str) -> None:
    """Write a report as one line to standard error: where reports go by default."""
    print(f"[ros] {text}", file=sys.stderr)


@dataclass(frozen=True)
class NodeSettings:
    """What `jacaros.ros.open.open_backend` was given.

    Attributes:
        clock: the run's clock.
        node_name: plain name of the node.
        namespace: put before relative names.
        remap: names to use in place of others.
        log: takes one line about the connection: waiting, missing, found, lost.
        interface_paths: folders with further definitions (``memory`` and, for services, ``ros1``).
        parameters: values of parameters of our node from outside; they take the place of declared defaults.
        orphans: what becomes of action goals that an earlier run of the node left behind.
    """

    clock: Clock
    node_name: str
    namespace: str = ""
    remap: Mapping[str, str] = field(default_factory=dict)
    log: Callable[[str], None] = to_stderr
    interface_paths: Sequence[Path] = ()
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    orphans: OrphanPolicy = "keep"


class Member(Protocol):
    """What a node has in its graph."""

    def close(self) -> None:
        """Leave the graph, and be forgotten by the node."""


M = TypeVar("M", bound=Member)


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is wanted of a topic.

    Attributes:
        topic: absolute name.
        type_name: message type in full form.
        callback: takes each message, on the loop.
        qos: what is asked of publishers.
        on_event: takes news of trouble, on the loop; without it they are logged.
    """

    topic: str
    type_name: str
    callback: Callable[[Sample], None]
    qos: QoS = DEFAULT_QOS
    on_event: Callable[[TopicEvent], None] | None = None


@dataclass(frozen=True)
class Parts:
    """What a driver makes for its node; each is called with the node, an absolute name and a type in full form.

    Attributes:
        publisher: with the quality of service too.
        subscription: with `Wanted` in place of name and type.
        service: with the handler.
        client: of a service.
        action_client: with no more.
        action_server: with the code to carry goals out, and the policy for several.
    """

    publisher: Callable[..., Publisher]
    subscription: Callable[..., Subscription]
    service: Callable[..., Service] | None = None
    client: Callable[..., Client] | None = None
    action_client: Callable[..., ActionClient] | None = None
    action_server: Callable[..., ActionServer] | None = None


class Node:
    """A backend but for its driver, which says how to start and to close, and gives the parts.

    Args:
        settings: names, clock and reports.
        schema: the library's family of message classes.
        lifetime: how it joins and leaves.

    Attributes:
        members: what the node has in the graph, in its order.
        actions: its action clients and servers, which have something to tell when they are closed.
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
        """Called on the loop when a message that came from outside has been delivered."""
        self.tracer: Tracer | None = None
        self.orphans = Orphans(self.names.full_name, settings.orphans, settings.log)
        self.leaving_goals: LeavingGoals = {}
        """Goals of all action clients that were asked to be cancelled and have not ended."""
        self.given_parameters = GivenParameters(settings.parameters)
        self.members: dict[Member, None] = {}
        self.actions: WeakKeyDictionary[ActionClient | ActionServer, None] = WeakKeyDictionary()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._first_look: asyncio.Future[None] | None = None
        self._waiting: Waiting | None = None
        self._on_connection: list[Callable[[bool], None]] = []
        self._transforms = TransformBroadcaster(self)
        self._frames = TransformListener(self)
        self._rosout = RosoutWriter(self)

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self.names.full_name

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The loop on which the node was started; raises `RosError` before."""
        if self._loop is None:
            raise RosError(
                f"the {self.name} backend of {self.node_name} is not started: await backend.start() first"
            )
        return self._loop

    def add_interfaces(self, folder: Path) -> None:
        """Look for definitions of types in *folder* too; see `jacaros.ros.backend.Backend`."""
        self.factory.schema.look_in(folder)

    def on_connection(self, callback: Callable[[bool], None]) -> None:
        """Have *callback* called on the loop whenever `connected` changes."""
        self._on_connection.append(callback)

    def set_connected(self, connected: bool) -> None:
        """Note that the graph was found or lost and tell everybody; on the loop."""
        self.lifetime.connected(connected)
        if connected != self.connected:
            self.connected = connected
            for callback in list(self._on_connection):
                callback(connected)

    def join(self) -> asyncio.Future[None]:
        """Note the running loop; gives what is done as soon as the graph was found, or found to be missing."""
        self._loop = asyncio.get_running_loop()
        self._first_look = self._loop.create_future()
        self.lifetime.join()
        return self._first_look

    def found(self) -> None:
        """Note, on the loop, that the graph is there."""
        if self._waiting is not None:
            self._waiting.__exit__(None, None, None)
            self._waiting = None
        self.set_connected(True)
        self.looked()

    def missing(self, what: str, help: str) -> None:
        """Note, on the loop, that the graph is not there, or there no more, and is awaited.

        Args:
            what: what people call it.
            help: what a person can do about it.
        """
        if self._waiting is None and not self.lifetime.leaving:
            self._waiting = Waiting(self.clock, self.log, what, help).__enter__()
        self.set_connected(False)
        self.looked()

    def looked(self) -> None:
        """Let `join` wait no longer."""
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def left(self) -> None:
        """Note, on the loop, that the node has left: nothing is awaited any more."""
        if self._waiting is not None:
            self._waiting.__exit__(RosError, None, None)
            self._waiting = None
        self.set_connected(False)

    def keep(self, member: M) -> M:
        """Close *member* with the node, which has been started; raises `RosError` otherwise."""
        assert self.loop is not None
        self.members[member] = None
        return member

    def forget(self, member: Member) -> None:
        """Note that a member has left."""
        self.members.pop(member, None)

    def receivers(self, topic: str) -> int:
        """Return how many subscriptions of this node receive the messages of a topic, given by its absolute name."""
        return sum(getattr(member, "received_topic", None) == topic for member in self.members)

    def close_actions(self) -> None:
        """Tell servers and clients of actions that we go."""
        for action in list(self.actions):
            action.close()

    def close_members(self) -> None:
        """Close what the node has in the graph."""
        for member in list(self.members):
            with suppress(Exception):  # whatever is wrong with one, the others are to be closed
                member.close()
        self.members.clear()

    def after_delivery(self, callback: Callable[[], None]) -> None:
        """Have *callback* called after messages of other processes have been delivered."""
        self.delivered = callback

    def resolve(self, name: str) -> str:
        """Give the absolute, remapped form of a name."""
        return self.names.resolve(name)

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a message type."""
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
        """Have *callback* called for every message."""
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
        """Have *hook* called when the process stops or the backend is closed."""
        return self.lifetime.add(hook)

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log."""
        self._rosout.write(level, text)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        self._unable("looking at the graph")

    def parameters(self, node: str | None = None) -> Parameters:
        """Give the parameters of our own node, or of another."""
        self._unable("parameters")

    def tf_listen(self) -> None:
        """Begin to listen to transforms."""
        self._frames.listen()

    def tf_lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Look up a transform."""
        return self._frames.lookup(target, source, stamp)

    async def tf_wait(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> Transform:
        """Look up a transform as soon as that is possible."""
        return await self._frames.wait(target, source, stamp, timeout)

    def _check_deadline(self, qos: QoS) -> None:
        """Refuse a deadline that nobody would watch."""
        if qos.deadline is not None and DEADLINES not in self.capabilities:
            raise CapabilityMissing(
                f"a deadline of {qos.deadline:g} s: the {self.name} backend cannot watch deadlines (--ros ros2 and --ros "
                "memory can); leave it out"
            )

    def _unable(self, what: str) -> NoReturn:
        raise CapabilityMissing(f"{what}: the {self.name} backend cannot do this")
