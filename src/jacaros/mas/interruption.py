"""Ctrl+C, SIGTERM and SIGHUP end a run, whatever it is doing.

`jacaros.ros.lifetime` handles the signals: it stops the robots, then asks here.  The loop serves a signal between two
callbacks.  A step that never ends leaves it no turn; then the signal is raised in the middle of the step.
"""

import asyncio
import signal
import warnings
from collections.abc import Callable, Coroutine, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from types import FrameType
from typing import Any, NoReturn

from jacaros.ros import lifetime

PATIENCE = 0.3
"""Seconds that the loop has to serve a signal."""
CLOSING = 5.0
"""Seconds that may pass until everything is closed."""
THREADS = 1.0
"""Seconds that threads of operations have to come to their end when everything else is closed."""
AGAIN = 2.0
"""Seconds until an `Interrupted` that somebody swallowed is raised once more."""


class Interrupted(KeyboardInterrupt):
    """Raised in the middle of a step, or of whatever else leaves the loop no turn.

    A `KeyboardInterrupt`, because asyncio lets no other exception but `SystemExit` end a loop; what is open on the loop is
    closed after that.
    """


class Interruption:
    """How signals end a run.

    The first one lets the run end in good order as soon as the loop has a turn, and takes the turn by force after
    `PATIENCE`.  Another one takes it at once.

    Args:
        tell: takes a line for people.

    Attributes:
        exit_code: 128 and the number of the signal; 0 while there was none.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self.exit_code = 0
        self._tell = tell
        self._told = False
        self._ending = self._over = False
        self._end: Callable[[], object] | None = None
        self._alarm_before: Any = None

    def run(self, make_loop: Callable[[], asyncio.AbstractEventLoop], main: Coroutine[Any, Any, int]) -> int:
        """Run *main*, which says by `of` what signals end, on a new loop; the exit code."""
        try:
            with asyncio.Runner(loop_factory=make_loop) as runner:
                try:
                    return runner.run(main)
                except Interrupted:
                    # What is open on the loop is closed next, when the runner is.
                    self._arm(THREADS if self._ending else CLOSING)
                    return self.exit_code
        except Interrupted:
            return self.exit_code
        finally:
            self._over = True
            self._disarm()

    def signals(self) -> AbstractContextManager[None]:
        """Have signals end the run; entered on the main thread, around `run`."""
        return lifetime.serving(self._notice)

    @contextmanager
    def of(self, end: Callable[[int], None]) -> Iterator[None]:
        """Have signals call *end* with an exit code, on the running loop."""
        loop = asyncio.get_running_loop()

        def serve() -> None:
            self._ending = True
            self._arm(CLOSING)
            end(self.exit_code)

        self._end = partial(loop.call_soon_threadsafe, serve)
        try:
            yield
        finally:
            if self.exit_code:
                self._arm(THREADS)

    def _notice(self, number: int, frame: FrameType | None) -> None:
        """Take a signal, in its handler."""
        if self._over:
            return  # nothing is left to interrupt
        again, self.exit_code = self.exit_code != 0, 128 + number
        if again or self._end is None:
            self._interrupt(number, frame)
        self._end()
        self._arm(PATIENCE)

    def _arm(self, patience: float) -> None:
        if not hasattr(signal, "setitimer"):
            return
        if self._alarm_before is None:
            before = signal.signal(signal.SIGALRM, self._interrupt)
            self._alarm_before = signal.SIG_DFL if before is None else before
        signal.setitimer(signal.ITIMER_REAL, patience, AGAIN)

    def _disarm(self) -> None:
        if self._alarm_before is not None:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, self._alarm_before)

    def _interrupt(self, number: int, frame: FrameType | None) -> NoReturn:
        del number
        if not self._told:
            from jacaros.mas.at_work import at_work, task_of  # here: most runs end without it

            self._told = True
            if task_of(frame) is not None:
                self._tell(f"interrupted in the middle of a step: {at_work(frame)}")
            elif (
                self._ending
            ):  # else what was interrupted is an import, as at the start: nothing is left behind
                self._tell("the run has ended; an operation that does not end is left behind")
        # The exception may hit between the making of a coroutine and its first step; the process ends anyway.
        warnings.filterwarnings("ignore", "coroutine .* was never awaited", RuntimeWarning)
        raise Interrupted
