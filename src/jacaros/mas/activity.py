"""What a run waits for: the timers and operations of its agents."""

from collections.abc import Callable

from jacaros.bdi.architecture import Timer
from jacaros.clock import Clock


class Activity:
    """Counts what will give an agent something to do again.

    Worlds, batteries and the processes of artifacts do not count: they never end.
    """

    def __init__(self) -> None:
        self.pending = 0

    def begin(self) -> None:
        """Something has been begun."""
        self.pending += 1

    def end(self) -> None:
        """It is over, or was taken back."""
        self.pending -= 1


class AgentTimer:
    """A call that is to come, counted until it has come or was taken back."""

    __slots__ = ("_activity", "_callback", "_timer")

    def __init__(self, clock: Clock, activity: Activity, delay: float, callback: Callable[[], None]) -> None:
        self._activity = activity
        self._callback = callback
        activity.begin()
        self._timer: Timer | None = clock.call_later(delay, self._ring)

    def cancel(self) -> None:
        """Take the call back; nothing happens when it is past."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self._activity.end()

    def _ring(self) -> None:
        if self._timer is not None:
            self._timer = None
            self._activity.end()
            self._callback()
