"""Derived properties: messages of other properties go through a pattern of `jacaros.robots.streams`."""

from collections import deque
from functools import partial

from jacaros.robots.mapping.host import MappingHost
from jacaros.robots.mapping.properties import DerivedPart
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.streams import HIDE, SHOW, Pattern, Spec, Values
from jacaros.runtime.clock import Timer
from jacaros.runtime.files.texts import is_worth_a_line
from jacaros.runtime.trace import Cause

JUMP = 0.1
"""Seconds by which the clock must go back to count as a restart of time."""


class Derivation:
    """A derived property.

    It receives every message of its streams, before dead bands and rates apply.

    Args:
        host: the artifact.
        part: its declaration.
        spec: the pattern.
    """

    def __init__(self, host: MappingHost, part: DerivedPart, spec: Spec) -> None:
        self._host, self._part, self._spec = host, part, spec
        self._pending: deque[Values | None] = deque()
        self._shown: Values | None = None
        self._cause: Cause | None = None
        self._timer: Timer | None = None
        self._due = 0.0
        self._latest = host.clock.now()
        self._told_dropped = 0
        self._pattern = Pattern(spec, self._latest, self._emit)
        for number, name in enumerate(spec.sources):
            host.taps.setdefault(name, []).append(partial(self.hear, number))
        host.at_dispose(self.close)
        self._wait()

    def hear(self, stream: int, stamp: float, values: Values | None, cause: Cause | None) -> None:
        """Handle an event of one of the streams.

        Args:
            stream: its number.
            stamp: stamp of the message; 0: none. A future stamp counts as the present.
            values: values of the event; None if the property ended.
            cause: the cause of the event.
        """
        now = self._host.clock.now()
        if now < self._latest - JUMP:
            self._restart(now)
        time = min(stamp, now) if stamp > 0.0 else now
        self._latest, self._cause = now, cause
        self._pattern.take(stream, time, values)
        if self._pattern.dropped != self._told_dropped:
            self._tell_dropped()
        self._wait()

    def _restart(self, now: float) -> None:
        if self._pattern.shown is not None:
            self._emit(HIDE, ())
        self._pattern = Pattern(self._spec, now, self._emit)
        self._told_dropped = 0
        self.close()

    def _tell_dropped(self) -> None:
        before, self._told_dropped = self._told_dropped, self._pattern.dropped
        if is_worth_a_line(self._told_dropped, self._told_dropped - before):
            part = self._part
            message = f"{part.name}: {self._told_dropped} late messages dropped"
            help_ = "allow more time: lateness: 0.2"
            self._host.report_once((part.name, self._told_dropped), part.place, message, help_)

    def _emit(self, kind: str, values: Values) -> None:
        host, name = self._host, self._part.name
        self._pending.append(values if kind == SHOW else None)
        if len(self._pending) == 1:
            host.start(host.show_property, name, self.show, cause=self._cause)
        for tap in host.taps.get(name, ()):
            tap(self._latest, None if kind == HIDE else values, self._cause)

    def show(self) -> None:
        """Update the property within an operation."""
        host, name = self._host, self._part.name
        while self._pending:
            before, self._shown = self._shown, self._pending.popleft()
            if self._shown is None:
                if before is not None:
                    host.remove_property(name, *before)
            elif before is None:
                host.define_property(name, *self._shown)
            else:
                host.update_property(name, *self._shown)

    def _wait(self) -> None:
        """Set a timer for the pattern's next deadline; a timer that is earlier is kept."""
        due = self._pattern.deadline
        if self._timer is not None:
            if self._due <= due:
                return
            self._timer.cancel()
            self._timer = None
        if due != float("inf"):
            self._due = due
            self._timer = self._host.clock.call_later(max(0.0, due - self._host.clock.now()), self._ring)

    def _ring(self) -> None:
        self._timer = None
        now = max(self._host.clock.now(), self._due)
        if self._pattern.deadline <= now:
            self._latest, self._cause = now, None
            self._pattern.advance(now)
        self._wait()

    def close(self) -> None:
        """Cancel the timer."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


def stamp_of(message: object, latched: bool) -> float:
    """Return the stamp of a message, in seconds; 0 if it has none, or is latched and therefore old."""
    header = None if latched else getattr(message, "header", None)
    return to_seconds(header.stamp) if header is not None else 0.0
