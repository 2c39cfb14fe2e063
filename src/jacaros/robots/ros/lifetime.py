"""The only owner of how a node joins its graph and how the process leaves it: zero velocity is the last message.

The exit hooks of a node stop its robots: each publishes zero or sends requests to cancel, nothing else. They run when
the backend is closed, at one of `SIGNALS`, and when the loop's thread or the interpreter ends (for instance
after an uncaught exception). No hook runs in a process that is killed (SIGKILL, power failure): a robot's base must
stop on its own when commands cease.

Hooks run on the loop, between two callbacks. Only if the loop does not run them within `PATIENCE` do they run in a
thread. From the first hook on, only hooks may publish; if a message was already on its way to the client library, the
hooks run again after it (`Lifetime.send`).
"""

import asyncio
import atexit
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType
from typing import Any, TypeVar

from jacaros.robots.ros.handoff import in_thread, post

SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name)
)
"""Signals that end a process; Windows has no SIGHUP, and only Windows has SIGBREAK (Ctrl+Break, a closed console)."""
PATIENCE = 0.2
"""Seconds that the loop has to run the hooks after a signal."""
LOOKING = 0.2
"""Seconds between two checks whether the loop's thread is alive."""
LONGEST_WAIT = 3.0
"""Maximum number of seconds by which sending the last messages may delay the end of the process."""

M = TypeVar("M")
Serve = Callable[[int, FrameType | None], None]


