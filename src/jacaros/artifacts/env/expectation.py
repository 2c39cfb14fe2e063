"""What an operation expects of observable properties: patterns of values, and whether values match them.

=======================================  =================================================================
a pattern                                matches
=======================================  =================================================================
``"_"``                                  any value
``"$x"``                                 the argument for the parameter ``x`` of the operation
``{"not": P}``                           values that do not match the pattern P
``{"in": [P, Q]}``                       values that match one of several patterns
``[P, Q]``                               lists whose elements match
``{"near": 2.5, "by": 0.5}``             numbers that differ by at most 0.5. ``near`` can be a parameter. With
                                         ``"unit": "degrees"`` (or ``"radians"``), full turns do not count
anything else                            a value that is equal for an agent
=======================================  =================================================================
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from jacaros.artifacts.env.values import Atom, Structure, equal, text
from jacaros.runtime.files.texts import suggestion

_TURNS: Final = {"degrees": 360.0, "radians": math.tau}
_NEAR: Final = {"near", "by"}


@dataclass(frozen=True, eq=False)
class Expect:
    """Values that a property must have, or with `signal`, a signal that must not be sent.

    Properties called `name` are looked for in all artifacts of the same robot (`robot_prefix`) in the workspace; one that
    matches is enough. While none has had a property of this name, the expectation is not checked.

    Attributes:
        name: name of the property or signal.
        values: one pattern for each value (see the module).
        within: seconds in which the property must get the values, 0 or more.
        reason: reason term of the failure, a text for an atom. None: ``expected(Wanted,found(Found))``.
        signal: whether this is a signal, which must not be sent. For ``meanwhile``.
    """

    name: str
    values: Sequence[Any] = ()
    within: float = 0.0
    reason: Structure | str | None = None
    signal: bool = False

    def bound(self, arguments: Mapping[str, object]) -> "Expect":
        """Return the expectation with the arguments of a call in place of parameters."""
        return replace(self, values=[_bound(each, arguments) for each in self.values])

    def matches(self, values: Sequence[object]) -> bool:
        """Return whether the values of a property or signal match."""
        return len(values) == len(self.values) and all(map(_matches, self.values, values))

    def missed(self, found: Sequence[object] | None) -> tuple[str, Structure | Atom]:
        """Return the text and the reason of a failure: what was expected, and the values *found* (None: no property)."""
        here = Atom("nothing") if found is None else _term(self.name, found)
        return f"expected {self}, found {text(here)}", self.failure(
            "expected", self.wanted, Structure("found", (here,))
        )

    def failure(self, functor: str, *arguments: object) -> Structure | Atom:
        """Return the reason, or the one with these parts if none was given."""
        if self.reason is None:
            return Structure(functor, arguments)
        return Atom(self.reason) if isinstance(self.reason, str) else self.reason

    @property
    def wanted(self) -> Structure | Atom:
        """The expected property as a term: ``battery(any,not(discharging))``."""
        return _term(self.name, map(_pattern_term, self.values))

    def __str__(self) -> str:
        within = f" within {self.within:g} s" if self.within else ""
        return f"{'no ' * self.signal}{text(self.wanted)}{within}"


def _term(name: str, arguments: Iterable[object]) -> Structure | Atom:
    given = tuple(arguments)
    return Structure(name, given) if given else Atom(name)


def _bound(pattern: Any, arguments: Mapping[str, object]) -> Any:
    if isinstance(pattern, str) and pattern.startswith("$"):
        return arguments.get(pattern[1:])
    if isinstance(pattern, list):
        return [_bound(each, arguments) for each in pattern]
    if isinstance(pattern, dict):
        return {key: _bound(each, arguments) for key, each in pattern.items()}
    return pattern


def _matches(pattern: Any, value: object) -> bool:
    match pattern:
        case "_":
            return True
        case {"not": refused}:
            return not _matches(refused, value)
        case {"in": choices}:
            return any(_matches(each, value) for each in choices)
        case {"near": centre, "by": most}:
            return _is_number(centre) and _is_number(value) and _gap(pattern, centre, value) <= most
        case list() if isinstance(value, list | tuple):
            return len(pattern) == len(value) and all(map(_matches, pattern, value))
    return equal(pattern, value)


def _gap(pattern: Mapping[str, Any], centre: float, value: Any) -> float:
    turn = _TURNS.get(pattern.get("unit", ""))
    gap = float(abs(value - centre))
    return gap if turn is None else min(gap % turn, turn - gap % turn)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _pattern_term(pattern: Any) -> object:
    match pattern:
        case {"not": refused}:
            return Structure("not", (_pattern_term(refused),))
        case {"in": choices}:
            return Structure("in", ([_pattern_term(each) for each in choices],))
        case {"near": centre, "by": most}:
            return Structure("near", (_pattern_term(centre), most))
        case list():
            return [_pattern_term(each) for each in pattern]
    if pattern == "_":
        return Atom("any")
    return Atom(pattern) if isinstance(pattern, str) and re.fullmatch(r"\$?[a-z]\w*", pattern) else pattern


def mistake_in(pattern: Any, parameters: Sequence[str]) -> tuple[str, str] | None:
    """Return what is wrong with a pattern, and how to correct it. None if nothing is."""
    known = [f"${each}" for each in parameters]
    if isinstance(pattern, str) and pattern.startswith("$") and pattern not in known:
        listed = f"parameters: {', '.join(known) or 'none'}"
        return f"the operation has no parameter `{pattern[1:]}`", suggestion(pattern, known, listed)
    if isinstance(pattern, list):
        return next(filter(None, (mistake_in(each, parameters) for each in pattern)), None)
    if not isinstance(pattern, dict):
        return None
    keys = set(pattern)
    if keys == {"not"}:
        return mistake_in(pattern["not"], parameters)
    if keys == {"in"} and isinstance(pattern["in"], list):
        return mistake_in(pattern["in"], parameters)
    if keys in (_NEAR, {*_NEAR, "unit"}) and pattern.get("unit", "degrees") in _TURNS:
        centre, most = pattern["near"], pattern["by"]
        if _is_number(most) and most >= 0 and (_is_number(centre) or centre in known):
            return None
        return mistake_in(centre, parameters) or (
            "`near` needs two numbers, the first of which can be a parameter",
            "write {near: $x, by: 0.5}",
        )
    return (
        "invalid pattern",
        "write a constant, _, $parameter, {not: X}, {in: [X, Y]} or {near: X, by: 20, unit: degrees}",
    )
