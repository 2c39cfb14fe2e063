"""The last messages of a process: zero velocity on the wire, for whatever reason the process stops.

Hooks run when the backend is closed, at SIGINT, SIGTERM and SIGHUP, and when the loop's thread or the
interpreter ends (which an uncaught exception leads to).  They run once.  A process that is killed outright
(SIGKILL, power) cannot run
them: a robot's base must stop by itself when commands cease.
"""

import atexit
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
LONGEST_WAIT = 3.0
"""Seconds that the end of the process may be held up by hooks and by sending their messages."""


class ExitHooks:
    """The hooks of one backend.

    Signal handlers that were there before are called after the hooks.  Whoever installs one later takes the
    signal over and then closes the backend, which runs the hooks as well.

    Args:
        log: takes one line about a hook that failed.
        finish: blocks until the messages published so far are sent, and lets go of whatever else would keep
            the
            process from ending.
        threaded: run the hooks in a thread of their own when a signal comes.  The signal may have interrupted
            the main thread inside the client library, holding its locks, so the hooks cannot run there.
    """

    def __init__(self, log: Callable[[str], None], finish: Callable[[], None], threaded: bool) -> None:
        self._log = log
        self._finish = finish
        self._threaded = threaded
        self._hooks: list[Callable[[], None]] = []
        self._running = threading.Lock()
        self._runner: threading.Thread | None = None
        self.ran = False

    def add(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops; the result takes it back."""
        self._hooks.append(hook)
        _process.watch(self)

        def remove() -> None:
            if hook in self._hooks:
                self._hooks.remove(hook)

        return remove

    def watch_thread(self) -> None:
        """Run the hooks also when the calling thread, which is the loop's, ends.

        The interpreter calls what is registered with `atexit` only after all threads but daemons have
        ended; a library with such a thread would keep a robot driving after an uncaught exception.
        """
        thread = threading.current_thread()

        def wait() -> None:
            thread.join()
            self.run()

        threading.Thread(target=wait, name="exit hooks watch", daemon=True).start()
        _process.watch(self)

    def admits(self) -> bool:
        """Whether a message may still be published: after the first hook has begun, only by hooks.

        Otherwise a motion that has not noticed the end yet could send the robot off again.
        """
        return self._runner is None or self._runner is threading.current_thread()

    def run(self) -> None:
        """Run the hooks and send their messages, unless that was done; wait when it is under way."""
        if not self._running.acquire(timeout=LONGEST_WAIT):
            return
        try:
            if self.ran:
                return
            self.ran = True
            self._run_all()
        finally:
            self._running.release()
            _process.unwatch(self)

    def stop_watching(self) -> None:
        """Give the signals back; on the main thread, after `run`, which may have been on another."""
        _process.unwatch(self)

    def run_at_signal(self) -> None:
        """Run the hooks now, without waiting for locks that the interrupted thread may hold."""
        if self._threaded:
            threading.Thread(target=self.run, name="exit hooks", daemon=True).start()
        else:
            self.run()

    def _run_all(self) -> None:
        self._runner = threading.current_thread()
        for hook in list(self._hooks):
            try:
                hook()
            except Exception as problem:  # the next hook may stop another robot
                self._log(f"an exit hook failed: {type(problem).__name__}: {problem}")
        self._finish()


class _Process:
    """What the process notices of its own end, and whom it tells."""

    def __init__(self) -> None:
        self._watched: list[ExitHooks] = []
        self._previous: dict[signal.Signals, Any] = {}
        self._at_exit = False

    def watch(self, hooks: ExitHooks) -> None:
        if hooks not in self._watched:
            self._watched.append(hooks)
        if not self._at_exit:
            self._at_exit = True
            atexit.register(self._tell_at_exit)
        if not self._previous and threading.current_thread() is threading.main_thread():
            self._take_signals()

    def unwatch(self, hooks: ExitHooks) -> None:
        if hooks in self._watched:
            self._watched.remove(hooks)
        if not self._watched and threading.current_thread() is threading.main_thread():
            self._give_signals_back()

    def _take_signals(self) -> None:
        for number in SIGNALS:
            before = signal.getsignal(number)
            # An ignored signal (nohup) stays ignored; a handler from outside Python (None) stays in charge.
            if before not in (signal.SIG_IGN, None):
                self._previous[number] = before
                signal.signal(number, self._at_signal)

    def _give_signals_back(self) -> None:
        for number, before in self._previous.items():
            if signal.getsignal(number) == self._at_signal:
                signal.signal(number, before)
        self._previous.clear()

    def _at_signal(self, number: int, frame: FrameType | None) -> None:
        before = self._previous.get(signal.Signals(number), signal.SIG_DFL)
        for hooks in list(self._watched):
            hooks.run_at_signal()
        if callable(before):
            before(number, frame)
        else:
            # As KeyboardInterrupt does for SIGINT: unwind, let `finally` run, then the interpreter's end.
            sys.exit(128 + number)

    def _tell_at_exit(self) -> None:
        for hooks in list(self._watched):
            hooks.run()


_process = _Process()
