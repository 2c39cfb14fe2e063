"""Intentions: stacks of frames, as data."""

from collections.abc import Callable, Collection
from typing import Any, Final

from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, literal_of
from jacaros.agents.terms.values import Term
from jacaros.runtime.trace import Cause

NextStep = Callable[..., object] | None
"""What is done next in a plan; None when its body is finished."""
Frame = list[Any]
"""``[next step, goal, annotations, serial, plan, variable, ...]``, see `jacaros.agents.mind.generated`.

next step: function of the next formula, None when the body is finished.
goal: tuple that begins with its `Trigger`: what the plan serves, with the arguments.
annotations: of the goal; a tuple, or a `FailureReason`.
serial: number of goals posted before it (`Trail.serial`): bindings stamped with it or later were made for it.
plan: the `Plan`.
"""

STEP, GOAL, ANNOTATIONS, SERIAL, PLAN, FIRST_SLOT = range(6)


def variables_of(frame: Frame, names: Collection[str] | None = None) -> dict[str, Term]:
    """The variables of a frame that have been given a value; of those with these names only, if given."""
    return {
        name: frame[slot]
        for name, slot in frame[PLAN].slots.items()
        if slot < len(frame) and frame[slot] is not None and (names is None or name in names)
    }


class Intention:
    """An intention of the agent.

    Attributes:
        id: number, for programs and logs.
        frames: the stack, bottom first.
        handlers: for each failure handler on the stack, to which height it is cut when the handler ends.
        suspended: why it is suspended (a term for ``.suspended``), or None. It is then in no queue of those that can run.
        waiting: what it waits for (`Waiting`), or None.
        dropped: it is over; code that still holds it must release it.
        cause: why it was adopted.
        forks: the forks it is a branch of, outermost first, with the number of the branch.
        outer: intention and frame whose sub-plan reacts here to an external event, or None.
        urgencies: the urgency of each frame with those below it; only if the agent has urgent plans.
        on_failed: called instead of the usual warning when it ends in failure, with the agent and the reason
            (`FailureReason`, or None), and the arguments that follow these; or None.
        on_end: called with the agent and the arguments when it is over, however it ended; or None.
        on_wait: called whenever it begins to wait or is suspended; or None.
    """

    __slots__ = (
        "cause",
        "dropped",
        "forks",
        "frames",
        "handlers",
        "id",
        "on_end",
        "on_failed",
        "on_wait",
        "outer",
        "suspended",
        "urgencies",
        "waiting",
    )

    urgencies: list[tuple[Frame, int]]

    def __init__(self, agent: Any, cause: Cause | None = None) -> None:
        """Make an intention of an agent (`Circumstance`), with a new number; it is in no queue yet."""
        self.id = agent.counts.intentions = agent.counts.intentions + 1
        agent.alive[self.id] = self
        self.frames: list[Frame] = []
        self.handlers: list[int] = []
        self.suspended: Term = None
        self.waiting: Any = None
        self.dropped = False
        self.cause = cause
        self.outer: tuple[Intention, Frame] | None = None
        self.forks: tuple[tuple[Any, int], ...] = ()
        self.on_failed: tuple[Callable[..., None], tuple[Any, ...]] | None = None
        self.on_end: tuple[Callable[..., None], tuple[Any, ...]] | None = None
        self.on_wait: Callable[[], None] | None = None

    @property
    def state(self) -> str:
        """One of four states, the first of these that applies.

        ==============  ======================  ================================================================
        state           it has                  and ends with
        ==============  ======================  ================================================================
        ``over``        been dropped            nothing: it has no frames, and is not among those alive
        ``suspended``   a reason (`suspended`)  ``.resume``, or the resource that it lost; in no queue meanwhile
        ``waiting``     a wait (`waiting`)      the end of the wait, also while it is suspended
        ``running``     a place in a queue      its next step, or the handling of the event that it has posted
        ==============  ======================  ================================================================
        """
        if self.dropped:
            return "over"
        if self.suspended is not None:
            return "suspended"
        return "running" if self.waiting is None else "waiting"

    def is_atomic(self) -> bool:
        """Whether a plan on the stack is atomic."""
        return any(frame[PLAN].atomic for frame in self.frames)

    def __repr__(self) -> str:
        return f"Intention({self.id}, {[frame[GOAL][0] for frame in self.frames]!r})"


# Events: what happened to goals and beliefs and may need a plan.


Event = tuple[Goal, Intention | None, EventAnnotations, Cause | None]
"""``(goal, intention, annotations, cause)``: an entry of the event queue.

goal: a tuple that begins with its `Trigger`, then the arguments.
intention: the one that posted it, None for an external event.
annotations: a tuple, or a `FailureReason`.
cause: why it came, for external events.

A plain tuple: with several intentions nearly every cycle makes one, and an object with names costs five times as much.
"""

EVENT_GOAL: Final = 0
EVENT_INTENTION: Final = 1
EVENT_ANNOTATIONS: Final = 2
EVENT_CAUSE: Final = 3


class Posted:
    """A goal or event with other annotations than ``source(self)``, on its way from a step to the queue."""

    __slots__ = ("annotations", "goal")

    def __init__(self, goal: Goal, annotations: EventAnnotations) -> None:
        self.goal, self.annotations = goal, annotations


Raised = Goal | Posted | None
"""The goal or event that a step raises for its own intention, if any."""


def event_literal(event: Event) -> Term:
    """The belief or goal of an event, with its annotations."""
    return literal_of(event[EVENT_GOAL], event[EVENT_ANNOTATIONS])
