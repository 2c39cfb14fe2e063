"""What is declared about streams, as data: which readings are delivered, and which events are derived.

A `ReadingPolicy` and a `Spec` are plain values: `jacaros.artifacts.kit.reading` and `pattern` follow them.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from jacaros.files.texts import suggestion

Values = tuple[object, ...]


@dataclass(frozen=True, slots=True)
class ReadingPolicy:
    """When values are delivered.

    Attributes:
        on_demand: only on request, by `Reading.passed`.
        rate: updates per second at most; None: no limit.
        dead_band: a value is delivered if a number differs by more than this from the one delivered before; one
            number for all fields or one for each. 0 drops equal values only.
        latest_only: while observers have not processed the previous value, nothing is delivered; then the newest is.
            For states, such as poses; not for messages that all count.
        expire: seconds without a message after which values are withdrawn; None: never.
        finite: refuse messages with NaN or an infinite number.
    """

    on_demand: bool = False
    rate: float | None = None
    dead_band: float | tuple[float, ...] = 0.0
    latest_only: bool = False
    expire: float | None = None
    finite: bool = True

    @classmethod
    def from_options(
        cls, options: Mapping[str, object], on_demand: bool = False, latest_only: bool = True
    ) -> "ReadingPolicy":
        """Make the policy from `READING_OPTIONS`; *on_demand* and *latest_only* are the defaults."""
        mode = options.get("mode", "on_demand" if on_demand else "verbose")
        rate, band = options.get("rate"), options.get("dead_band", 0.0)
        expire = options.get("expire")
        assert rate is None or isinstance(rate, float)
        assert expire is None or isinstance(expire, float)
        assert isinstance(band, float | tuple)
        return cls(mode == "on_demand", rate, band, bool(options.get("latest_only", latest_only)), expire)

    def differ(self, old: Values, new: Values) -> bool:
        """Return whether *new* differs enough from *old* to be delivered."""
        if old == new:
            return False
        if self.dead_band == 0.0 and self.finite:
            return True
        if len(old) != len(new):
            return True
        for index, value in enumerate(new):  # noqa: SIM110 - most differ in the first field: no generator for that
            if self._field_differs(index, old[index], value):
                return True
        return False

    def _field_differs(self, index: int, old: object, new: object) -> bool:
        if isinstance(old, int | float) and isinstance(new, int | float):
            return abs(new - old) > self._band(index) or math.isnan(old) != math.isnan(new)
        return old != new

    def _band(self, index: int) -> float:
        if isinstance(self.dead_band, tuple):
            return self.dead_band[index] if index < len(self.dead_band) else 0.0
        return self.dead_band


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


@dataclass(frozen=True, slots=True)
class Shape:
    """An operator and its requirements.

    Attributes:
        meaning: short description.
        gives: `STATE` or `VALUE`.
        required, optional: names of options.
        valued: whether it uses one value of an event.
    """

    meaning: str
    gives: str
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    valued: bool = False


_ON_AND_OFF = ("on_above", "off_below", "on_below", "off_above")
_CONDITION = ("above", "below", "equals")

OPERATORS: Final[dict[str, Shape]] = {
    "count": Shape("events in a window", VALUE, ("within",), ("at_least",)),
    "hysteresis": Shape("on beyond one limit, off beyond another", STATE, (), _ON_AND_OFF, valued=True),
    "held": Shape("a condition has held for a while", STATE, ("for",), _CONDITION, valued=True),
    "absent": Shape("no event for a while", STATE, ("for",)),
    "together": Shape("samples with stamps near each other", VALUE, ("within",)),
}
"""All operators by name: to add one, add a line here, its options to `_OPTIONS`, and a case to `pattern`."""

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
