"""Parameters of our own node, which a mapping declares: launch files set them, other nodes change them, agents perceive
them as properties."""

import dataclasses
import json
import math
from collections.abc import Mapping
from shlex import quote

from jacaros.artifacts.env.values import Atom
from jacaros.robots.mapping.decoding import Convert, converted
from jacaros.robots.mapping.fields import AS_IT_IS, Conversion
from jacaros.robots.mapping.host import MappingHost
from jacaros.robots.mapping.properties import ParameterPart
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import (
    CapabilityMissing,
    ParameterRefused,
    ParameterUnknown,
    RosError,
)
from jacaros.robots.ros.node import Capability
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, fault_of
from jacaros.runtime.files.yaml import Problem

PATIENCE = 2.0
"""Seconds to wait for the master of ROS 1 before the default applies."""


def own_name(host: MappingHost, name: str) -> str:
    """Return the name that a parameter of our node has in the graph: below the artifact's namespace, ``r1.speed``.

    On ROS 1 names have slashes instead of dots: ``r1/speed``; ``patrol.speed`` becomes ``patrol/speed``.
    """
    prefix = host.robot_prefix.strip("/").replace("/", ".")
    whole = f"{prefix}.{name}" if prefix else name
    return whole.replace(".", "/") if kept_by_master(host.ros) else whole


def kept_by_master(ros: Backend) -> bool:
    """Return whether parameters are not declared because a master stores those of all nodes, as on ROS 1."""
    return (
        Capability.DECLARED_PARAMETERS not in ros.capabilities and Capability.REGISTRATION in ros.capabilities
    )


class OwnParameter:
    """A property from a parameter of our own node; it exists from the start.

    Where parameters are declared, other nodes can only set values that match the declaration. On ROS 1 the master
    accepts anything: a value that does not match is logged and ignored.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: MappingHost, part: ParameterPart) -> None:
        self._host, self._part, self._name = host, part, own_name(host, part.parameter)
        self._declaration = part.declaration
        conversion = part.field.conversion if part.field is not None else AS_IT_IS
        self._convert = parameter_converter(conversion)
        self._reading = host.reading_of(part.name, part.policy)
        self._closed = False

    def close(self) -> None:
        self._closed = True

    def _take(self, value: ParameterValue) -> None:
        if not self._closed:
            self._reading.take((self._convert(value),))

    def declare(self) -> Problem | None:
        """Declare it and show its value. Return a problem, if any.

        On ROS 1, call `ask` next.
        """
        ros = self._host.ros
        if kept_by_master(ros):
            return None
        try:
            parameters = ros.parameters()
            value = parameters.declare(self._name, self._declaration)
        except CapabilityMissing as error:
            return self._part.place.problem(str(error))
        except ParameterRefused as error:
            return self._part.place.problem(str(error), self._cure())
        self._host.at_dispose(lambda: parameters.withdraw(self._name))
        self._host.at_dispose(parameters.on_change(self._changed))
        self._take(value)
        return None

    def _cure(self) -> str:
        given = self._host.ros.given_parameters.get(self._name)
        if given is None or fault_of(given, self._declaration) is None:
            return "give it another name: parameter: NAME"
        fitting = quote(f"{self._name}:={json.dumps(self._declaration.default)}")
        return f"set another value where the agents are started, such as --param {fitting}"

    async def ask(self) -> None:
        """Show the value stored by the master of ROS 1, or else the default, and follow changes."""
        host = self._host
        parameters = host.ros.parameters()
        host.at_dispose(parameters.on_change(self._changed))
        try:
            value = await host.step(parameters.get(self._name, PATIENCE))
        except ParameterUnknown:
            value = self._declaration.default
        except RosError as error:
            host.log(
                f"`{self._name}` is {self._declaration.default!r} until the master reports another value: {error}"
            )
            value = self._declaration.default
        self._judge(value)
        if self._reading.newest is None:
            self._take(self._declaration.default)

    def _changed(self, values: Mapping[str, ParameterValue]) -> None:
        if self._name not in values:
            return
        if not kept_by_master(self._host.ros):
            self._take(values[self._name])
        elif self._declaration.read_only:
            self._ignore(values[self._name], "it is read-only")
        else:
            self._judge(values[self._name])

    def _judge(self, value: ParameterValue) -> None:
        """Use an unchecked value if it matches the declaration."""
        value = _alike(value, self._declaration)
        fault = fault_of(value, self._declaration)
        if fault is None:
            self._take(value)
        else:
            self._ignore(value, f"it is {fault}")

    def _ignore(self, value: ParameterValue, why: str) -> None:
        place, node = self._part.place, self._host.ros.node_name
        told = f"parameter `{node}/{self._name}` was set to {value!r}; value ignored: {why}"
        self._host.report([place.problem(told, "set another value")])


def _alike(value: ParameterValue, declaration: DeclaredParameter) -> ParameterValue:
    """Accept an integer for a floating-point number: roslaunch and rosparam read ``1`` as one."""
    if isinstance(declaration.default, float) and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    wanted = declaration.default
    if isinstance(wanted, list) and isinstance(value, list) and wanted and isinstance(wanted[0], float):
        return [float(each) if type(each) is int else each for each in value]  # type: ignore[return-value]
    return value


def parameter_converter(conversion: Conversion) -> Convert:
    """Return a function that converts the value of a parameter; of a list, each element."""
    convert: Convert = _as_atom if conversion.kind == "atom" else converted(conversion)
    unrounded = converted(dataclasses.replace(conversion, digits=None))

    def element(value: ParameterValue) -> object:
        # Infinity has no integer; the receiver of the value refuses it.
        endless = isinstance(value, float) and not math.isfinite(value)
        return unrounded(value) if endless else convert(value)

    return lambda value: [element(each) for each in value] if isinstance(value, list) else element(value)


def _as_atom(value: ParameterValue) -> object:
    return Atom(value) if isinstance(value, str) else value
