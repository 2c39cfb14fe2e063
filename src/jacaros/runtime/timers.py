"""A queue of timers ordered by time, used by every clock of a run."""

import heapq
import math
from collections.abc import Callable, Sequence

COMPACT_ABOVE = 100
"""Cancelled timers that a queue may hold before it looks whether they are more than half of all."""


class Timer:
    """A call at a moment.

    Attributes:
        when: the moment, in seconds of the clock.
    """

    __slots__ = ("_queue", "callback", "when")

    def __init__(self, when: float, callback: Callable[[], None], queue: "TimerQueue") -> None:
        self.when = when
        self.callback: Callable[[], None] | None = callback
        self._queue = queue

    def cancel(self) -> None:
        """Cancel the call; no effect once it has been made."""
        if self.callback is not None:
            self.callback = None  # what it holds may be large, and the moment far
            self._queue.note_cancelled()

    def ring(self) -> None:
        """Make the call, unless it was cancelled or made."""
        callback, self.callback = self.callback, None
        if callback is not None:
            callback()


_Entry = tuple[float, int, Timer]
"""A moment, a number that no other timer has, and the timer: tuples compare without calling Python functions."""


class TimerQueue:
    """The pending timers of a clock, earliest first; equal moments keep the order in which they were set.

    Attributes:
        newest: number of the timer that was set last.
    """

    __slots__ = ("_cancelled", "_heap", "newest")

    def __init__(self) -> None:
        self._heap: list[_Entry] = []
        self.newest = self._cancelled = 0

    def __len__(self) -> int:
        return len(self._heap)

    def add(self, when: float, callback: Callable[[], None]) -> Timer:
        """Set a timer."""
        self.newest += 1
        timer = Timer(when, callback, self)
        heapq.heappush(self._heap, (when, self.newest, timer))
        return timer

    def first_moment(self) -> float | None:
        """The moment of the earliest timer; None without one."""
        heap = self._heap
        while heap and heap[0][2].callback is None:
            heapq.heappop(heap)
        return heap[0][0] if heap else None

    def next_due(self, moment: float, newest: float = math.inf) -> Timer | None:
        """Remove and return the earliest timer that is due at *moment*; None if none is, or if it is newer."""
        heap = self._heap
        while heap and heap[0][0] <= moment and heap[0][1] <= newest:
            timer = heapq.heappop(heap)[2]
            if timer.callback is not None:
                return timer
        return None

    def pending(self) -> Sequence[Timer]:
        """The pending timers, in no order."""
        return [timer for _, _, timer in self._heap if timer.callback is not None]

    def note_cancelled(self) -> None:
        """Count a timer that was cancelled; drop cancelled ones when they are many."""
        self._cancelled += 1
        if self._cancelled > COMPACT_ABOVE and 2 * self._cancelled > len(self._heap):
            self._heap = [entry for entry in self._heap if entry[2].callback is not None]
            heapq.heapify(self._heap)
            self._cancelled = 0
