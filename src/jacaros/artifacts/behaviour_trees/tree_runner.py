"""Ticks a tree: on the run's clock, and as soon as something has happened."""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from types import FunctionType, MethodType, SimpleNamespace
from typing import Any

import py_trees.decorators
import py_trees.timers
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.trees import BehaviourTree

from jacaros.artifacts import Session
from jacaros.artifacts.behaviour_trees.act import Act
from jacaros.artifacts.behaviour_trees.behaviours import ArtifactBehaviour
from jacaros.artifacts.presence.presence import OperationObserver
from jacaros.runtime.clock import Clock

_ENDS = {Status.SUCCESS: "achieved", Status.FAILURE: "failed"}
CLOSEST = 0.01
"""Minimum number of seconds between two ticks: a tree whose own operations wake it must not block virtual time."""


class TreeRunner:
    """Ticks a tree: every `period`, and immediately when a focused artifact changes, a signal arrives or an operation
    of the tree ends.

    However it ends (the root is done, the task is cancelled, a behaviour raises an exception), running operations are
    cancelled, so that no robot keeps driving.

    Args:
        root: the root of a tree, or a ``BehaviourTree`` with its visitors and handlers.
        session: access to the environment; it focuses on the artifacts that the tree observes.
        period: maximum number of seconds of the run's clock between two ticks; None: tick only when something has
            happened.
        setup: further arguments of the behaviours' ``setup`` besides ``session``, such as a ``node`` for those of
            py_trees_ros.

    Attributes:
        tree: the ``BehaviourTree``.

    Raises:
        TypeError: *root* is neither a behaviour nor a tree, or *session* is not a session.
        ValueError: *period* is not positive.
    """

    def __init__(
        self,
        root: Behaviour | BehaviourTree,
        session: Session,
        *,
        period: float | None = 0.1,
        setup: Mapping[str, Any] | None = None,
    ) -> None:
        if not isinstance(root, (Behaviour, BehaviourTree)):
            raise TypeError(f"expected a root behaviour of py_trees, found {root!r}")
        if not isinstance(session, Session):
            raise TypeError(f"expected a Session, found {session!r}; a PythonAgent has one: self.session")
        if period is not None and not period > 0:
            raise ValueError(f"period: expected a positive number of seconds, found {period!r}")
        self.tree = root if isinstance(root, BehaviourTree) else BehaviourTree(root)
        self.session = session
        self.period = period
        self._setup: dict[str, Any] = {**(setup or {}), "session": session, "wake": self.wake}
        self._running = self._due = self._ends = False
        self._waiting: asyncio.Future[None] | None = None
        self._reported: dict[Behaviour, None] = {}

    async def run(self, forever: bool = False) -> Status:
        """Set the tree up and tick it until its root is done.

        Args:
            forever: continue after the root has succeeded or failed, as ``tick_tock`` does; then only `stop`, or
                cancelling the task, ends it.

        Returns:
            The status of the root: SUCCESS or FAILURE, or its status when `stop` was called.

        Raises:
            RuntimeError: it is already running.
            TypeError: a timer in the tree cannot follow the virtual clock (`follow`).
            Exception: an exception of the author's own behaviours.
        """
        if self._running:
            raise RuntimeError(f"the tree `{self.tree.root.name}` is already running")
        unbind = follow(self.session.clock, self.tree.root.iterate())
        self._running, self._ends, self._due = True, False, False
        off = (
            self.session.on_change(lambda _: self.wake()),
            self.session.on_signal(lambda _: self.wake()),
            unbind,
        )
        try:
            self.tree.setup(**self._setup)
            await self._tick(forever)
            return self.tree.root.status
        finally:
            self._running = False
            self._release()
            for each in off:
                each()

    def stop(self) -> None:
        """End `run` before the next tick; if called during a tick, after it."""
        self._ends = True
        self._interrupt()

    def wake(self) -> None:
        """Request a tick soon."""
        self._due = True
        self._interrupt()

    async def _tick(self, forever: bool) -> None:
        while not self._ends:
            self._due = False
            with self._observed():
                self.tree.tick()
            if self.tree.root.status is not Status.RUNNING and not forever:
                return
            if self.period is not None:
                self._due = False  # changes made by the tree itself wait for its next turn
            await self._wait(CLOSEST, for_news=False)
            await self._wait(None if self.period is None else self.period - CLOSEST, for_news=True)

    async def _wait(self, seconds: float | None, for_news: bool) -> None:
        """Wait until the time is over, news arrive (if they count), or the run must end."""
        over = seconds is not None and seconds <= 0

        def ring() -> None:
            nonlocal over
            over = True
            self._interrupt()

        timer = None if seconds is None else self.session.clock.call_later(seconds, ring)
        try:
            while not (over or self._ends or (for_news and self._due)):
                self._waiting = asyncio.get_running_loop().create_future()
                await self._waiting
        finally:
            self._waiting = None
            if timer is not None:
                timer.cancel()

    def _interrupt(self) -> None:
        if self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(None)

    def _release(self) -> None:
        """Cancel all running operations, whatever the author's behaviours do at their end."""
        behaviours = list(self.tree.root.iterate())
        for behaviour in behaviours:
            if isinstance(behaviour, ArtifactBehaviour):
                behaviour.let_go()
        try:
            for behaviour in behaviours:
                # Not only the root: if a tick is interrupted, the parents do not know yet which children run.
                if behaviour.status is Status.RUNNING:
                    behaviour.stop(Status.INVALID)
        finally:
            if self.session.observer is not None:
                self._report(self.session.observer)
            self.tree.shutdown()

    @contextmanager
    def _observed(self) -> Iterator[None]:
        """Around a tick: report the behaviours to the session's observer before the operations that they start."""
        report = self.session.observer
        if report is None:
            yield
            return
        told: list[tuple[str, str, object, str]] = []
        self.session.observer = lambda *news: told.append(news)
        try:
            yield
        finally:
            self.session.observer = report
            self._report(report)
            for news in told:
                report(*news)

    def _report(self, report: OperationObserver) -> None:
        """Report which behaviours run now, and how those ended that ran before."""
        before, self._reported = self._reported, {}
        for behaviour in reversed(list(self.tree.root.iterate())):  # parents come before their children
            # The session reports operations, with their arguments and reasons.
            if behaviour.status is Status.RUNNING and not isinstance(behaviour, Act):
                self._reported[behaviour] = None
        for behaviour in reversed(before):
            if behaviour not in self._reported:
                state = _ENDS.get(behaviour.status, "dropped")
                report(
                    state, behaviour.name, behaviour, behaviour.feedback_message if state == "failed" else ""
                )
        for behaviour in self._reported:
            if behaviour not in before:
                report("executing", behaviour.name, behaviour, "")


