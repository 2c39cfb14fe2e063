"""The supervision of a goal or a plan while it is pursued, as data: deadlines, attempts, periods, and conditions.

A frame of its own holds it on the stack of the intention, right below the frame of the goal or plan that it supervises.
That frame is reached when the goal or plan has ended.
"""

from typing import Any

from jacaros.bdi.state.condition_waits import ConditionWatch
from jacaros.bdi.state.intention import FIRST_SLOT, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.bdi.state.waiting import Alarm
from jacaros.terms.values import Term, functor

SUPERVISED = trigger("+", "", functor("supervised", 0, namespace="jacaros"))
"""The trigger of frames that hold a supervision."""
PAUSE = functor("pause", 0, namespace="jacaros")
"""The label of the plan of a frame that represents a goal between two of its plans."""
SUPERVISION = FIRST_SLOT
"""The place of the supervision in such a frame; the arguments of a supervised goal follow."""


class Supervision:
    """Supervises one goal or plan.

    Attributes:
        alarm: of its deadline; None without one, or when the goal or plan has ended.
    """

    __slots__ = ("alarm",)

    def __init__(self) -> None:
        self.alarm: Alarm | None = None


class GoalSupervision(Supervision):
    """Supervises a goal: ``!g[within(Ms), retry(N, Ms), every(Ms)]``.

    Attributes:
        kind: of the goal.
        within: seconds in which the goal must be achieved, in each period; None for no limit.
        hard: the deadline is that of ``hard_deadline``.
        retries: maximum number of further attempts.
        back_off: seconds before the second attempt; doubled before each further one.
        failed: number of attempts that have failed, in this period.
        period: seconds from the beginning of one period to the next; None for a goal that is pursued once.
        began: when period 0 began, in seconds since the Unix epoch.
        number: of the present period.
        missed: number of missed periods.
    """

    __slots__ = (
        "back_off",
        "began",
        "failed",
        "hard",
        "kind",
        "missed",
        "number",
        "period",
        "retries",
        "within",
    )

    def __init__(self, kind: Trigger) -> None:
        super().__init__()
        self.kind = kind
        self.within: float | None = None
        self.hard = False
        self.retries = self.failed = 0
        self.back_off = 0.0
        self.period: float | None = None
        self.began = 0.0
        self.number = self.missed = 0

    @property
    def is_acting(self) -> bool:
        """Return whether there is anything to supervise."""
        return self.within is not None or self.retries > 0 or self.period is not None


class PlanGuard(Supervision):
    """Supervises a plan: ``@p[while(Condition), within(Ms), cleanup(Goal)]``.

    Attributes:
        watch: of the condition that must stay true, or None.
        cleanup: the goal that is pursued when the condition no longer holds, or None.
        lost: why the plan is about to fail (`FailureReason`), once the condition no longer holds.
    """

    __slots__ = ("cleanup", "lost", "watch")

    def __init__(self, cleanup: Term) -> None:
        super().__init__()
        self.cleanup = cleanup
        self.watch: ConditionWatch | None = None
        self.lost: Any = None


def is_supervision(frame: Frame) -> bool:
    """Return whether a frame holds a supervision."""
    return frame[GOAL][0] is SUPERVISED


def caller_of(intention: Intention) -> Frame | None:
    """Return the frame of the plan that has posted a goal without a frame; None if it was posted from outside."""
    return next((frame for frame in reversed(intention.frames) if not is_supervision(frame)), None)


def is_pause(frame: Frame) -> bool:
    """Return whether a frame represents a goal between two of its plans."""
    return frame[PLAN].label is PAUSE


def supervisions_below(intention: Intention, index: int) -> list[Supervision]:
    """Return the supervisions of the frame at *index*, or of the goal that is about to get a frame there."""
    if not index or not is_supervision(intention.frames[index - 1]):
        return []
    found: list[Supervision] = []
    for frame in reversed(intention.frames[max(0, index - 2) : index]):
        if not is_supervision(frame):
            break
        found.append(frame[SUPERVISION])
    return found


def place_of(intention: Intention, supervision: Supervision) -> int | None:
    """Return the index of the frame that holds a supervision, or None."""
    for index, frame in enumerate(intention.frames):
        if is_supervision(frame) and frame[SUPERVISION] is supervision:
            return index
    return None
