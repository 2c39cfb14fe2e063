"""The declared parameters of one node, with ROS 2's rules: fixed types, ranges, and refusals."""

from collections.abc import Callable, Mapping

from jacaros.ros.errors import ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import Declaration, GivenParameters, ParameterValue, checked_value, fault_of


class DeclaredParameters:
    """The declarations and values of a node.

    Args:
        node: its absolute name, for messages.
        given: values from outside, in place of defaults.
        changed: called after every declaration and change.
        log: called with one line about a failed check.
    """

    def __init__(
        self,
        node: str,
        given: GivenParameters,
        changed: Callable[[Mapping[str, ParameterValue]], None],
        log: Callable[[str], None],
    ) -> None:
        self._node = node
        self._given = given
        self._changed = changed
        self._log = log
        self._declarations: dict[str, Declaration] = {}
        self._values: dict[str, ParameterValue] = {}

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
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

    def _require(self, name: str, declaration: Declaration, value: ParameterValue) -> None:
        what = f"parameter {name} of {self._node}"
        if (fault := fault_of(value, declaration)) is not None:
            raise ParameterRefused(f"{what} is {fault}")
        reason = self._judged(declaration, value)
        if reason is not None:
            raise ParameterRefused(f"{what} cannot be {value!r}: {reason}")

    def _judged(self, declaration: Declaration, value: ParameterValue) -> str | None:
        if declaration.accept is None:
            return None
        try:
            return declaration.accept(value)
        except Exception as problem:  # the node keeps running, and the caller receives the reason
            reason = f"{type(problem).__name__}: {problem}"
            self._log(f"the check of a parameter of {self._node} failed: {reason}")
            return reason

    def _unknown(self, name: str) -> str:
        known = f"it has {', '.join(self.names())}" if self._values else "it has none"
        return f"node {self._node} has no parameter {name}; {known}"
