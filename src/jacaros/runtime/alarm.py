"""An alarm that interrupts the main thread in the middle of whatever Python code it executes.

POSIX has SIGALRM and a timer of the system.  On Windows a thread pretends that SIGILL has arrived, which nothing else
sends there: what waits in the system, or computes in C, is interrupted when it returns.
"""

import _thread
import signal
import sys
import time
from collections.abc import Callable
from types import FrameType
from typing import Any

if sys.platform == "win32":
    SIGNAL = signal.SIGILL
else:
    SIGNAL = signal.SIGALRM


class Alarm:
    """One alarm, for the main thread only.

    Args:
        ring: called as a signal handler; what it raises is raised in the middle of the main thread's code.
    """

    def __init__(self, ring: Callable[[int, FrameType | None], object]) -> None:
        self._ring = ring
        self._armed = False
        self._before: Any = None
        self._rest = 0.0
        """Seconds that were left of another timer."""
        self._turn = 0

    def set(self, seconds: float, again: float = 0.0) -> None:
        """Ring in *seconds*, and then every *again* seconds unless that is 0; what was set before is replaced.

        It may be called in a signal handler.
        """
        if not self._armed:
            self._armed = True
            before = signal.signal(SIGNAL, self._ring)
            self._before = signal.SIG_DFL if before is None else before
            if sys.platform != "win32":
                self._rest = signal.getitimer(signal.ITIMER_REAL)[0]
        self._turn += 1
        if sys.platform == "win32":
            # Without the locks of `threading`: the handler may have interrupted code that holds them.
            _thread.start_new_thread(self._wait, (self._turn, seconds, again))
        else:
            signal.setitimer(signal.ITIMER_REAL, seconds, again)

    def cancel(self) -> None:
        """Stop ringing, and restore the handler of the signal."""
        if not self._armed:
            return
        self._turn += 1
        if sys.platform != "win32":
            signal.setitimer(signal.ITIMER_REAL, self._rest)
        signal.signal(SIGNAL, self._before)
        self._armed = False

    def _wait(self, turn: int, seconds: float, again: float) -> None:
        time.sleep(seconds)
        while self._turn == turn:
            _thread.interrupt_main(SIGNAL)
            if not again:
                return
            time.sleep(again)
