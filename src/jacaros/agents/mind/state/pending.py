"""What ends later, as data: calls at a moment, at an event or when a condition holds, and the steps that wait for them.

`jacaros.agents.mind.rules.pending` makes and cancels the calls, `jacaros.agents.mind.rules.deadlines` has the rules for
the end of a wait.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from jacaros.agents.mind.state.act import TimerHandle
from jacaros.agents.mind.state.intention import (
    FIRST_SLOT,
    GOAL,
    PLAN,
    SERIAL,
    Event,
    Frame,
    Intention,
    NextStep,
)
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Functor, String, Term, atom, bare, functor

# Resources that a plan or a goal needs for all of its steps, as data: ``[needs(base, arm), policy(refuse)]``.


NEEDS, POLICY = "needs", functor("policy", 1)


class Wanted(NamedTuple):
    """What a plan or goal needs.

    Attributes:
        names: of the resources, such as ``wheels``.
        policy: ``wait`` or ``refuse``.
    """

    names: tuple[str, ...]
    policy: str


class Need:
    """What a frame of an intention has asked for; it holds that until the frame is gone.

    Attributes:
        number: of the act that asked for it.
        intention: that asked for it; branches of a fork may have taken its place.
        index: of the frame on the stack; it may have moved up since, above the supervision of its plan.
        serial: of the frame, the same in all branches of a fork.
        plan: of the frame.
    """

    __slots__ = ("index", "intention", "number", "plan", "serial")

    def __init__(self, number: int, intention: Intention) -> None:
        self.number, self.intention, self.index = number, intention, len(intention.frames) - 1
        self.serial, self.plan = intention.frames[-1][SERIAL], intention.frames[-1][PLAN]

    def is_of(self, frame: Frame) -> bool:
        """Whether a frame has asked for it."""
        return frame[SERIAL] == self.serial and frame[PLAN] is self.plan

    def is_on(self, intention: Intention) -> bool:
        """Whether the frame is on the stack of an intention."""
        return any(map(self.is_of, intention.frames[self.index :]))


def wanted_in(annotations: Iterable[Term]) -> Wanted | None:
    """What annotations of a plan's label or of a goal say; None when they need nothing."""
    names: list[str] = []
    policy = "wait"
    for annotation in annotations:
        inner: Any = bare(annotation)
        if inner.__class__ is not tuple:
            continue
        if inner[0] is POLICY:
            policy = _name(inner[1])
        elif inner[0].name == NEEDS:
            names.extend(_name(each) for each in inner[1:])
    return Wanted(tuple(names), policy) if names else None


def _name(term: Term) -> str:
    term = bare(term)
    if term.__class__ is String:
        return str(term)
    return text(term)


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
class PendingTimer(Pending):
    """A call that is due at a moment.

    Attributes:
        due: the moment, in the time of the agent (`jacaros.agents.mind.rules.pending.now`).
        timer: of the host, which rings.
    """

    due: float
    timer: TimerHandle = field(init=False)


@dataclass(slots=True, eq=False)
class PendingEvent(Pending):
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
class PendingCondition(Pending):
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
        if self.intention.on_wait is not None:
            self.intention.on_wait()


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

    task: TimerHandle = field(init=False)


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
    alarms: dict[int, PendingTimer] = field(default_factory=dict)
    events: dict[Trigger | None, dict[int, PendingEvent]] = field(default_factory=dict)
    conditions: dict[int, PendingCondition] = field(default_factory=dict)
    asked: dict[Functor, dict[tuple[int, ...], dict[tuple[Term, ...], dict[int, PendingCondition]]]] = field(
        default_factory=dict
    )
    restless: dict[int, PendingCondition] = field(default_factory=dict)
    due: dict[int, PendingCondition] = field(default_factory=dict)
    acts: dict[int, Waiting] = field(default_factory=dict)
    questions: dict[str, AnswerWait] = field(default_factory=dict)
    abandoned: set[str | None] = field(default_factory=set)
    suspended_events: list[Event] = field(default_factory=list)
    needs: dict[int, Need] = field(default_factory=dict)
    preempted: dict[int, tuple[Term, list[Intention]]] = field(default_factory=dict)
    requeued: list[Event] = field(default_factory=list)
    latest: float = 0.0
    ahead: float = 0.0


# The supervision of a goal or a plan while it is pursued, as data: deadlines, attempts, periods, and conditions.
#
# A frame of its own holds it on the stack of the intention, right below the frame of the goal or plan that it supervises.
# That frame is reached when the goal or plan has ended.


SUPERVISED = trigger("+", "", functor("supervised", 0, namespace="jacaros"))
"""The trigger of frames that hold a supervision."""
PAUSE = functor("pause", 0, namespace="jacaros")
"""The label of the plan of a frame that represents a goal between two of its plans."""
SUPERVISION, CONDITION, WRITTEN = range(FIRST_SLOT, FIRST_SLOT + 3)
"""Places in such a frame: the supervision, what is to be tested at the end (None once it held), and that as it was
written, with the variables of the goal; the arguments of a supervised goal follow."""


@dataclass(slots=True, eq=False)
class Supervision:
    """Supervises a goal, ``!g[within(Ms), retry(N, Ms), every(Ms), achieves(C, Ms)]``, or a plan, ``@p[while(C), ..]``.

    Attributes:
        kind: of the goal; None for a plan.
        pending: the deadline and the lost condition, which interrupt it; empty when the goal or plan has ended.
        within: seconds in which a goal must be achieved, in each period; None for no limit.
        hard: the deadline is that of ``hard_deadline``.
        retries: maximum number of further attempts.
        back_off: seconds before the second attempt; doubled before each further one.
        failed: number of attempts that have failed, in this period.
        period: seconds from the beginning of one period to the next; None for what is pursued once.
        began: when period 0 began, in the time of the agent.
        number: of the present period.
        missed: number of missed periods.
        achieves, settle: the condition that must hold at the end, or None, and for how many seconds to wait for it (of a
            plan both are computed at its end).
        cleanup: the goal that is pursued when a plan is interrupted, or has not achieved its condition; or None.
        lost: why a plan is about to fail (`FailureReason`), once it has been interrupted.
    """

    kind: Trigger | None = None
    pending: list[Pending] = field(default_factory=list)
    within: float | None = None
    hard: bool = False
    retries: int = 0
    back_off: float = 0.0
    failed: int = 0
    period: float | None = None
    began: float = 0.0
    number: int = 0
    missed: int = 0
    achieves: Term = None
    settle: float = 0.0
    cleanup: Term = None
    lost: Any = None


def is_supervision(frame: Frame) -> bool:
    """Return whether a frame holds a supervision."""
    return frame[GOAL][0] is SUPERVISED


def is_pause(frame: Frame) -> bool:
    """Return whether a frame represents a goal between two of its plans."""
    return frame[PLAN].label is PAUSE


def caller_of(intention: Intention) -> Frame | None:
    """Return the frame of the plan that has posted a goal without a frame; None if it was posted from outside."""
    return next((frame for frame in reversed(intention.frames) if not is_supervision(frame)), None)


def holders_below(intention: Intention, index: int) -> list[Frame]:
    """Return the frames of the supervisions of the frame at *index*, or of the goal that is about to get a frame there."""
    found: list[Frame] = []
    while index and is_supervision(frame := intention.frames[index - 1]):
        found.append(frame)
        index -= 1
    return found


def supervisions_below(intention: Intention, index: int) -> list[Supervision]:
    """Return these supervisions, the innermost first."""
    return [frame[SUPERVISION] for frame in holders_below(intention, index)]
