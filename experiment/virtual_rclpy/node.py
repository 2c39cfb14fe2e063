"""``rclpy.node``: nodes with publishers, subscriptions, clients of services, timers and parameters."""

import copy
from collections import deque
from collections.abc import Callable
from typing import Any

from jacaros.robots.ros.node import Publisher as GraphPublisher
from jacaros.runtime.clock import Timer as ClockTimer
from virtual_rclpy.client import Client
from virtual_rclpy.graph import VirtualGraph, current
from virtual_rclpy.messages import Interface
from virtual_rclpy.parameter import Parameter
from virtual_rclpy.qos import QoSProfile, qos_of


class Publisher:
    """Sends messages to a topic."""

    def __init__(self, publisher: GraphPublisher) -> None:
        self._publisher = publisher

    def publish(self, message: Any) -> None:
        """Send a copy: in a memory graph receivers have the object itself."""
        self._publisher.publish(copy.deepcopy(message))

    def get_subscription_count(self) -> int:
        """Return the number of subscriptions of the topic."""
        return self._publisher.subscription_count


class Timer:
    """Calls a function again and again."""

    def __init__(self, graph: VirtualGraph, period: float, callback: Callable[[], object]) -> None:
        self._graph, self._period, self._callback = graph, period, callback
        self._next = graph.clock.elapsed
        self._timer: ClockTimer | None = None
        self._due = False
        self._wait()

    def cancel(self) -> None:
        """Stop the timer."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _wait(self) -> None:
        self._next += self._period
        self._timer = self._graph.clock.call_later(self._next - self._graph.clock.elapsed, self._ring)

    def _ring(self) -> None:
        self._wait()
        if not self._due:
            self._due = True
            self._graph.call(self._call)

    def _call(self) -> None:
        self._due = False
        self._callback()


class Logger:
    """Passes what a node logs to the run."""

    def __init__(self, graph: VirtualGraph, name: str) -> None:
        self._graph, self._name = graph, name

    def info(self, text: str) -> None:
        """Log a line."""
        self._graph.print_line(self._name, text)

    warn = warning = error = info

    def debug(self, text: str) -> None:
        """Do nothing, as with rclpy's default level."""


class Subscription:
    """The type of subscriptions, for annotations."""


class Node:
    """A node.

    Attributes:
        graph: the virtual run's graph.
        backend: the node in it.
    """

    def __init__(self, node_name: str, *, namespace: str = "") -> None:
        self.graph = current()
        self.backend = self.graph.node(node_name, namespace)
        self._name = node_name
        self._parameters: dict[str, Parameter] = {}

    def create_publisher(
        self, msg_type: Interface, topic: str, qos_profile: QoSProfile | int, *, callback_group: Any = None
    ) -> Publisher:
        """Make a publisher."""
        return Publisher(self.backend.publisher(topic, msg_type.type_name, qos_of(qos_profile)))

    def create_subscription(
        self,
        msg_type: Interface,
        topic: str,
        callback: Callable[[Any], object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: Any = None,
    ) -> Any:
        """Call *callback* with each message of a topic; the oldest are dropped while callbacks are held."""
        qos = qos_of(qos_profile)
        waiting: deque[Any] = deque(maxlen=qos.depth)

        def take() -> None:
            if waiting:
                callback(waiting.popleft())

        def arrive(sample: Any) -> None:
            waiting.append(sample.message)
            self.graph.call(take)

        return self.backend.subscription(topic, msg_type.type_name, arrive, qos)

    def create_client(self, srv_type: Interface, srv_name: str, *, callback_group: Any = None) -> Client:
        """Make a client of a service."""
        return Client(self, srv_type, srv_name)

    def create_timer(self, timer_period_sec: float, callback: Callable[[], object]) -> Timer:
        """Call *callback* every so many seconds."""
        return Timer(self.graph, timer_period_sec, callback)

    def declare_parameter(self, name: str, value: Any) -> Parameter:
        """Declare a parameter; its value is that of the run, if it gives one."""
        self._parameters[name] = Parameter(self.graph.parameters.get(name, value))
        return self._parameters[name]

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter:
        """Return a declared parameter."""
        return self._parameters[name]

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """Return the type of a declared parameter."""
        return self._parameters[name].type_

    def get_name(self) -> str:
        """Return the node's name."""
        return self._name

    def get_logger(self) -> Logger:
        """Return the logger."""
        return Logger(self.graph, self._name)
