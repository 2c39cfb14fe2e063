"""What an intention waits for, as data. `jacaros.bdi.rules.waits` has the rules for the end of a wait.

Waits for events (``.wait({+e})``) are indexed by the kind of event, so an event is not compared with other waits; waits
for conditions are in `condition_waits`, with their index.
"""

from collections.abc import Callable, Iterator
from typing import Any

from jacaros.bdi.architecture import Timer
from jacaros.bdi.state.intention import Frame, Intention, NextStep
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import Functor, Term, atom, functor

ACTION = functor("action", 1)
"""Functor of the reason of a wait for the end of an external action."""


def is_action(reason: Term) -> bool:
    """Return whether the wait is for an external action."""
    return reason.__class__ is tuple and reason[0] is ACTION


class Alarm:
    """A call that is due at a moment of the run's clock.

    Attributes:
        number: its place among the alarms of the agent.
        due: the moment, in seconds since the Unix epoch.
        function, arguments: called with the agent and the arguments; a function of a module, so that it has a name.
        timer: of the host, which rings.
    """

    __slots__ = ("arguments", "due", "function", "number", "timer")

    timer: Timer

    def __init__(
        self, number: int, due: float, function: Callable[..., None], arguments: tuple[Any, ...]
    ) -> None:
        self.number, self.due, self.function, self.arguments = number, due, function, arguments


class Waiting:
    """A suspended step.

    Attributes:
        intention: the intention of the step.
        reason: a term for ``.intention`` and ``.suspended``.
        frame: of the step, once the step has been suspended.
        next_step: with which the frame continues.
        ended: the step has succeeded or failed, or its intention is gone. A suspended intention keeps such a wait.
        failure: why the step failed: a message, and annotations that may contain an ``error(..)``; None if it succeeded.
        alarm: what ends the wait at a moment, or None.
    """

    __slots__ = ("alarm", "ended", "failure", "frame", "intention", "next_step", "reason")

    def __init__(self, intention: Intention, reason: Term) -> None:
        self.intention, self.reason = intention, reason
        self.frame: Frame | None = None
        self.next_step: NextStep = None
        self.ended = False
        self.failure: tuple[str, tuple[Term, ...]] | None = None
        self.alarm: Alarm | None = None

    def attach(self, frame: Frame, next_step: NextStep) -> None:
        """Suspend the step in *frame*, which continues with *next_step*."""
        self.frame, self.next_step = frame, next_step
        self.intention.waiting = self


class ActWait(Waiting):
    """Waits for the end of the external action with a number."""

    __slots__ = ("number",)

    def __init__(self, intention: Intention, reason: Term, number: int) -> None:
        super().__init__(intention, reason)
        self.number = number


class TimedWait(Waiting):
    """Waits for a time, and perhaps for something earlier.

    Attributes:
        elapsed: unified with the milliseconds waited, or None.
        began: when it began, in seconds since the Unix epoch.
    """

    __slots__ = ("began", "elapsed")

    def __init__(self, intention: Intention, reason: Term, elapsed: Term, began: float) -> None:
        super().__init__(intention, reason)
        self.elapsed, self.began = elapsed, began


class AnswerWait(Waiting):
    """Waits for the answers to a question.

    Attributes:
        target: unified with the answer, or with the list of answers.
        many: the question went to a list of agents.
        expected: number of expected answers.
        answers: those received so far.
        ids: of the messages that asked.
    """

    __slots__ = ("answers", "expected", "ids", "many", "target")

    def __init__(self, intention: Intention, target: Term, many: bool, expected: int) -> None:
        super().__init__(intention, _ASK)
        self.target, self.many, self.expected = target, many, expected
        self.answers: list[Term] = []
        self.ids: list[str] = []


class GoalConditionWait(Waiting):
    """Waits for the goal condition of a plan whose body has ended."""

    __slots__ = ()

    def __init__(self, intention: Intention) -> None:
        super().__init__(intention, _GOAL_CONDITION)


class CoroutineWait(Waiting):
    """Waits for a coroutine of the project. It is a live object: a mind that waits for one cannot be stored."""

    __slots__ = ("task",)

    task: Timer

    def __init__(self, intention: Intention, name: str) -> None:
        super().__init__(intention, atom(name))


_ASK: Functor = atom("waiting_ask")
_GOAL_CONDITION: Functor = atom("wait_goal_condition")


class EventWait(TimedWait):
    """Waits for an event.

    Attributes:
        kind: of the events; None for all.
        pattern: unified with the literal of the event.
        number: number of the wait in its agent.
    """

    __slots__ = ("kind", "number", "pattern")

    def __init__(
        self,
        intention: Intention,
        reason: Term,
        elapsed: Term,
        began: float,
        kind: Trigger | None,
        pattern: Term,
    ) -> None:
        super().__init__(intention, reason, elapsed, began)
        self.kind, self.pattern = kind, pattern
        self.number = 0


class EventWaits(dict[Trigger | None, dict[int, EventWait]]):
    """The waits of one agent for events, by kind of event and number; kinds without waits have no entry."""

    def __init__(self) -> None:
        super().__init__()
        self._count = 0

    def add(self, wait: EventWait, number: int | None = None) -> None:
        """Begin to wait; *number* is that of a stored wait."""
        self._count = wait.number = self._count + 1 if number is None else number
        self.setdefault(wait.kind, {})[wait.number] = wait

    def remove(self, wait: EventWait) -> None:
        """End a wait; no effect if it is already over."""
        held = self.get(wait.kind)
        if held is not None and held.pop(wait.number, None) is not None and not held:
            del self[wait.kind]

    def candidates(self, kind: Trigger) -> Iterator[EventWait]:
        """Yield the waits that an event of that kind may end, in the order in which they began."""
        own, all_ = self.get(kind), self.get(None)
        if all_ is None:
            return iter(() if own is None else list(own.values()))
        both = (*(own.values() if own is not None else ()), *all_.values())
        return iter(sorted(both, key=lambda wait: wait.number))
