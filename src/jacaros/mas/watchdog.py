"""Tells people of a step that takes so long that the others, and the robot, have to wait for it."""

import sys
import threading
from collections.abc import Callable
from types import FrameType

INTERVAL = 1.0
"""Seconds between two looks."""
LOOKS = 2
"""How often one and the same step must be met again."""


class Watchdog:
    """Looks from a thread of its own at what the thread that made it is doing.

    It asks nothing of the steps themselves, so it costs them nothing.

    Args:
        tell: takes a line for people; called on the watchdog's thread, because the other one has no time.
        interval: seconds between two looks.
    """

    def __init__(self, tell: Callable[[str], None], interval: float = INTERVAL) -> None:
        self._tell = tell
        self._interval = interval
        self._watched = threading.get_ident()
        self._end = threading.Event()
        self._task: FrameType | None = None
        self._met = 0
        self._told: set[str] = set()

    def start(self) -> None:
        """Begin to watch."""
        threading.Thread(target=self._watch, name="watchdog", daemon=True).start()

    def stop(self) -> None:
        """Look no more."""
        self._end.set()

    def _watch(self) -> None:
        from jacaros.mas.at_work import at_work, task_of  # here: short runs end before the first look

        while not self._end.wait(self._interval):
            frame = sys._current_frames().get(self._watched)
            if self._is_too_long(task_of(frame)):
                self._complain(at_work(frame))

    def _is_too_long(self, task: FrameType | None) -> bool:
        """Whether what is done now was done at the last looks too; *task* is its frame, which no other call can have."""
        self._met = self._met + 1 if task is not None and task is self._task else 0
        self._task = task
        return self._met == LOOKS

    def _complain(self, work: str) -> None:
        if work not in self._told:
            self._told.add(work)
            seconds = self._interval * LOOKS
            self._tell(
                f"warning: a step takes more than {seconds:g} seconds, and everybody waits for it: {work}"
            )
