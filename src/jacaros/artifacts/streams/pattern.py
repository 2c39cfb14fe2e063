"""One derived event: takes events of its streams, and drives its operator."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from jacaros.artifacts.streams.operators import (
    ANYTHING,
    Absent,
    Condition,
    Count,
    Emit,
    Held,
    Hysteresis,
    Operator,
    Together,
    Values,
)
from jacaros.files.texts import suggestion

# The operators by name: their options, the checks of declarations, and the creation of operators.


LONGEST: Final = 86_400.0
"""Maximum duration in seconds of a window, or of waiting for late events: the window bounds memory."""

STATE, VALUE = "state", "value"
"""Kinds of output: a state without values, or with values."""


@dataclass(frozen=True, slots=True)
class Spec:
    """A declaration.

    Attributes:
        operator: name in `OPERATORS`.
        sources: streams by name, in the order of the declaration.
        options: times in seconds.
        place: index of the value of an event to use, from 0.
        lateness: further seconds for which samples that are joined wait for each other.
    """

    operator: str
    sources: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)
    place: int = 0
    lateness: float = 0.0

    def seconds(self, option: str) -> float:
        """The value of an option that is a time."""
        return float(self.options[option])

    @property
    def gives(self) -> str:
        """Kind of output: `STATE` or `VALUE`."""
        return STATE if "at_least" in self.options else OPERATORS[self.operator].gives


class Fault(NamedTuple):
    """An error in a declaration.

    Attributes:
        option: the invalid option; empty for the whole declaration.
        message: the error.
        help: the suggested fix.
    """

    option: str
    message: str
    help: str


def _make_count(spec: Spec, emit: Emit) -> Operator:
    wanted = spec.options.get("at_least")
    return Count(emit, spec.seconds("within"), int(wanted) if wanted is not None else None)


def _make_hysteresis(spec: Spec, emit: Emit) -> Operator:
    options = spec.options
    if "on_above" in options:
        return Hysteresis(emit, spec.place, options["on_above"], options["off_below"], True)
    return Hysteresis(emit, spec.place, options["on_below"], options["off_above"], False)


def _make_held(spec: Spec, emit: Emit) -> Operator:
    options = spec.options
    condition = Condition(options.get("above"), options.get("below"), options.get("equals", ANYTHING))
    return Held(emit, spec.seconds("for"), spec.place, condition)


def _make_absent(spec: Spec, emit: Emit) -> Operator:
    return Absent(emit, spec.seconds("for"))


def _make_together(spec: Spec, emit: Emit) -> Operator:
    return Together(emit, len(spec.sources), spec.seconds("within"), spec.lateness)


@dataclass(frozen=True, slots=True)
class Shape:
    """An operator and its requirements.

    Attributes:
        meaning: short description.
        gives: `STATE` or `VALUE`.
        make: creates it from a valid declaration.
        required, optional: names of options.
        valued: whether it uses one value of an event.
    """

    meaning: str
    gives: str
    make: Callable[[Spec, Emit], Operator]
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    valued: bool = False


_ON_AND_OFF = ("on_above", "off_below", "on_below", "off_above")
_CONDITION = ("above", "below", "equals")

OPERATORS: Final[dict[str, Shape]] = {
    "count": Shape("events in a window", VALUE, _make_count, ("within",), ("at_least",)),
    "hysteresis": Shape(
        "on beyond one limit, off beyond another", STATE, _make_hysteresis, (), _ON_AND_OFF, valued=True
    ),
    "held": Shape("a condition has held for a while", STATE, _make_held, ("for",), _CONDITION, valued=True),
    "absent": Shape("no event for a while", STATE, _make_absent, ("for",)),
    "together": Shape("samples with stamps near each other", VALUE, _make_together, ("within",)),
}
"""All operators by name: to add one, add a line here and its options to `_OPTIONS`."""

PARTNERS_WAIT: Final = 0.5
"""Default lateness in seconds where samples of several topics are joined, because the delays of topics differ."""


def unknown(operator: str) -> Fault:
    """Return the error for an unknown operator."""
    help = suggestion(operator, OPERATORS, f"operators: {', '.join(OPERATORS)}")
    return Fault("", f"unknown operator `{operator}`", help)


def faults(operator: str, sources: Sequence[str], options: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield all errors of a declaration.

    Args:
        operator: a name of `OPERATORS`.
        sources: as in `Spec`.
        options: options as written, times in seconds.
    """
    shape = OPERATORS[operator]
    if operator == "together" and len(sources) < 2:
        help = "write them as a list, such as [scan, pose]"
        yield Fault("", f"`{operator}` needs two streams or more", help)
    if operator == "together" and len(set(sources)) < len(sources):
        yield Fault("", f"`{operator}` names a stream twice", "name each stream once")
    known = (*shape.required, *shape.optional)
    for name in shape.required:
        if name not in options:
            yield Fault("", f"`{operator}` needs `{name}`", _NEEDED[name])
    for name, value in options.items():
        if name not in known:
            help = suggestion(name, known, f"options: {', '.join(known)}")
            yield Fault(name, f"`{operator}` has no option `{name}`", help)
        elif wrong := _OPTIONS.get(name, _number)(value):
            yield Fault(name, f"`{name}` {wrong[0]}", wrong[1])
    if operator == "hysteresis":
        yield from _wrong_limits(options)


