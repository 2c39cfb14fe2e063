"""Numbered odometry messages, sent in turn, and the time until each returns as a command."""

import statistics
from collections.abc import Callable, Sequence

COUNT = 600
WARM_UP = 100
PERIOD = 0.01
"""Seconds between two messages: a sensor with 100 Hz."""

PATIENCE = 1.0
"""Seconds after which a message counts as lost."""

SECONDS = 3.0
"""Duration in seconds for which each way is measured flat out."""

WAYS = ("agent", "bare")
"""Through the agent's plan, or through an echo written with the client library alone."""


class Pings:
    """Which message goes next, by which way, and what has come back.

    The two ways take turns, so that whatever else the machine does meets both.

    Args:
        now: seconds of a steady clock.
        send: publishes an odometry message with a number on the way's topic.
        ways: the ways to measure.
        count: messages that count, for each way.
        warm_up: messages before these, for each way.
        patience: seconds after which a message counts as lost.
    """

    def __init__(
        self,
        now: Callable[[], float],
        send: Callable[[str, float], None],
        ways: Sequence[str] = WAYS,
        count: int = COUNT,
        warm_up: int = WARM_UP,
        patience: float = PATIENCE,
    ) -> None:
        self._now, self._send, self._ways = now, send, ways
        self._count, self._warm_up, self._patience = count, warm_up, patience
        self._sent: dict[str, tuple[float, float]] = {}
        self._number = 0
        self.times: dict[str, list[float]] = {way: [] for way in ways}
        self.lost = 0

    @property
    def over(self) -> bool:
        """Whether enough messages have been sent."""
        return self._number >= len(self._ways) * (self._count + self._warm_up)

    @property
    def under_way(self) -> bool:
        """Whether a message is still awaited; one that does not return in time counts as lost."""
        for way, (_, began) in list(self._sent.items()):
            if self._now() - began < self._patience:
                return True
            self.lost += 1
            del self._sent[way]
        return False

    def next(self, moment: float | None = None) -> None:
        """Send the next message, unless the last one is still awaited.

        Args:
            moment: when the message began, in seconds of the clock; now by default.
        """
        if self.under_way:
            return
        self._number += 1
        way = self._ways[self._number % len(self._ways)]
        self._sent[way] = (float(self._number), self._now() if moment is None else moment)
        self._send(way, float(self._number))

    def returned(self, way: str, number: float) -> None:
        """Receive a command; commands for earlier messages do not count."""
        arrived = self._now()
        sent = self._sent.get(way)
        if sent is not None and sent[0] == number:
            del self._sent[way]
            if self._number > len(self._ways) * self._warm_up:
                self.times[way].append(arrived - sent[1])

    def report(self, kind: str) -> str:
        """Return two lines of text."""
        lines = []
        for way in self._ways:
            times = sorted(self.times[way])
            if not times:
                lines.append(f"{kind:8} {way:6} nothing came back")
                continue
            figures = (statistics.median(times), times[int(0.9 * len(times))], times[int(0.99 * len(times))])
            texts = "  ".join(
                f"{name} {1000 * figure:6.2f} ms"
                for name, figure in zip(("median", "90 %", "99 %"), figures, strict=True)
            )
            lines.append(f"{kind:8} {way:6} {texts}   ({len(times)} messages)")
        if self.lost:
            lines.append(f"{kind:8} {self.lost} messages lost")
        return "\n".join(lines)


class FlatOut:
    """Sends the next message as soon as the last one has returned: messages per second, for each way in turn.

    Args:
        now: seconds of a steady clock.
        send: publishes an odometry message with a number on the way's topic.
    """

    def __init__(self, now: Callable[[], float], send: Callable[[str, float], None]) -> None:
        self._now, self._send = now, send
        self._ways = list(WAYS)
        self._number = 1e6
        self._began: float | None = None
        self._sent = 0.0
        self._back = 0
        self.rates: dict[str, float] = {}

    @property
    def over(self) -> bool:
        """Whether all ways have been measured."""
        return not self._ways

    def next(self) -> None:
        """Switch to the next way when it is time; call it regularly."""
        if self.over:
            return
        now = self._now()
        if self._began is None:
            self._began, self._back = now, 0
            self._go(now)
        elif now - self._began >= SECONDS:
            self.rates[self._ways.pop(0)] = self._back / (now - self._began)
            self._began = None
        elif now - self._sent > PATIENCE:
            self._go(now)

    def returned(self, way: str, number: float) -> None:
        """Receive a command, and send the next message immediately."""
        if self._began is not None and self._ways and way == self._ways[0] and number == self._number:
            self._back += 1
            now = self._now()
            if now - self._began < SECONDS:
                self._go(now)

    def _go(self, now: float) -> None:
        self._number += 1
        self._sent = now
        self._send(self._ways[0], self._number)

    def report(self, kind: str) -> str:
        """Return two lines of text."""
        return "\n".join(f"{kind:8} {way:6} flat out {self.rates[way]:8.0f} a second" for way in WAYS)


def measurement(
    now: Callable[[], float], send: Callable[[str, float], None], busy: bool
) -> "Pings | Measurement":
    """Return what to measure: next to a busy load only the latency."""
    return Pings(now, send) if busy else Measurement(now, send)


class Measurement:
    """Latency at the rate of a sensor, then the rate flat out; used like each of them."""

    def __init__(self, now: Callable[[], float], send: Callable[[str, float], None]) -> None:
        self.pings, self.flat_out = Pings(now, send), FlatOut(now, send)

    @property
    def _phase(self) -> Pings | FlatOut:
        return self.flat_out if self.pings.over else self.pings

    @property
    def over(self) -> bool:
        """Whether everything is measured."""
        return self.pings.over and self.flat_out.over

    def next(self) -> None:
        """Called every `PERIOD`."""
        self._phase.next()

    def returned(self, way: str, number: float) -> None:
        """Receive a command."""
        self._phase.returned(way, number)

    def report(self, kind: str) -> str:
        """Return four lines of text."""
        return f"{self.pings.report(kind)}\n{self.flat_out.report(kind)}"
