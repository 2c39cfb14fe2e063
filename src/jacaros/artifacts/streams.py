"""Events composed of events: incremental operators over timestamped streams.

docs/reference/derived_events.md defines them. Nothing here has a clock: the host passes times, and calls `Pattern.advance`
at `Pattern.deadline`.
"""

import math
from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from jacaros.runtime.files.texts import suggestion

# What is declared about streams, as data: which readings are delivered, and which events are derived.
#
# A `ReadingPolicy` and a `Spec` are plain values: `jacaros.robots.kit.reading` and `Pattern` follow them.

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


class DeclarationProblem(NamedTuple):
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


def unknown(operator: str) -> DeclarationProblem:
    """Return the error for an unknown operator."""
    help = suggestion(operator, OPERATORS, f"operators: {', '.join(OPERATORS)}")
    return DeclarationProblem("", f"unknown operator `{operator}`", help)


def faults(operator: str, sources: Sequence[str], options: Mapping[str, Any]) -> Iterator[DeclarationProblem]:
    """Yield all errors of a declaration.

    Args:
        operator: a name of `OPERATORS`.
        sources: as in `Spec`.
        options: options as written, times in seconds.
    """
    shape = OPERATORS[operator]
    if operator == "together" and len(sources) < 2:
        help = "write them as a list, such as [scan, pose]"
        yield DeclarationProblem("", f"`{operator}` needs two streams or more", help)
    if operator == "together" and len(set(sources)) < len(sources):
        yield DeclarationProblem("", f"`{operator}` names a stream twice", "name each stream once")
    known = (*shape.required, *shape.optional)
    for name in shape.required:
        if name not in options:
            yield DeclarationProblem("", f"`{operator}` needs `{name}`", _NEEDED[name])
    for name, value in options.items():
        if name not in known:
            help = suggestion(name, known, f"options: {', '.join(known)}")
            yield DeclarationProblem(name, f"`{operator}` has no option `{name}`", help)
        elif wrong := _OPTIONS.get(name, _number)(value):
            yield DeclarationProblem(name, f"`{name}` {wrong[0]}", wrong[1])
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


def _wrong_limits(options: Mapping[str, Any]) -> Iterator[DeclarationProblem]:
    used = [name for name in _ON_AND_OFF if name in options]
    if used not in (["on_above", "off_below"], ["on_below", "off_above"]):
        help = "give `on_above` and `off_below`, or `on_below` and `off_above`"
        yield DeclarationProblem("", "`hysteresis` needs two limits", help)
        return
    on, off = options[used[0]], options[used[1]]
    if _is_number(on) and _is_number(off) and (on < off if used[0] == "on_above" else on > off):
        side = "at most" if used[0] == "on_above" else "at least"
        yield DeclarationProblem(used[1], f"`{used[1]}` must be {side} `{used[0]}`", "swap the two limits")


SHOW, HIDE = "show", "hide"
"""Kinds of output: the derived state begins or changes its values; it ends."""

Emit = Callable[[str, Values], None]
"""Takes the kind of an output and its values (empty for `HIDE`)."""


