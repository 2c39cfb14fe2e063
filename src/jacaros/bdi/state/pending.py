"""What ends later, as data: calls at a moment, at an event or when a condition holds, and the steps that wait for them.

`jacaros.bdi.rules.pending` makes and cancels the calls, `jacaros.bdi.rules.waits` has the rules for the end of a wait.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from jacaros.bdi.architecture import Timer
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import Frame, Intention, NextStep
from jacaros.bdi.state.need import Need
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import Functor, Term, atom, functor

ACTION = functor("action", 1)
"""Functor of the reason of a wait for the end of an external action."""
ASK, GOAL_CONDITION = atom("waiting_ask"), atom("wait_goal_condition")
"""Reasons of waits for an answer, and for the goal condition of a plan whose body has ended."""


def is_action(reason: Term) -> bool:
    """Return whether the wait is for an external action."""
    return reason.__class__ is tuple and reason[0] is ACTION


@dataclass(slots=True, eq=False)
class Pending:
    """A call that is made later.

    Attributes:
        number: its place among the pending calls of the agent.
        function, arguments: called with the agent and the arguments; a function of a module, so that it has a name.
    """

    number: int
    function: Callable[..., None]
    arguments: tuple[Any, ...]


@dataclass(slots=True, eq=False)
class Alarm(Pending):
    """A call that is due at a moment.

    Attributes:
        due: the moment, in the time of the agent (`jacaros.bdi.rules.pending.now`).
        timer: of the host, which rings.
    """

    due: float
    timer: Timer = field(init=False)


@dataclass(slots=True, eq=False)
class Listener(Pending):
    """A call at the next event that matches.

    Attributes:
        kind: of the events; None for all.
        pattern: unified with the literal of the event.
    """

    kind: Trigger | None
    pattern: Term


Asked = tuple[Functor, tuple[int, ...], tuple[Term, ...]]
"""The beliefs that a literal asks for: their functor, the places of the arguments that are known, and these."""


@dataclass(slots=True, eq=False)
class Watch(Pending):
    """A call when a condition holds. None precedes the arguments, or the exception if it cannot be evaluated.

    Attributes:
        condition: the condition.
        asked: the beliefs that the condition depends on; None when it may depend on anything.
    """

    condition: Term
    asked: list[Asked] | None


@dataclass(slots=True, eq=False)
class Waiting:
    """A suspended step.

    Attributes:
        intention: the intention of the step.
        reason: a term for ``.intention`` and ``.suspended``.
        frame: of the step, once the step has been suspended.
        next_step: with which the frame continues.
        ended: the step has succeeded or failed, or its intention is gone. A suspended intention keeps such a wait.
        failure: why the step failed: a message, and annotations that may contain an ``error(..)``; None if it succeeded.
        pending: the calls that end it.
        act: number of the external action that it waits for, or None.
        began: when a ``.wait`` or pause began, in the time of the agent, or None.
        elapsed: unified with the milliseconds waited, or None.
    """

    intention: Intention
    reason: Term
    act: int | None = None
    frame: Frame | None = None
    next_step: NextStep = None
    ended: bool = False
    failure: tuple[str, tuple[Term, ...]] | None = None
    pending: list[Pending] = field(default_factory=list)
    began: float | None = None
    elapsed: Term = None

    def attach(self, frame: Frame, next_step: NextStep) -> None:
        """Suspend the step in *frame*, which continues with *next_step*."""
        self.frame, self.next_step = frame, next_step
        self.intention.waiting = self


@dataclass(slots=True, eq=False)
class AnswerWait(Waiting):
    """Waits for the answers to a question.

    Attributes:
        target: unified with the answer, or with the list of answers.
        many: the question went to a list of agents.
        expected: number of expected answers.
        answers: those received so far.
        ids: of the messages that asked.
    """

    target: Term = None
    many: bool = False
    expected: int = 1
    answers: list[Term] = field(default_factory=list)
    ids: list[str] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class CoroutineWait(Waiting):
    """Waits for a coroutine of the project. It is a live object: a mind that waits for one cannot be stored."""

    task: Timer = field(init=False)


@dataclass(slots=True, eq=False)
class Waits:
    """What the intentions of an agent wait for, and what has been postponed.

    Attributes:
        made: number of pending calls so far.
        alarms: calls at a moment, by number.
        events: calls at an event, by the kind of event and number; kinds without any have no entry.
        conditions: calls when a condition holds, by number.
        asked: these by the beliefs that they depend on: functor, places and values of the known arguments, number.
        restless: conditions that may depend on anything: they are tested in every cycle.
        due: conditions that a change of beliefs may have made true.
        acts: waits for an external action, by its number.
        questions: waits for an answer, by the id of the question.
        abandoned: ids of questions that no intention waits for: a late answer is discarded.
        suspended_events: those of suspended intentions, and of goals that were suspended before they began.
        needs: the resources that plans and goals have requested, by the number of the act.
        preempted: the acts that have lost a resource: why, and the intentions that are suspended for it.
        requeued: external events without plan that are to be tried again (``events=requeue``).
        latest, ahead: the latest time of the agent, and by how much it is ahead of a clock that was set back.
    """

    made: int = 0
    alarms: dict[int, Alarm] = field(default_factory=dict)
    events: dict[Trigger | None, dict[int, Listener]] = field(default_factory=dict)
    conditions: dict[int, Watch] = field(default_factory=dict)
    asked: dict[Functor, dict[tuple[int, ...], dict[tuple[Term, ...], dict[int, Watch]]]] = field(
        default_factory=dict
    )
    restless: dict[int, Watch] = field(default_factory=dict)
    due: dict[int, Watch] = field(default_factory=dict)
    acts: dict[int, Waiting] = field(default_factory=dict)
    questions: dict[str, AnswerWait] = field(default_factory=dict)
    abandoned: set[str | None] = field(default_factory=set)
    suspended_events: list[Event] = field(default_factory=list)
    needs: dict[int, Need] = field(default_factory=dict)
    preempted: dict[int, tuple[Term, list[Intention]]] = field(default_factory=dict)
    requeued: list[Event] = field(default_factory=list)
    latest: float = 0.0
    ahead: float = 0.0
