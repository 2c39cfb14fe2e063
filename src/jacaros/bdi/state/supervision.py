"""The supervision of a goal or a plan while it is pursued, as data: deadlines, attempts, periods, and conditions.

A frame of its own holds it on the stack of the intention, right below the frame of the goal or plan that it supervises.
That frame is reached when the goal or plan has ended.
"""

from dataclasses import dataclass, field
from typing import Any

from jacaros.bdi.state.intention import FIRST_SLOT, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.pending import Pending
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.terms.values import Term, functor

SUPERVISED = trigger("+", "", functor("supervised", 0, namespace="jacaros"))
"""The trigger of frames that hold a supervision."""
PAUSE = functor("pause", 0, namespace="jacaros")
"""The label of the plan of a frame that represents a goal between two of its plans."""
SUPERVISION = FIRST_SLOT
"""The place of the supervision in such a frame; the arguments of a supervised goal follow."""


@dataclass(slots=True, eq=False)
class Supervision:
    """Supervises a goal, ``!g[within(Ms), retry(N, Ms), every(Ms)]``, or a plan, ``@p[while(C), within(Ms), cleanup(G)]``.

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
        cleanup: the goal that is pursued when a plan is interrupted, or None.
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


def supervisions_below(intention: Intention, index: int) -> list[Supervision]:
    """Return the supervisions of the frame at *index*, or of the goal that is about to get a frame there."""
    found: list[Supervision] = []
    while index and is_supervision(frame := intention.frames[index - 1]):
        found.append(frame[SUPERVISION])
        index -= 1
    return found
