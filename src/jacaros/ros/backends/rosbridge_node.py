"""What the parts of the rosbridge backend see of it: the connection, the graph's notation, and each other."""

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from jacaros.clock import Clock
from jacaros.ros.backend import Sample
from jacaros.ros.backends.rosbridge_messages import Translator
from jacaros.ros.backends.rosbridge_requests import Requests, Sight
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.message import MessageFactory
from jacaros.ros.orphans import Orphans
from jacaros.ros.pending_goal import LeavingGoals


class Member(Protocol):
    """A publisher, subscription, service, client or action of ours.

    It may also have ``join``, called when a server is there that does not know us yet, and ``lost``, called when the
    connection is gone.
    """

    def close(self) -> None:
        """Give it up."""


class Sink(Protocol):
    """A subscription of ours."""

    def put(self, values: Any) -> None:
        """Take a message, not decoded yet."""

    @property
    def depth(self) -> int:
        """Messages kept while the loop is behind."""

    @property
    def latched(self) -> bool:
        """The last message is wanted too."""

    def trouble(self, text: str) -> None:
        """Tell that the server does not send what is wanted."""


class Feed(Protocol):
    """The one subscription of a topic at the server."""

    @property
    def topic(self) -> str:
        """Absolute name."""

    @property
    def publishers(self) -> Sight[int]:
        """How many nodes publish."""

    def add(self, sink: Sink) -> None:
        """Serve *sink* too."""

    def remove(self, sink: Sink) -> bool:
        """Serve *sink* no more; True when it was the last."""


class Admitting(Protocol):
    """Looks whether the server took what it was asked for."""

    def expect(self, asked: Any) -> None:
        """*asked* was asked for just now."""

    def forget(self, asked: Any) -> None:
        """Nobody wants it any more."""


class Membership(Protocol):
    """All that the node has at the server."""

    @property
    def admission(self) -> Admitting:
        """Looks whether the server took what it was asked for."""

    def number(self, operation: str, name: str) -> str:
        """An id for an operation; the server names it when it has something to say about it."""

    def add(self, member: Member) -> None:
        """Keep *member* until it is closed."""

    def drop(self, member: Member) -> None:
        """Forget a member that was closed."""

    def feed(self, topic: str, written_type: Callable[[], str], packed: Callable[[], bool]) -> Feed:
        """The one subscription of *topic* at the server, made at its first use."""

    def drop_feed(self, feed: Any) -> None:
        """Leave a topic: nobody here listens to it any more."""


class BridgeNode(Protocol):
    """The backend, for its parts."""

    clock: Clock
    log: Callable[[str], None]
    factory: MessageFactory
    lifetime: Lifetime
    connected: bool
    attached: bool
    packs: bool
    requests: Requests
    translator: Translator
    goals: dict[str, Any]
    leaving_goals: LeavingGoals
    orphans: Orphans
    delivered: Callable[[], None]

    @property
    def members(self) -> Membership:
        """All that we have at the server."""

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The loop of the agents."""

    @property
    def node_name(self) -> str:
        """Our absolute name, which the graph does not know."""

    @property
    def ros_version(self) -> int:
        """Of the robot."""

    def send(self, operation: dict[str, Any], droppable: bool = False) -> bool:
        """Send an operation to the server that knows us, from any thread; False when it is lost."""

    def sample(self, message: Any, topic: str) -> Sample:
        """Wrap a message that has just reached the loop."""

    def written_type(self, type_name: str) -> str:
        """A type in full form as the server writes it."""

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops."""

    def require_connection(self, service: str) -> None:
        """Raise `ServiceUnavailable` while there is no server."""

    def note_loss(self, topic: str) -> None:
        """Say that messages are lost, once a topic and an interruption; from any thread."""

    async def rosapi(self, service: str, arguments: dict[str, Any], timeout: float | None = None) -> Any:
        """Call a service of rosapi and give the fields of its response."""
