"""Parameters of nodes: named values that other nodes read and set, with notification of changes.

On ROS 2 a parameter belongs to a node, which declares it; on ROS 1 the master stores all parameters, nothing is
declared, and "a node's parameters" are those below its name.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

ParameterValue = bool | int | float | str | list[bool] | list[int] | list[float] | list[str] | bytes
"""The values that a parameter can have everywhere; ROS 1 also has mappings, which `Parameters.get` returns by their
parts ``a/b``."""


@dataclass(frozen=True, slots=True)
class Declaration:
    """The declaration of a node's own parameter.

    Attributes:
        default: its initial value, which also determines its type.
        description: one line of text.
        read_only: whether it cannot be changed.
        minimum, maximum: range of a number.
        accept: decides about a new value: returns None to accept it, or the reason for refusing it.
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
        """Declare a parameter of our own node and return its value (that of the launch file, if given).

        Raises:
            CapabilityMissing: the backend does not declare parameters (`DECLARED_PARAMETERS`), or the node is
                another.
            ParameterRefused: it is already declared, or the default violates the declaration.
        """

    def withdraw(self, name: str) -> None:
        """Undeclare a parameter of our own node, even a read-only one; it can then be declared again.

        Raises:
            ParameterUnknown: our node has no such parameter.
            CapabilityMissing: as `declare`.
        """

    async def names(self, timeout: float | None = None) -> list[str]:
        """Return the names of the node's parameters, sorted. Raises as `get`."""

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value.

        Raises:
            ParameterUnknown: the node has no such parameter.
            ServiceUnavailable, CallTimedOut, CallFailed: the node (ROS 1: the master) did not answer.
        """

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter.

        Raises:
            ParameterUnknown: the node has not declared the parameter.
            ParameterRefused: it is read-only, of another type, out of its range, or the node refused the value; the
                text says which.
            ServiceUnavailable, CallTimedOut, CallFailed: as `get`.
        """

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* on the loop with parameters of this node that any node has changed or declared.

        Returns:
            A function that removes the callback.

        Raises:
            CapabilityMissing: the middleware does not report changes (`PARAMETER_EVENTS`).
        """


class GivenParameters:
    """Values of parameters from outside, and which of them are declared.

    As in other nodes of ROS 2, a value takes effect when its parameter is declared; an undeclared one does not exist.

    Args:
        values: by the names of the parameters.
    """

    def __init__(self, values: Mapping[str, ParameterValue]) -> None:
        self._values = dict(values)
        self._taken: set[str] = set()

    def value(self, name: str) -> ParameterValue | None:
        """Return the value for a parameter; None if none exists."""
        return self._values.get(name)

    def take(self, name: str) -> ParameterValue | None:
        """Return the value for a parameter that is being declared; None if none exists."""
        self._taken.add(name)
        return self._values.get(name)

    def items(self) -> Iterator[tuple[str, ParameterValue]]:
        """Return all names and values."""
        yield from self._values.items()

    def untaken(self) -> list[str]:
        """Return the names of undeclared parameters, sorted."""
        return sorted(set(self._values) - self._taken)

    def known(self) -> list[str]:
        """Return the names of all declared parameters, sorted."""
        return sorted(self._taken)
