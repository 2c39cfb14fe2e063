"""Changes to rospy: its connections, which use `Inlet` and `Outbox`, and repairs.

rospy finds the other end of a topic and negotiates with it; everything else is done here. Each repair says what goes
wrong without it.
"""

import asyncio
import logging
import sys
import threading
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import rosgraph.xmlrpc  # type: ignore[import-not-found]
import rospy.impl.masterslave  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]
import rospy.impl.tcpros_pubsub  # type: ignore[import-not-found]
import rospy.topics  # type: ignore[import-not-found]
from genpy import DeserializationError  # type: ignore[import-not-found]
from rospy.exceptions import TransportTerminated  # type: ignore[import-not-found]
from rospy.impl.paramserver import get_param_server_cache  # type: ignore[import-not-found]
from rospy.impl.tcpros_base import TCPROSTransport  # type: ignore[import-not-found]

from jacaros.robots.ros.drivers.ros1.streams import Inlet, Outbox
from jacaros.robots.ros.handoff import post

TakeMessages = Callable[[list[Any], "dict[str, str]"], None]
"""Takes messages that arrived together, on the loop, and the header of their publisher."""


class MessageHandlers(dict[str, TakeMessages]):
    """The handlers of topics, called on the loop of the node.

    Attributes:
        loop: loop of the node.
        log: called with one line about an unreadable message.
    """

    loop: asyncio.AbstractEventLoop

    def __init__(self, log: Callable[[str], None]) -> None:
        super().__init__()
        self.log = log


class InletTransport(TCPROSTransport):  # type: ignore[misc]
    """Replaces rospy's connection; connections to publishers of handled topics are read on the loop.

    Other topics, such as those that rospy itself subscribes to, are read by rospy.
    """

    handlers: MessageHandlers
    _over: threading.Event | None = None

    def receive_once(self) -> Any:
        """Let the loop read until the connection ends; runs on rospy's thread of this connection."""
        connection = self.socket
        subscriber = registration.get_topic_manager().get_subscriber_impl(self.name)
        handler = self.handlers.get(self.name)  # the loop may remove it at any moment
        if handler is None or connection is None or subscriber is None or self.read_buff.tell():
            return super().receive_once()
        loop, over = self.handlers.loop, threading.Event()
        self._over = over
        take = partial(self._take, subscriber, handler)
        with suppress(OSError):  # just closed
            # A duplicate of the socket: rospy closes its own in any thread, and the number may then be reused.
            inlet = Inlet(loop, connection.dup(), take, over.set)
            if not self.done and post(loop, inlet.open):
                over.wait()
            if not post(loop, inlet.close):
                inlet.close()
        raise TransportTerminated(f"the connection to {self.endpoint_id} has ended")

    def _take(self, subscriber: Any, take: TakeMessages, messages: list[bytes], size: int) -> None:
        self.stat_bytes += size
        self.stat_num_msg += len(messages)
        if self.done or not (read := self._deserialized(subscriber, messages)):
            return
        alone = len(subscriber.callbacks) == 1 and subscriber.statistics_logger is None
        if alone and self.handlers.get(self.name) == take:
            take(read, self.header)
        else:  # another subscriber in this process uses rospy, or ours has just been removed
            subscriber.receive_callback(read, self)

    def _deserialized(self, subscriber: Any, messages: list[bytes]) -> list[Any]:
        read = []
        for data in messages:
            try:
                message = subscriber.data_class().deserialize(data)
            except DeserializationError as problem:
                self.handlers.log(
                    f"topic {self.name}: a message of {self.endpoint_id} cannot be read: {problem}"
                )
                continue
            message._connection_header = self.header
            read.append(message)
        return read

    def close(self) -> None:
        """Close the connection; callable in any thread."""
        super().close()
        if self._over is not None:
            self._over.set()


class OutboxConnection:
    """Replaces rospy's ``QueuedConnection``: a connection to a subscriber, and the messages that wait to be sent.

    Args:
        connection: rospy's connection.
        size: see `Outbox`.
    """

    def __init__(self, connection: Any, size: int) -> None:
        self._connection = connection
        self._outbox = Outbox(connection.socket.dup(), size)
        connection.set_cleanup_callback(lambda _: self._outbox.close())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._connection, name)

    @property
    def busy(self) -> bool:
        """Whether data remains to be sent."""
        return self._outbox.busy

    @property
    def stat_bytes(self) -> int:
        """Number of bytes sent, for rospy's statistics."""
        return self._outbox.sent_bytes

    @property
    def stat_num_msg(self) -> int:
        """Number of messages sent."""
        return self._outbox.sent_messages

    def write_data(self, data: bytes) -> bool:
        """Send *data*. Raises ``TransportTerminated`` if the subscriber has gone."""
        try:
            self._outbox.send(data)
        except OSError as problem:
            raise TransportTerminated(str(problem)) from None
        return True


class EndingServer(rosgraph.xmlrpc.ThreadingXMLRPCServer):  # type: ignore[misc]
    """The server of a node's XML-RPC interface, whose thread ends when it is closed.

    rospy's own server keeps polling its closed socket forever, at full speed.
    """

    def server_close(self) -> Any:
        """Close the socket and let the serving thread end, without waiting: it may be this very thread."""
        super().server_close()
        threading.Thread(target=self.shutdown, name="XML-RPC server ends", daemon=True).start()


def mend_rospy(handlers: MessageHandlers, parameter_changed: Callable[[str, Any], object]) -> None:
    """Make rospy use these connections, and repair it; before ``init_node``.

    Args:
        handlers: the handlers of topics.
        parameter_changed: called, on a thread of rospy's, with changed parameters that the master reports.
    """

    # rospy stores such changes in a cache without callbacks, and ignores parameters that are not in it.
    def parameter_update(_: Any, caller: str, name: str, value: Any) -> tuple[int, str, int]:
        with suppress(KeyError):
            get_param_server_cache().update(name, value)
        parameter_changed(name, value)
        return 1, "", 0

    InletTransport.handlers = handlers
    rospy.impl.tcpros_pubsub.TCPROSTransport = InletTransport
    rospy.topics.QueuedConnection = OutboxConnection
    rospy.impl.masterslave.ROSHandler.paramUpdate = parameter_update
    rosgraph.xmlrpc.ThreadingXMLRPCServer = EndingServer
    # A deprecation of Python 3.10: with warnings as errors rospy's subscribers would receive nothing.
    warnings.filterwarnings("ignore", "notifyAll", DeprecationWarning)
    # Standard output belongs to the agents.
    for module in (rospy.impl.masterslave, registration, rosgraph.xmlrpc):
        module.print = partial(print, file=sys.stderr)  # pyright: ignore[reportAttributeAccessIssue]


def log_to_standard_error() -> None:
    """Redirect rospy's log to standard error, too. After ``init_node``, which sets up the log."""
    for handler in logging.getLogger("rosout").handlers:
        if hasattr(handler, "_stdout"):
            handler._stdout = sys.stderr  # pyright: ignore[reportAttributeAccessIssue]
