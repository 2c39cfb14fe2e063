"""Parameters of nodes: values by name, read and written by others, with news of changes.

On ROS 2 a parameter belongs to a node and is declared by it; on ROS 1 the master keeps all of them, nothing is
declared, and "a node's parameters" are those below its name.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

ParameterValue = bool | int | float | str | list[bool] | list[int] | list[float] | list[str] | bytes
"""What a parameter can hold everywhere; ROS 1 also has mappings, which `Parameters.get` gives by their parts ``a/b``."""


@dataclass(frozen=True, slots=True)
class Declaration:
    """What a node says of a parameter of its own.

    Attributes:
        default: its first value, and by it its type.
        description: one line for people.
        read_only: nobody may change it.
        minimum, maximum: of a number.
        accept: judges a new value: None to take it, or the reason for refusing it.
    """

    default: ParameterValue
    description: str = ""
    read_only: bool = False
    minimum: float | None = None
    maximum: float | None = None
    accept: Callable[[ParameterValue], str | None] | None = None


class Parameters(Protocol):
    """The parameters of one node, our own or another."""

    @property
    def node(self) -> str:
        """Absolute name of the node."""

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter of our own node and give its value (that of the launch file, if it had one).

        Raises:
            CapabilityMissing: parameters are not declared here (`DECLARED_PARAMETERS`), or the node is another.
            ParameterRefused: it is declared already, or the default breaks the declaration.
        """

    def withdraw(self, name: str) -> None:
        """Take a declaration of our own node back, also that of a read-only parameter; it may be declared anew then.

        Raises:
            ParameterUnknown: our node has no such parameter.
            CapabilityMissing: as `declare`.
        """

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters, sorted; raises as `get`."""

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value.

        Raises:
            ParameterUnknown: the node has no such parameter.
            ServiceUnavailable, CallTimedOut, CallFailed: the node (ROS 1: the master) cannot be asked.
        """

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter.

        Raises:
            ParameterUnknown: the node has declared no such parameter.
            ParameterRefused: it is read-only, of another type, out of its range, or the node said no; the text tells.
            ServiceUnavailable, CallTimedOut, CallFailed: as `get`.
        """

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Have *callback* called on the loop with the parameters of this node that were changed or declared, by anybody.

        Returns:
            what ends that.

        Raises:
            CapabilityMissing: the middleware does not tell (`PARAMETER_EVENTS`).
        """


class GivenParameters:
    """Values from outside, and which of them somebody has asked for.

    As in other nodes of ROS 2 a value counts when its parameter is declared; one that nobody declares is not there.

    Args:
        values: by the names of the parameters.
    """

    def __init__(self, values: Mapping[str, ParameterValue]) -> None:
        self._values = dict(values)
        self._taken: set[str] = set()

    def value(self, name: str) -> ParameterValue | None:
        """The value for a parameter; None when nobody has given one."""
        return self._values.get(name)

    def take(self, name: str) -> ParameterValue | None:
        """Give the value for a parameter that is being declared; None when nobody has given one."""
        self._taken.add(name)
        return self._values.get(name)

    def items(self) -> Iterator[tuple[str, ParameterValue]]:
        """All of them with their names."""
        yield from self._values.items()

    def untaken(self) -> list[str]:
        """Names of those that nobody has declared so far, sorted."""
        return sorted(set(self._values) - self._taken)

    def known(self) -> list[str]:
        """Names of all parameters that were declared, sorted."""
        return sorted(self._taken)