# Timers and time-outs of py_trees use the time of day, unless they are made to follow a clock.


_OF_PY_TREES = (py_trees.timers.Timer, py_trees.decorators.Timeout)
_METHODS = ("initialise", "update")
"""The methods in which they read the time."""


def follow(clock: Clock, behaviours: Iterable[Behaviour]) -> Callable[[], None]:
    """Let timers and time-outs of py_trees read *clock*, each object for itself; return a function that ends this.

    Raises:
        TypeError: a class derived from one of them has a method of its own there, so that it cannot follow a virtual clock.
    """
    bound: list[Behaviour] = []
    for behaviour in behaviours:
        kind = next((each for each in _OF_PY_TREES if isinstance(behaviour, each)), None)
        if kind is None:
            continue
        if all(getattr(type(behaviour), name) is getattr(kind, name) for name in _METHODS):
            _bind(behaviour, clock)
            bound.append(behaviour)
        elif clock.virtual:
            raise TypeError(
                f"the behaviour `{behaviour.name}` ({type(behaviour).__name__}) follows the time of day, not the virtual "
                "clock of the run; derive it from ArtifactBehaviour, and use self.clock"
            )

    def end() -> None:
        for behaviour in bound:
            for name in _METHODS:
                delattr(behaviour, name)

    return end


def _bind(behaviour: Behaviour, clock: Clock) -> None:
    """Replace the module `time`, as the methods of one object see it."""
    reading = SimpleNamespace(time=lambda: clock.elapsed, monotonic=lambda: clock.elapsed)
    for name in _METHODS:
        method = getattr(type(behaviour), name)
        function = FunctionType(method.__code__, {**method.__globals__, "time": reading}, name)
        setattr(behaviour, name, MethodType(function, behaviour))
