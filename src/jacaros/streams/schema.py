"""The operators by name: their options, the checks of declarations, and the creation of operators.

Mapping files and programs declare the same operators with the same options, and both are checked here.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, NamedTuple

from jacaros.streams.aggregates import Extreme, Mean, Slope
from jacaros.streams.condition import ANYTHING, Condition
from jacaros.streams.counting import Count
from jacaros.streams.operator import Emit, Operator
from jacaros.streams.order import Absent, Chain
from jacaros.streams.states import Held, Hysteresis
from jacaros.streams.together import Together
from jacaros.suggestions import suggestion

LONGEST: Final = 86_400.0
"""Maximum duration in seconds of a window, or of waiting for late events: the window bounds memory."""

STATE, VALUE, OCCURRENCE = "state", "value", "occurrence"
"""Kinds of output: a state without values, a state with values, or an occurrence."""


@dataclass(frozen=True, slots=True)
class Spec:
    """A declaration.

    Attributes:
        operator: name in `OPERATORS`.
        sources: streams by name, in the order of the declaration; a sequence may repeat a stream.
        options: times in seconds.
        place: index of the value of an event to use, from 0.
        lateness: seconds for which the evaluation waits for late events.
    """

    operator: str
    sources: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)
    place: int = 0
    lateness: float = 0.0

    @property
    def streams(self) -> tuple[str, ...]:
        """The streams without repetition; events carry the index of their stream."""
        return tuple(dict.fromkeys(self.sources))

    @property
    def gives(self) -> str:
        """Kind of output: `STATE`, `VALUE` or `OCCURRENCE`."""
        shape = OPERATORS[self.operator]
        return STATE if shape.gives == VALUE and shape.limits & self.options.keys() else shape.gives


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


@dataclass(frozen=True, slots=True)
class Shape:
    """The requirements of an operator.

    Attributes:
        meaning: short description.
        gives: `STATE`, `VALUE` or `OCCURRENCE`.
        required, optional: names of options.
        several: whether it takes a list of two or more streams.
        limits: options that turn the value into a state.
    """

    meaning: str
    gives: str
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    several: bool = False
    limits: frozenset[str] = frozenset()


_LIMITS = ("above", "below")
_CONDITION = ("above", "below", "equals")


def _aggregate(meaning: str) -> Shape:
    return Shape(meaning, VALUE, ("within",), _LIMITS, limits=frozenset(_LIMITS))


OPERATORS: Final[dict[str, Shape]] = {
    "count": Shape("events in a window", VALUE, ("within",), ("at_least",), limits=frozenset({"at_least"})),
    "mean": _aggregate("mean in a window"),
    "min": _aggregate("minimum in a window"),
    "max": _aggregate("maximum in a window"),
    "slope": _aggregate("slope in a window, per second"),
    "hysteresis": Shape(
        "on beyond one limit, off beyond another",
        STATE,
        (),
        ("on_above", "off_below", "on_below", "off_above"),
    ),
    "held": Shape("a condition has held for a while", STATE, ("for",), _CONDITION),
    "absent": Shape("no event for a while", STATE, ("for",)),
    "sequence": Shape("events in this order", OCCURRENCE, ("within",), several=True),
    "together": Shape("samples with stamps near each other", VALUE, ("within",), several=True),
}
"""All operators by name."""

PARTNERS_WAIT: Final = 0.5
"""Default lateness in seconds where samples of several topics are joined, because the delays of topics differ."""

VALUED: Final = frozenset({"mean", "min", "max", "slope", "hysteresis", "held"})
"""Operators that use one value of an event."""


def unknown(operator: str) -> Fault:
    """Return the error for an unknown operator."""
    help = suggestion(operator, OPERATORS, f"operators: {', '.join(OPERATORS)}")
    return Fault("", f"unknown operator `{operator}`", help)


def faults(operator: str, sources: Sequence[str], options: Mapping[str, object]) -> Iterator[Fault]:
    """Yield all errors of a declaration.

    Args:
        operator: a name of `OPERATORS`.
        sources: as in `Spec`.
        options: options as written, times in seconds.
    """
    shape = OPERATORS[operator]
    if shape.several and len(sources) < 2:
        yield Fault(
            "",
            f"`{operator}` needs two streams or more",
            "write them as a list, such as [press, release]",
        )
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
        elif (fault := _KINDS[name](name, value)) is not None:
            yield fault
    yield from _CHECKS.get(operator, _none)(options)


_NEEDED: Final = {
    "within": "give the length of the window, so that its memory is bounded",
    "for": "give the time that must pass",
}


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _seconds(name: str, value: object) -> Fault | None:
    if isinstance(value, float) and value == math.inf:
        return Fault(name, f"`{name}` is unbounded", "give a finite time: memory is bounded by the window")
    if not _is_number(value):
        return Fault(name, f"`{name}` must be a duration", "write a number above zero")
    assert isinstance(value, int | float)
    if value <= 0.0:
        return Fault(name, f"`{name}` must be above zero", "write a positive time")
    if value > LONGEST:
        return Fault(
            name, f"`{name}` is longer than a day", "give a shorter time: memory is bounded by the window"
        )
    return None


def _number(name: str, value: object) -> Fault | None:
    return (
        None if _is_number(value) else Fault(name, f"`{name}` must be a number", "write a number such as 0.5")
    )


def _positive(name: str, value: object) -> Fault | None:
    if _is_number(value) and isinstance(value, int | float) and value > 0.0:
        return None
    return Fault(name, f"`{name}` must be above zero", "write a positive number")


def _any(name: str, value: object) -> Fault | None:
    return None


_KINDS: Final[dict[str, Callable[[str, object], Fault | None]]] = {
    "within": _seconds,
    "for": _seconds,
    "above": _number,
    "below": _number,
    "equals": _any,
    "at_least": _positive,
    "on_above": _number,
    "off_below": _number,
    "on_below": _number,
    "off_above": _number,
}


def _none(options: Mapping[str, object]) -> Iterator[Fault]:
    yield from ()


def _check_count(options: Mapping[str, object]) -> Iterator[Fault]:
    wanted = options.get("at_least")
    if _is_number(wanted) and isinstance(wanted, int | float) and (wanted < 1 or wanted != int(wanted)):
        yield Fault("at_least", "`at_least` must be a whole number", "write a number such as 3")


def _check_hysteresis(options: Mapping[str, object]) -> Iterator[Fault]:
    pairs = [("on_above", "off_below"), ("on_below", "off_above")]
    given = [pair for pair in pairs if pair[0] in options and pair[1] in options]
    used = [name for pair in pairs for name in pair if name in options]
    if len(given) != 1 or len(used) != 2:
        yield Fault(
            "",
            "`hysteresis` needs two limits",
            "give `on_above` and `off_below`, or `on_below` and `off_above`",
        )
        return
    on, off = (options[name] for name in given[0])
    if not (_is_number(on) and _is_number(off)):
        return
    assert isinstance(on, int | float)
    assert isinstance(off, int | float)
    if (on < off) if given[0][0] == "on_above" else (on > off):
        name = given[0][1]
        side = "at most" if name == "off_below" else "at least"
        yield Fault(name, f"`{name}` must be {side} `{given[0][0]}`", "swap the two limits")


_CHECKS: Final[dict[str, Callable[[Mapping[str, object]], Iterator[Fault]]]] = {
    "count": _check_count,
    "hysteresis": _check_hysteresis,
}


def make(spec: Spec, emit: Emit) -> Operator:
    """Create the operator of a valid declaration."""
    return _MAKERS[spec.operator](spec, emit)


def _condition(spec: Spec) -> Condition:
    options = spec.options
    return Condition(options.get("above"), options.get("below"), options.get("equals", ANYTHING))


def _within(spec: Spec) -> float:
    return float(spec.options["within"])


def _make_count(spec: Spec, emit: Emit) -> Operator:
    wanted = spec.options.get("at_least")
    return Count(emit, _within(spec), int(wanted) if wanted is not None else None)


def _make_aggregate(kind: Callable[..., Operator], spec: Spec, emit: Emit) -> Operator:
    return kind(emit, _within(spec), spec.place, _condition(spec))


def _make_extreme(sign: float, spec: Spec, emit: Emit) -> Operator:
    return Extreme(emit, _within(spec), spec.place, _condition(spec), sign)


def _make_hysteresis(spec: Spec, emit: Emit) -> Operator:
    options = spec.options
    if "on_above" in options:
        return Hysteresis(emit, spec.place, options["on_above"], options["off_below"], True)
    return Hysteresis(emit, spec.place, options["on_below"], options["off_above"], False)


def _make_chain(spec: Spec, emit: Emit) -> Operator:
    streams = spec.streams
    return Chain(emit, [streams.index(each) for each in spec.sources], _within(spec))


_MAKERS: Final[dict[str, Callable[[Spec, Emit], Operator]]] = {
    "count": _make_count,
    "mean": partial(_make_aggregate, Mean),
    "slope": partial(_make_aggregate, Slope),
    "min": partial(_make_extreme, -1.0),
    "max": partial(_make_extreme, 1.0),
    "hysteresis": _make_hysteresis,
    "held": lambda spec, emit: Held(emit, float(spec.options["for"]), spec.place, _condition(spec)),
    "absent": lambda spec, emit: Absent(emit, float(spec.options["for"])),
    "sequence": _make_chain,
    "together": lambda spec, emit: Together(emit, len(spec.sources), _within(spec), spec.lateness),
}