_NEEDED: Final = {
    "within": "give the length of the window, so that its memory is bounded",
    "for": "give the time that must pass",
}

_Wrong = tuple[str, str] | None
"""What is wrong with the value of an option, and the help."""


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _number(value: Any) -> _Wrong:
    return None if _is_number(value) else ("must be a number", "write a number such as 0.5")


def _seconds(value: Any) -> _Wrong:
    if value == math.inf:
        return "is unbounded", "give a finite time: memory is bounded by the window"
    if not _is_number(value):
        return "must be a duration", "write a number above zero"
    if value <= 0.0:
        return "must be above zero", "write a positive time"
    if value > LONGEST:
        return "is longer than a day", "give a shorter time: memory is bounded by the window"
    return None


def _whole(value: Any) -> _Wrong:
    if not _is_number(value) or value <= 0:
        return "must be above zero", "write a positive number"
    return None if value == int(value) else ("must be a whole number", "write a number such as 3")


_OPTIONS: Final[dict[str, Callable[[Any], _Wrong]]] = {
    "within": _seconds,
    "for": _seconds,
    "at_least": _whole,
    "equals": lambda value: None,
}
"""The checks of options; all others are numbers."""


def _wrong_limits(options: Mapping[str, Any]) -> Iterator[Fault]:
    used = [name for name in _ON_AND_OFF if name in options]
    if used not in (["on_above", "off_below"], ["on_below", "off_above"]):
        help = "give `on_above` and `off_below`, or `on_below` and `off_above`"
        yield Fault("", "`hysteresis` needs two limits", help)
        return
    on, off = options[used[0]], options[used[1]]
    if _is_number(on) and _is_number(off) and (on < off if used[0] == "on_above" else on > off):
        side = "at most" if used[0] == "on_above" else "at least"
        yield Fault(used[1], f"`{used[1]}` must be {side} `{used[0]}`", "swap the two limits")


class Pattern:
    """The incremental evaluation of one declaration.

    Event times are seconds of any clock. An event that is older than the time up to which the pattern has been evaluated,
    because its message took long, counts at that time.

    Args:
        spec: a valid declaration.
        start: start time of the pattern.
        emit: takes the outputs, in order.
    """

    __slots__ = ("_mark", "_operator", "_start", "spec")

    def __init__(self, spec: Spec, start: float, emit: Emit) -> None:
        self.spec = spec
        self._operator = OPERATORS[spec.operator].make(spec, emit)
        self._start = start
        self._mark = 0.0

    @property
    def shown(self) -> Values | None:
        """Values of the derived state, None while it does not hold."""
        return self._operator.shown

    @property
    def dropped(self) -> int:
        """Number of events that arrived too late for their partners."""
        return int(getattr(self._operator, "dropped", 0))

    @property
    def deadline(self) -> float:
        """Time of the next call of `advance`, unless an event arrives before; infinite for never."""
        return self._start + self._operator.deadline

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream in `Spec.sources`.
            time: time of the event, in seconds.
            values: values of the event; None if the state shown by the stream ended.
        """
        time -= self._start
        if self._operator.ordered:
            time = max(time, self._mark)
            self._pass(time)
        self._operator.take(source, time, values)

    def advance(self, now: float) -> None:
        """Advance to *now* on the clock of the event times."""
        time = max(self._mark, now - self._start)
        # A deadline at *now* is due, despite rounding in the conversion of times.
        self._pass(max(time, self._operator.deadline) if self.deadline <= now else time)

    def _pass(self, time: float) -> None:
        """Advance the operator through its deadlines up to *time*."""
        self._mark = time
        operator = self._operator
        while (due := operator.deadline) <= time:
            operator.advance(due)
            if operator.deadline <= due:  # an operator that makes no progress would block all others
                operator.deadline = math.nextafter(due, math.inf)
