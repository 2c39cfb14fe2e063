"""Ctrl-C and SIGTERM: they end a run at once, whatever it is doing.

The loop serves a signal between two callbacks.  A step that never ends leaves it no turn; then the signal is raised in the
middle of the step.
"""

import asyncio
import signal
import threading
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn

SIGNALS = (signal.SIGINT, signal.SIGTERM)
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
        self._ending = False
        self._before: dict[signal.Signals, Any] = {}

    def run(self, make_loop: Callable[[], asyncio.AbstractEventLoop], main: Coroutine[Any, Any, int]) -> int:
        """Run *main*, which says by `of` what signals end, on a new loop; the exit code."""
        outside = signal.getsignal(signal.SIGINT)
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
            if signal.SIGINT in self._before:
                # What `_take` found there was the runner's own, which is over.
                self._before[signal.SIGINT] = outside
            self._give_back()

    @contextmanager
    def of(self, end: Callable[[int], None]) -> Iterator[None]:
        """Have signals call *end* with an exit code, on the running loop."""
        loop = asyncio.get_running_loop()

        def serve() -> None:
            self._ending = True
            self._arm(CLOSING)
            end(self.exit_code)

        def notice(number: int, frame: FrameType | None) -> None:
            if self.exit_code:
                self._interrupt(number, frame)
            self.exit_code = 128 + number
            loop.call_soon_threadsafe(serve)
            self._arm(PATIENCE)

        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                self._take(number, notice)
        try:
            yield
        finally:
            if self.exit_code:
                self._arm(THREADS)

    def _take(self, number: signal.Signals, handler: Callable[[int, FrameType | None], None]) -> None:
        before = signal.getsignal(number)
        # An ignored signal (nohup) stays ignored; a handler from outside Python (None) stays in charge.
        if before not in (signal.SIG_IGN, None):
            self._before[number] = before
            signal.signal(number, handler)

    def _arm(self, patience: float) -> None:
        if not hasattr(signal, "setitimer"):
            return
        if signal.SIGALRM not in self._before:
            before = signal.signal(signal.SIGALRM, self._interrupt)
            self._before[signal.SIGALRM] = signal.SIG_DFL if before is None else before
        signal.setitimer(signal.ITIMER_REAL, patience, AGAIN)

    def _give_back(self) -> None:
        if hasattr(signal, "setitimer") and signal.SIGALRM in self._before:
            signal.setitimer(signal.ITIMER_REAL, 0)
        for number, before in self._before.items():
            signal.signal(number, before)

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
        raise Interrupted