class StreamOperator:
    """Takes events in time order and emits their consequences.

    The pattern calls `advance` at each deadline before it passes a later event.

    Args:
        emit: takes the outputs.

    Attributes:
        ordered: whether events must arrive in time order; otherwise the operator orders them itself.
        deadline: time in seconds at which the output may change without an event; infinite for never.
        shown: values of the current state, None without one.
    """

    ordered = True

    __slots__ = ("_emit", "deadline", "shown")

    def __init__(self, emit: Emit) -> None:
        self._emit = emit
        self.deadline = math.inf
        self.shown: Values | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream.
            time: seconds since the start of the pattern.
            values: values of the event; None if the state shown by the stream ended.
        """
        raise NotImplementedError

    def advance(self, time: float) -> None:
        """Advance to *time*, at which `deadline` is reached."""
        raise NotImplementedError

    def show(self, values: Values) -> None:
        """Emit that the state holds with *values*, unless it already does."""
        if values != self.shown:
            self.shown = values
            self._emit(SHOW, values)

    def hide(self) -> None:
        """Emit that the state ended, if it held."""
        if self.shown is not None:
            self.shown = None
            self._emit(HIDE, ())


def number_at(values: Values | None, place: int) -> float | None:
    """Return the finite number at *place*; None otherwise."""
    if values is None or place >= len(values):
        return None
    value = values[place]
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


# Conditions on one value.


ANYTHING: Final = object()
"""Marks that no value is required."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A condition on a value; all given parts must hold.

    Attributes:
        above, below: exclusive limits; None for no limit.
        equals: required value.
    """

    above: float | None = None
    below: float | None = None
    equals: object = ANYTHING

    @property
    def is_open(self) -> bool:
        """Whether every value satisfies the condition."""
        return self.above is None and self.below is None and self.equals is ANYTHING

    def holds(self, value: object) -> bool:
        """Return whether *value* satisfies the condition; values that are not numbers never exceed a limit."""
        if self.equals is not ANYTHING and value != self.equals:
            return False
        if self.above is None and self.below is None:
            return True
        if not isinstance(value, int | float):
            return False
        return (self.above is None or value > self.above) and (self.below is None or value < self.below)


# The number of events in a sliding window.


class Count(StreamOperator):
    """The number of events in the window.

    Args:
        within: length of the window, in seconds.
        at_least: show a state while there are that many events; None to show the number.
    """

    __slots__ = ("_at_least", "_times", "_within")

    def __init__(self, emit: Emit, within: float, at_least: int | None) -> None:
        super().__init__(emit)
        self._within, self._at_least = within, at_least
        self._times: deque[float] = deque()

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            return
        times = self._times
        times.append(time)
        if self._at_least is not None and len(times) > self._at_least:
            times.popleft()  # only the newest events decide whether there are enough
        self._look(time)

    def advance(self, time: float) -> None:
        self._look(time)

    def _look(self, time: float) -> None:
        times, within = self._times, self._within
        while times and times[0] + within <= time:
            times.popleft()
        self.deadline = times[0] + within if times else math.inf
        if self._at_least is not None:
            enough = len(times) >= self._at_least
            self.show(()) if enough else self.hide()
        elif times:
            self.show((len(times),))
        else:
            self.hide()


# States of one stream: hysteresis, and a condition held for a while.


class Hysteresis(StreamOperator):
    """Starts when the number passes one limit and ends when it passes another.

    Args:
        place: index of the value of an event to use, from 0.
        on, off: limits.
        rising: the state starts above *on* and ends below *off*; otherwise it starts below and ends above.
    """

    __slots__ = ("_off", "_on", "_place", "_sign")

    def __init__(self, emit: Emit, place: int, on: float, off: float, rising: bool) -> None:
        super().__init__(emit)
        self._place = place
        self._sign = 1.0 if rising else -1.0
        self._on, self._off = self._sign * on, self._sign * off

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self.hide()
            return
        value = number_at(values, self._place)
        if value is None:
            return
        if self._sign * value > self._on:
            self.show(())
        elif self._sign * value < self._off:
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf


class Held(StreamOperator):
    """Holds once the condition has held for *lasting* seconds without a break."""

    __slots__ = ("_condition", "_lasting", "_place", "_since")

    def __init__(self, emit: Emit, lasting: float, place: int, condition: Condition) -> None:
        super().__init__(emit)
        self._lasting, self._place, self._condition = lasting, place, condition
        self._since: float | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        if not _satisfies(values, self._place, self._condition):
            self._since, self.deadline = None, math.inf
            self.hide()
        elif self._since is None:
            self._since, self.deadline = time, time + self._lasting

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.show(())


def _satisfies(values: Values | None, place: int, condition: Condition) -> bool:
    """Return whether the stream shows something, and its value at *place* satisfies the condition."""
    if values is None:
        return False
    return condition.is_open or (place < len(values) and condition.holds(values[place]))


# The absence of events.


class Absent(StreamOperator):
    """Holds while the newest event, or the start of the pattern, is *lasting* seconds or longer ago."""

    __slots__ = ("_lasting",)

    def __init__(self, emit: Emit, lasting: float) -> None:
        super().__init__(emit)
        self._lasting = lasting
        self.deadline = lasting

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is not None:
            self.deadline = time + self._lasting
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.show(())


# Join samples of several streams with nearby stamps, like ApproximateTime of message_filters.


class Together(StreamOperator):
    """Shows the values of one sample of each stream, concatenated, if their times are close enough.

    A set is formed as soon as possible, from the new sample and the nearest ones of the other streams. No sample is used
    twice, nor after a newer one of its stream. The samples of each stream are kept in time order, for as long as a
    partner may arrive.

    Args:
        count: number of streams.
        within: maximum seconds between the first and the last sample of a set.
        lateness: further seconds for which a sample waits for those of other streams.
    """

    ordered = False

    __slots__ = ("_newest", "_retention", "_times", "_used", "_values", "_within", "dropped")

    def __init__(self, emit: Emit, count: int, within: float, lateness: float) -> None:
        super().__init__(emit)
        self._within, self._retention = within, within + lateness
        self._times: list[list[float]] = [[] for _ in range(count)]
        self._values: list[list[Values]] = [[] for _ in range(count)]
        self._used = [-math.inf] * count
        self._newest = -math.inf
        self.dropped = 0

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self._times[source].clear()
            self._values[source].clear()
            self.hide()
            return
        if time <= self._used[source] or time < self._newest - self._retention:
            self.dropped += 1
            return
        place = bisect_right(self._times[source], time)
        self._times[source].insert(place, time)
        self._values[source].insert(place, values)
        if time > self._newest:
            self._newest = time
            self._forget()
        chosen = self._nearest(source, place, time)
        if chosen is not None:
            self._join(chosen)

    def advance(self, time: float) -> None:
        self.deadline = math.inf

    def _join(self, chosen: list[int]) -> None:
        """Show a set of samples: they and earlier ones are not used again."""
        made: list[object] = []
        for number, place in enumerate(chosen):
            times, values = self._times[number], self._values[number]
            made += values[place]
            self._used[number] = times[place]
            del times[: place + 1], values[: place + 1]
        self.show(tuple(made))

    def _nearest(self, source: int, place: int, time: float) -> list[int] | None:
        """Return the index of one sample in each stream; None unless they are close enough."""
        chosen: list[int] = []
        first = last = time
        for number, times in enumerate(self._times):
            found = place if number == source else _nearest_to(times, time)
            if found is None:
                return None
            chosen.append(found)
            first, last = min(first, times[found]), max(last, times[found])
        return chosen if last - first <= self._within else None

    def _forget(self) -> None:
        oldest = self._newest - self._retention
        for times, values in zip(self._times, self._values, strict=True):
            if times and times[0] < oldest:
                count = bisect_left(times, oldest)
                del times[:count], values[:count]


def _nearest_to(times: list[float], time: float) -> int | None:
    """Return the index of the time nearest to *time*, the earlier of two; None without times."""
    if not times:
        return None
    place = bisect_left(times, time)
    if place == len(times) or (place and time - times[place - 1] <= times[place] - time):
        return place - 1
    return place


# One derived event: takes events of its streams, and drives its operator.


def _operator(spec: Spec, emit: Emit) -> StreamOperator:
    options = spec.options
    match spec.operator:
        case "count":
            wanted = options.get("at_least")
            return Count(emit, spec.seconds("within"), int(wanted) if wanted is not None else None)
        case "hysteresis":
            above = "on_above" in options
            limits = ("on_above", "off_below") if above else ("on_below", "off_above")
            return Hysteresis(emit, spec.place, options[limits[0]], options[limits[1]], above)
        case "held":
            condition = Condition(options.get("above"), options.get("below"), options.get("equals", ANYTHING))
            return Held(emit, spec.seconds("for"), spec.place, condition)
        case "absent":
            return Absent(emit, spec.seconds("for"))
    return Together(emit, len(spec.sources), spec.seconds("within"), spec.lateness)


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
        self._operator = _operator(spec, emit)
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
