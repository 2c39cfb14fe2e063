"""Waiting and time-outs on the run's clock, and those of py_trees made to follow it: they use the time of day."""

from collections.abc import Callable, Iterable
from types import FunctionType, MethodType, SimpleNamespace
from typing import Any

import py_trees.decorators
import py_trees.timers
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from jacaros.behaviour_trees.artifact_behaviour import ArtifactBehaviour, nothing, session_of
from jacaros.runtime.clock import Clock
from jacaros.runtime.clock import Timer as ClockTimer


class Timer(ArtifactBehaviour):
    """RUNNING for some time, then SUCCESS.

    Args:
        duration: seconds of the run's clock.
        name: name of the behaviour.
    """

    def __init__(self, duration: float, name: str | None = None) -> None:
        super().__init__(name or f"{duration:g} s")
        self.duration = duration
        self._over = False
        self._timer: ClockTimer | None = None

    def initialise(self) -> None:
        """Start waiting."""
        self._over = False
        self._timer = self.clock.call_later(self.duration, self._ring)

    def update(self) -> Status:
        """Check whether the time is over."""
        self.feedback_message = "over" if self._over else f"waiting {self.duration:g} s"
        return Status.SUCCESS if self._over else Status.RUNNING

    def terminate(self, new_status: Status) -> None:
        """Stop waiting."""
        self.let_go()

    def let_go(self) -> None:
        """Stop waiting."""
        if self._timer is not None:
            self._timer.cancel()

    def _ring(self) -> None:
        self._over = True
        self.wake()


class Timeout(Decorator):
    """Interrupt the child if it takes too long, and fail.

    Args:
        child: the child.
        duration: maximum time in seconds of the run's clock.
        name: name of the behaviour.
    """

    def __init__(self, child: Behaviour, duration: float, name: str | None = None) -> None:
        super().__init__(name or f"at most {duration:g} s", child)
        self.duration = duration
        self.wake: Callable[[], None] = nothing
        self._clock: Clock
        self._over = False
        self._timer: ClockTimer | None = None

    def setup(self, **given: Any) -> None:
        """Store the clock; see `ArtifactBehaviour.setup`."""
        self._clock = session_of(self, given).clock
        self.wake = given.get("wake", nothing)

    def initialise(self) -> None:
        """Start the time-out."""
        self._over = False
        self._timer = self._clock.call_later(self.duration, self._ring)

    def update(self) -> Status:
        """Return the child's status while there is time."""
        late = self._over and self.decorated.status is Status.RUNNING
        self.feedback_message = f"took longer than {self.duration:g} s" if late else ""
        return Status.FAILURE if late else self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Stop the time-out."""
        if self._timer is not None:
            self._timer.cancel()

    def _ring(self) -> None:
        self._over = True
        self.wake()


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
            ours = f"jacaros.behaviour_trees.{kind.__name__}"
            raise TypeError(
                f"the behaviour `{behaviour.name}` ({type(behaviour).__name__}) follows the time of day, not the virtual "
                f"clock of the run; derive it from {ours}"
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
