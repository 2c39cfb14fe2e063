"""Parameters of other nodes as properties."""

from collections.abc import Mapping

from jacaros.artifacts.mapping.declared import AS_IT_IS, ParameterPart
from jacaros.artifacts.mapping.host import Host
from jacaros.artifacts.mapping.parameter_values import parameter_converter
from jacaros.artifacts.mapping.taking import Unshowable
from jacaros.ros.backend import PARAMETER_EVENTS
from jacaros.ros.errors import CapabilityMissing, ParameterUnknown, RosError, ServiceUnavailable
from jacaros.ros.parameter import ParameterValue

PATIENCE = 2.0
"""Seconds that a node has for telling a parameter before it is asked again."""

RETRY = 1.0
"""Seconds between two attempts."""


PATIENT = 2
"""So many attempts at a node that is not there are nothing to tell of: it may be starting."""


class NodeParameter:
    """A property from a parameter; it is there while the node tells it.

    Args:
        host: the artifact.
        part: what the mapping says.
    """

    def __init__(self, host: Host, part: ParameterPart) -> None:
        self._host, self._part = host, part
        conversion = part.field.conversion if part.field is not None else AS_IT_IS
        self._convert = parameter_converter(conversion, part.parameter)
        self._reading = host.reading_of(part.name, part.policy)
        self._node = host.ros.resolve(host.robot_topic(part.node))
        self._closed = False
        self._vain = 0
        try:
            self._parameters = host.ros.parameters(self._node)
            self._events = PARAMETER_EVENTS in host.ros.capabilities
            if self._events:
                host.at_dispose(self._parameters.on_change(self._changed))
        except CapabilityMissing as error:
            host.fail(f"{host.mapping.where(part.place)}: {error}", "ros_error", host.name)
        host.start(host.run_process, self._follow)

    async def _follow(self) -> None:
        """Ask until the node has answered, and where nobody tells of changes for ever."""
        host, part = self._host, self._part
        while not self._closed:
            try:
                value = await host.step(self._parameters.get(part.parameter, PATIENCE))
            except RosError as error:
                self._lose(error)
                await host.sleep(RETRY)
                continue
            self._vain = 0
            self._take(value)
            if self._events:
                return
            await host.sleep(1.0 / part.rate)

    def _changed(self, values: Mapping[str, ParameterValue]) -> None:
        if self._part.parameter in values:
            self._take(values[self._part.parameter])

    def _take(self, value: ParameterValue) -> None:
        if self._closed:
            return
        try:
            self._reading.take((self._convert(value),))
        except Unshowable as error:
            self._withdraw()
            part = self._part
            told = f"{part.name} is not shown: {error}"
            self._host.tell_once((part.name, error.functor), part.place, told, error.cure)

    def _withdraw(self) -> None:
        if self._reading.newest is not None:
            self._reading.withdraw()

    def _lose(self, error: RosError) -> None:
        self._withdraw()
        part = self._part
        if isinstance(error, ParameterUnknown):
            self._host.tell_once(
                part.name, part.place, f"{part.name} is not known: {error}", "write another name"
            )
        if isinstance(error, ServiceUnavailable):
            self._vain += 1
        if self._vain == PATIENT:
            self._host.tell_once(
                (part.name, "node"),
                part.place,
                f"{part.name} is not known so far: nobody answers for node {self._node}; still trying",
                "is that node running, and is this its name?",
            )

    def close(self) -> None:
        """Ask no more."""
        self._closed = True
