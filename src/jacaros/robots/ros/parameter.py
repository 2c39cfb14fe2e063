"""Parameters of nodes: named values that other nodes read and set, with notification of changes.

On ROS 2 a parameter belongs to a node, which declares it; on ROS 1 the master stores all parameters, nothing is
declared, and "a node's parameters" are those below its name.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from jacaros.robots.ros.errors import ParameterRefused, ParameterUnknown

ParameterValue = bool | int | float | str | list[bool] | list[int] | list[float] | list[str] | bytes
"""The values that a parameter can have everywhere; ROS 1 also has mappings, which `Parameters.get` returns by their
parts ``a/b``."""

_NAMES: dict[type, str] = {bool: "bool", int: "int", float: "float", str: "text", bytes: "bytes"}
_WIDEST = 2**63


@dataclass(frozen=True, slots=True)
class DeclaredParameter:
    """The declaration of a node's own parameter.

    Attributes:
        default: its initial value, which also determines its type.
        description: one line of text.
        read_only: whether it cannot be changed.
        minimum, maximum: range of a number.
    """

    default: ParameterValue
    description: str = ""
    read_only: bool = False
    minimum: float | None = None
    maximum: float | None = None


def fault_of(value: ParameterValue, declaration: DeclaredParameter) -> str | None:
    """Return what is wrong with *value* for a declared parameter: its type or its range; None if nothing is."""
    wanted, given = kind_of(declaration.default), kind_of(value)
    if wanted != given and not _is_empty_of(wanted, given):
        told = f"of type {wanted}; {value!r} is of type {given}"
        if wanted == "float" and given == "int":
            told += f"; write {value!r}.0"
        return told
    low, high = declaration.minimum, declaration.maximum
    if isinstance(value, int | float) and (
        (low is not None and value < low) or (high is not None and value > high)
    ):
        return f"{_range(low, high)}, not {value!r}"
    return None


def _is_empty_of(wanted: str, given: str) -> bool:
    """Return whether one of two kinds is an empty list, which matches the other; alone it is a list of texts, as on
    ROS 1."""
    return (given == "empty list" and wanted.startswith("list")) or (wanted, given) == (
        "empty list",
        "list of text",
    )


def checked_value(value: Any) -> ParameterValue:
    """Return *value* in plain types that a parameter can hold.

    Raises:
        ParameterRefused: a parameter cannot hold it; the text lists what it can hold.
    """
    if isinstance(value, list | tuple):
        elements = [checked_value(element) for element in value]
        kinds = {type(element) for element in elements}
        if len(kinds) <= 1 and kinds <= {bool, int, float, str}:
            return elements  # type: ignore[return-value]  # of one kind each
    elif isinstance(value, str):
        return str.__str__(value)  # subclasses, such as atoms of the agents' language, become plain texts
    elif isinstance(value, bytes | bytearray):
        return bytes(value)
    elif isinstance(value, int) and not -_WIDEST <= value < _WIDEST:
        # Python writes no integer of more than 4,300 digits.
        number = value if value.bit_length() < 256 else f"an integer of {value.bit_length()} bits"
        raise ParameterRefused(f"{number} is too large for a parameter, which has 64 bits")
    elif isinstance(value, bool | int) or (isinstance(value, float) and not math.isnan(value)):
        return value
    raise ParameterRefused(
        f"expected a bool, a number, a text, bytes, or a list of bools, ints, floats or texts, found {value!r}"
    )


def kind_of(value: ParameterValue) -> str:
    """Return the type of a value: ``bool``, ``int``, ``float``, ``text``, ``bytes``, ``list of int``…, ``empty
    list``."""
    if isinstance(value, list):
        return f"list of {_NAMES[type(value[0])]}" if value else "empty list"
    return _NAMES[type(value)]


def _range(low: float | None, high: float | None) -> str:
    if low is None:
        return f"at most {high:g}"
    if high is None:
        return f"at least {low:g}"
    return f"from {low:g} to {high:g}"


class Parameters(Protocol):
    """The parameters of one node, our own or another."""

    @property
    def node(self) -> str:
        """Absolute name of the node."""

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
        """Declare a parameter of our own node and return its value (that of the launch file, if given).

        Raises:
            CapabilityMissing: the backend does not declare parameters (`Capability.DECLARED_PARAMETERS`), or the node is
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
            CapabilityMissing: the middleware does not report changes (`Capability.PARAMETER_EVENTS`).
        """


class GivenParameters(dict[str, ParameterValue]):
    """Values of parameters from outside, and which of them are declared.

    As in other nodes of ROS 2, a value takes effect when its parameter is declared; an undeclared one does not exist.

    Args:
        values: by the names of the parameters.
    """

    def __init__(self, values: Mapping[str, ParameterValue]) -> None:
        super().__init__(values)
        self._taken: set[str] = set()

    def take(self, name: str) -> ParameterValue | None:
        """Return the value for a parameter that is being declared; None if none exists."""
        self._taken.add(name)
        return self.get(name)

    def untaken(self) -> list[str]:
        """Return the names of undeclared parameters, sorted."""
        return sorted(set(self) - self._taken)

    def known(self) -> list[str]:
        """Return the names of all declared parameters, sorted."""
        return sorted(self._taken)


class DeclaredParameters:
    """The declarations and values of a node.

    Args:
        node: its absolute name, for messages.
        given: values from outside, in place of defaults.
        changed: called after every declaration and change.
    """

    def __init__(
        self,
        node: str,
        given: GivenParameters,
        changed: Callable[[Mapping[str, ParameterValue]], None],
    ) -> None:
        self._node = node
        self._given = given
        self._changed = changed
        self._declarations: dict[str, DeclaredParameter] = {}
        self._values: dict[str, ParameterValue] = {}

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
        """Declare a parameter and return its value; see `Parameters.declare`."""
        if name in self._declarations:
            raise ParameterRefused(f"parameter {name} of {self._node} is already declared")
        if not name:
            raise ParameterRefused(f"a parameter of {self._node} has an empty name")
        value = default = checked_value(declaration.default)
        if (given := self._given.take(name)) is not None:
            value = checked_value(given)
        for candidate in (default, value):
            self._require(name, declaration, candidate)
        self._declarations[name] = declaration
        self._values[name] = value
        self._changed({name: value})
        return value

    def withdraw(self, name: str) -> None:
        """Undeclare a parameter. Raises `ParameterUnknown`."""
        self.get(name)
        del self._declarations[name], self._values[name]

    def names(self) -> list[str]:
        """Return all names, sorted."""
        return sorted(self._values)

    def get(self, name: str) -> ParameterValue:
        """Return a value. Raises `ParameterUnknown`."""
        if name not in self._values:
            raise ParameterUnknown(self._unknown(name))
        return self._values[name]

    def set(self, name: str, value: ParameterValue) -> None:
        """Change a value. Raises `ParameterUnknown` or `ParameterRefused`."""
        declaration = self._declarations.get(name)
        if declaration is None:
            raise ParameterUnknown(self._unknown(name))
        if declaration.read_only:
            raise ParameterRefused(f"parameter {name} of {self._node} is read-only")
        taken = checked_value(value)
        self._require(name, declaration, taken)
        self._values[name] = taken
        self._changed({name: taken})

    def _require(self, name: str, declaration: DeclaredParameter, value: ParameterValue) -> None:
        if (fault := fault_of(value, declaration)) is not None:
            raise ParameterRefused(f"parameter {name} of {self._node} is {fault}")

    def _unknown(self, name: str) -> str:
        known = f"it has {', '.join(self.names())}" if self._values else "it has none"
        return f"node {self._node} has no parameter {name}; {known}"