class Lifetime:
    """The life of one node.

    Args:
        log: called with one line about a failed hook.
        finish: blocks until the messages published so far are sent, and releases everything that would keep the
            process from ending. It runs on any thread, and must not touch the loop.
        insist: blocks until the last messages have arrived; called in a thread after a signal has stopped the robots,
            because the run may take long until it calls `leave`.
        threaded: run the hooks in a thread if the loop is stuck or its thread has ended. In the in-process graph
            robots and agents share the loop, so a thread could stop no robot.

    Attributes:
        leaving: whether the node is leaving its graph, or has left it: only exit hooks may publish.
    """

    def __init__(
        self,
        log: Callable[[str], None],
        finish: Callable[[], None] = lambda: None,
        threaded: bool = False,
        insist: Callable[[], None] = lambda: None,
    ) -> None:
        self.leaving = False
        self._gone = False
        """Whether the node has left its graph."""
        self.threaded = threaded
        self._log = log
        self._finish = finish
        self._insist = insist
        self._hooks: list[Callable[[], None]] = []
        self._hooking: set[int] = set()
        """Threads that are running the hooks."""
        self._reported = False
        # Not a lock of Python's: a second signal may raise an exception while it is held, and it would stay locked.
        self._stopped: queue.SimpleQueue[None] = queue.SimpleQueue()
        self._finishing = threading.Lock()
        self._finished = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: threading.Thread | None = None

    def join(self) -> None:
        """Store the running loop and its thread; from now on signals and the end of the thread stop the robots."""
        self._loop = asyncio.get_running_loop()
        self._thread = threading.current_thread()
        if self.threaded:
            _process.watch(self)

    def add(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Call *hook* when the process ends, possibly several times. Return a function that removes it.

        Args:
            hook: publishes, or sends requests to cancel. It may run in any thread, so it must not touch the loop.
        """
        self._hooks.append(hook)
        _process.watch(self)

        def remove() -> None:
            if hook in self._hooks:
                if self.leaving and not self._gone:
                    # The owner's own zero may have been refused, and the thread that stops the robots may be too
                    # late.
                    self._run([hook])
                self._hooks.remove(hook)

        return remove

    def admits(self) -> bool:
        """Return whether a message may be published: while the robots are being stopped, only by hooks.

        Otherwise a motion that has not noticed the end yet could move the robot again.
        """
        return not self.leaving or threading.get_ident() in self._hooking

    def send(self, send: Callable[[M], object], message: M) -> None:
        """Call *send* with *message* if that is allowed, and stop the robots again if they were stopped meanwhile.

        A signal or another thread may come between the check and the client library's own publishing. Without the
        second check the old velocity would follow the zero.
        """
        if self.leaving and not self.admits():
            return
        try:
            send(message)
        finally:
            if self.leaving and not self.admits():
                self._run_hooks()

    def stop(self) -> None:
        """Stop the robots: refuse all publishing except by the hooks, and run them on this thread."""
        if self._gone:
            return
        self.leaving = True
        self._run_hooks()
        self._stopped.put(None)

    def stop_soon(self) -> None:
        """Stop the robots in the next turn of the loop; callable in a signal handler."""
        self._reported = True
        if self._loop is None or not post(self._loop, self.stop):
            self.stop()

    async def leave(self) -> None:
        """Stop the robots, wait in a thread until the last messages are sent, and leave; on the loop."""
        self.stop()
        if self.threaded:
            await in_thread(asyncio.get_running_loop(), self._finish_once, "closing")
        self.left()

    def left(self) -> None:
        """Note that the node has left its graph; on the loop."""
        self.leaving = self._gone = True
        _process.unwatch(self)

    def stop_if_late(self, deadline: float) -> None:
        """Stop the robots here, in a thread, if the loop has not done so by *deadline* (monotonic)."""
        if self._reported:
            try:
                self._stopped.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                self.stop()
            else:
                self._stopped.put(None)  # for the next signal

    def insist(self) -> None:
        """Deliver the last messages after a signal; in a thread."""
        if self.leaving and not self._gone:
            self._insist()

    def leave_if_orphaned(self) -> None:
        """Leave, in a thread, if the loop's thread has ended without closing the node."""
        if self._thread is not None and not self._thread.is_alive():
            self.leave_now()

    def leave_now(self) -> None:
        """Stop the robots and leave without the loop, which no longer runs."""
        self.stop()
        self._finish_once()
        self.left()

    def _run_hooks(self) -> None:
        self._run(list(self._hooks))

    def _run(self, hooks: list[Callable[[], None]]) -> None:
        this = threading.get_ident()
        outermost = this not in self._hooking
        self._hooking.add(this)
        try:
            for hook in hooks:
                try:
                    hook()
                except Exception as problem:  # the next hook may stop another robot
                    self._log(f"an exit hook failed: {type(problem).__name__}: {problem}")
        finally:
            if outermost:
                self._hooking.discard(this)

    def _finish_once(self) -> None:
        if not self._finishing.acquire(timeout=LONGEST_WAIT):
            return
        try:
            if not self._finished:
                self._finished = True
                self._finish()
        finally:
            self._finishing.release()


class _Process:
    """The process's end: the only place that handles signals.

    A run of agents sets with `serving` what a signal does. Otherwise the previous handler decides: that of a program
    which embeds JaCaROS, or of Python.
    """

    def __init__(self) -> None:
        self._watched: list[Lifetime] = []
        self._serve: Serve | None = None
        self._previous: dict[int, Any] = {}
        self._at_exit = False
        self._signalled: queue.SimpleQueue[None] = queue.SimpleQueue()  # safe in a signal handler
        self._watcher: threading.Thread | None = None
        self._lock = threading.Lock()

    def watch(self, lifetime: Lifetime) -> None:
        """Stop the robots of *lifetime* at signals and at the end of the process; calling it again has no effect."""
        with self._lock:
            if lifetime not in self._watched:
                self._watched.append(lifetime)
            if lifetime.threaded and self._watcher is None:
                self._watcher = threading.Thread(target=self._watch, name="lifetime", daemon=True)
                self._watcher.start()
        if not self._at_exit:
            self._at_exit = True
            atexit.register(self._leave_all)
        self._take_signals()

    def unwatch(self, lifetime: Lifetime) -> None:
        with self._lock:
            if lifetime in self._watched:
                self._watched.remove(lifetime)
        self._give_signals_back()

    @contextmanager
    def serving(self, serve: Serve) -> Iterator[None]:
        """Call *serve* with each signal, after the robots were stopped; on the main thread only."""
        outer, self._serve = self._serve, serve
        # A handler may have replaced ours while a node stayed in its graph.
        self._take_signals(again=True)
        try:
            yield
        finally:
            self._serve = outer
            self._give_signals_back()

    def _take_signals(self, again: bool = False) -> None:
        if (self._previous and not again) or threading.current_thread() is not threading.main_thread():
            return
        for number in SIGNALS:
            before = signal.getsignal(number)
            # An ignored signal (nohup) stays ignored; a handler from outside Python (None) stays installed.
            if before not in (signal.SIG_IGN, None, self._at_signal):
                self._previous[number] = before
                signal.signal(number, self._at_signal)

    def _give_signals_back(self) -> None:
        if self._watched or self._serve is not None:
            return
        if threading.current_thread() is threading.main_thread():
            for number, before in self._previous.items():
                if signal.getsignal(number) == self._at_signal:
                    signal.signal(number, before)
            self._previous.clear()

    def _at_signal(self, number: int, frame: FrameType | None) -> None:
        for lifetime in list(self._watched):
            lifetime.stop_soon()
        self._signalled.put(None)
        before = self._previous.get(number, signal.SIG_DFL)
        if self._serve is not None:
            self._serve(number, frame)
        elif callable(before):
            before(number, frame)
        else:
            # As KeyboardInterrupt does for SIGINT: unwind, let `finally` run, then end the interpreter.
            sys.exit(128 + number)

    def _watch(self) -> None:
        """Make sure, in a thread, that robots stop if the loop is stuck or its thread has ended.

        The interpreter calls `atexit` functions only when all non-daemon threads have ended; a library with such a
        thread would keep a robot driving after an uncaught exception.
        """
        while True:
            try:
                self._signalled.get(timeout=LOOKING)
            except queue.Empty:
                for lifetime in self._threaded():
                    lifetime.leave_if_orphaned()
            else:
                deadline = time.monotonic() + PATIENCE
                for lifetime in self._threaded():
                    lifetime.stop_if_late(deadline)
                for lifetime in self._threaded():
                    lifetime.insist()
            with self._lock:
                if not any(lifetime.threaded for lifetime in self._watched):
                    self._watcher = None
                    return

    def _threaded(self) -> list[Lifetime]:
        with self._lock:
            return [lifetime for lifetime in self._watched if lifetime.threaded]

    def _leave_all(self) -> None:
        for lifetime in list(self._watched):
            lifetime.leave_now()


_process = _Process()


def serving(serve: Serve) -> AbstractContextManager[None]:
    """Call *serve* with each signal that ends a process, and the interrupted frame, after the robots were stopped.

    The result is a context manager for the main thread: entered before asyncio's runner begins, it keeps the runner
    from handling SIGINT itself.
    """
    return _process.serving(serve)
