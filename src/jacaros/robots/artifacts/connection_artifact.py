"""``ArtRos``: the connection to the middleware, for agents that inspect the graph."""

import math
from collections.abc import Awaitable
from typing import ClassVar, TypeVar

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.kit.options import positive
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.kit.services import failure_reason, set_parameter
from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.ros.errors import (
    ParameterRefused,
    ParameterUnknown,
    RosError,
    ServiceError,
    TransformUnavailable,
)
from jacaros.robots.ros.parameter import Parameters, ParameterValue
from jacaros.robots.ros.ros_clock import RosClock

T = TypeVar("T")

PATIENCE = 5.0
"""Default of the option ``timeout``, in seconds."""

LEVELS = ("debug", "info", "warn", "error", "fatal")


class ArtRos(RosArtifact):
    """Shows the connection to ROS, and lets agents query the graph.

    Names of nodes are below the robot's name, if the artifact was made with one; with a leading slash they are
    absolute.  An operation that gets no answer fails with ``service_unavailable(Name)``, ``service_timeout(Seconds)``,
    ``server_lost`` or ``service_failed(Name)``.

    Options:
        timeout(S): seconds that operations wait for an answer (5).

    Properties:
        middleware(Kind): ``memory``, ``ros1``, ``ros2`` or ``rosbridge``.
        node(Name): the name of our own node, as text.
        connected: the graph (on ROS 1: the master) can be reached; the property does not exist while it cannot.

    Signals:
        clock_jumped(S): with ``--clock ros``: the simulator's time went back by S seconds.
        clock_jumped_ahead(S): with ``--clock ros``: it went S seconds ahead, more than 5, in one step.
    """

    known_options: ClassVar = {"timeout": positive}

    def open(self) -> None:
        """Show the connection, and track it."""
        self.define_property("middleware", Atom(self.ros.name))
        self.define_property("node", self.ros.node_name)
        if self.ros.connected:
            self.define_property("connected")
        self.at_dispose(self.ros.on_connection(lambda present: self.start(self.show_connected, present)))
        if isinstance(self.clock, RosClock):
            self.at_dispose(self.clock.on_jump(lambda by: self.start(self.report_jump, by)))

    @internal_operation
    def show_connected(self, connected: bool) -> None:
        """Define the property ``connected``, or remove it."""
        if connected and not self.has_property("connected"):
            self.define_property("connected")
        elif not connected and self.has_property("connected"):
            self.remove_property("connected")

    @internal_operation
    def report_jump(self, by: float) -> None:
        """Signal a jump of the clock, back if *by* is negative."""
        self.signal("clock_jumped" if by < 0 else "clock_jumped_ahead", abs(by))

    # ---- parameters

    @operation
    async def get_parameter(self, node: str, name: str, value: Out) -> None:
        """Give the value of a node's parameter: a number, text, truth value, or a list of them.

        Fails with ``parameter_unknown(Name)`` if the node has no such parameter.
        """
        found = await self._asked(self._parameters(node).get(name, self._patience), node, name)
        value.set(list(found) if isinstance(found, bytes) else found)

    @operation
    async def set_parameter(self, node: str, name: str, value: object) -> None:
        """Change a node's parameter; an integer is accepted for a floating-point parameter.

        Fails with ``parameter_unknown(Name)``, or with ``parameter_refused(Name)`` if the node refuses the value.
        """
        wanted = _parameter_value(value)
        if wanted is None:
            text = f"expected a number, text, truth value or list of them, found {value!r}"
            self.fail(text, "parameter_refused", name)
        await self._asked(set_parameter(self._parameters(node), name, wanted, self._patience), node, name)

    @operation
    async def list_parameters(self, node: str, names: Out) -> None:
        """Give the names of a node's parameters, as a list of texts."""
        names.set(await self._asked(self._parameters(node).names(self._patience), node))

    def _parameters(self, node: str) -> Parameters:
        return self.ros.parameters(self.robot_topic(node))

    # ---- the graph

    @operation
    async def list_topics(self, topics: Out) -> None:
        """Give all topics, as a list of ``topic(Name, Type)``."""
        listed = sorted((await self._contents()).topics.items())
        topics.set([Structure("topic", (name, info.types[0] if info.types else "")) for name, info in listed])

    @operation
    async def list_nodes(self, nodes: Out) -> None:
        """Give the names of all nodes, as a list of texts."""
        nodes.set(list((await self._contents()).nodes))

    async def _contents(self) -> GraphContents:
        return await self._asked(self.ros.contents(self._patience), "graph")

    @operation
    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log under our node's name; *level* is debug, info, warn, error or fatal."""
        if level not in LEVELS:
            self.fail(f"unknown level `{level}`: expected one of {', '.join(LEVELS)}", "unknown_level", level)
        self.ros.rosout(str(level), text)

    # ---- frames

    @operation
    async def lookup_transform(self, target: str, source: str, x: Out, y: Out, yaw: Out) -> None:
        """Give the pose of frame *source* in frame *target* by the newest transforms, as tf2 does.

        X and Y are in metres, Yaw in degrees, counter-clockwise, in (-180, 180]. Waits for a transform; if none
        arrives, it fails with ``transform_unavailable(Reason)``: ``unknown_frame``, ``not_connected``, ``too_old`` or
        ``too_new``.
        """
        waiting = self.ros.tf_wait(target.lstrip("/"), source.lstrip("/"), timeout=self._patience)
        found = await self._asked(waiting, target)
        x.set(found.translation[0])
        y.set(found.translation[1])
        yaw.set(math.degrees(found.yaw))

    # ---- shared by the operations

    @property
    def _patience(self) -> float:
        return self.option("timeout", PATIENCE)

    async def _asked(self, question: Awaitable[T], whom: str, what: str = "") -> T:
        try:
            return await self.step(question)
        except (ServiceError, ParameterUnknown, ParameterRefused, TransformUnavailable) as error:
            self.fail(str(error), *failure_reason(error, str(whom), self._patience, what or str(whom)))
        except RosError as error:
            self.fail(str(error), "ros_error", type(error).__name__)


def _parameter_value(value: object) -> ParameterValue | None:
    """Convert a value of an agent to a parameter value, None if that is not possible."""
    if isinstance(value, bool | int | float):
        return value
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, list | tuple):
        parts = [_parameter_value(each) for each in value]
        kinds = {float if isinstance(each, float) else type(each) for each in parts}
        if kinds == {int, float}:
            return [float(each) for each in parts if isinstance(each, int | float)]
        if len(kinds) <= 1 and not kinds & {list, type(None)}:
            return parts  # type: ignore[return-value]  # all of them are of one plain kind
    return None
