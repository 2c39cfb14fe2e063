"""The position of an intention in its plans: the stack of its goals, each with its current step."""

from typing import Any, NamedTuple

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.mind.rules.failure_reason import Place, place_of_call
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.agents.mind.state.plan import Plan, StepInfo
from jacaros.agents.mind.state.triggers import literal_of
from jacaros.agents.terms.substitution import is_ground
from jacaros.mas.history.programs import PlanNumbers
from jacaros.mas.history.words import cut, named, shown_event

DEEPEST = 24
"""Maximum number of recorded goals of a stack: the lowest one, and those next to the top."""


class Stacks:
    """Shows the stacks of intentions. A level whose goals have no variables is unchanged as long as its step is.

    Args:
        numbers: numbers of the plans.
    """

    def __init__(self, numbers: PlanNumbers) -> None:
        self._numbers = numbers
        self._levels: dict[int, list[_Shown]] = {}

    def of(self, intention: Intention) -> list[dict[str, Any]]:
        """Return the goals of an intention from the bottom up, with their current steps."""
        frames = [frame for frame in intention.frames if frame[GOAL][0].functor.namespace != "jacaros"]
        levels = list(zip(frames, [*frames[1:], None], strict=True))
        if len(levels) > DEEPEST:
            levels = [levels[0], *levels[1 - DEEPEST :]]
        known = self._levels.get(intention.id, ())
        shown = [
            known[place] if place < len(known) and known[place].is_still(*level) else self._show(*level)
            for place, level in enumerate(levels)
        ]
        self._levels[intention.id] = shown
        return [each.data for each in shown]

    def forget(self, number: int) -> None:
        """Forget a finished intention."""
        self._levels.pop(number, None)

    def _show(self, frame: Frame, above: Frame | None) -> "_Shown":
        lasting = above is not None and all(is_ground(literal_of(each[GOAL], ())) for each in (frame, above))
        return _Shown(frame, above, frame[STEP], lasting, _level(frame, above, self._numbers))


class _Shown(NamedTuple):
    """A level of a stack as recorded, and whether it is valid until its step changes."""

    frame: Frame
    above: Frame | None
    step: object
    lasting: bool
    data: dict[str, Any]

    def is_still(self, frame: Frame, above: Frame | None) -> bool:
        """Return whether nothing of it has changed."""
        return self.lasting and self.frame is frame and self.above is above and self.step is frame[STEP]


def _level(frame: Frame, above: Frame | None, numbers: PlanNumbers) -> dict[str, Any]:
    plan: Plan = frame[PLAN]
    if above is not None:
        span, step = place_of_call(frame, above[GOAL][0].functor), shown_goal(above)
    else:
        span, step = _span(frame), step_of(frame)
    return {
        "goal": shown_goal(frame),
        "plan": numbers[plan],
        "file": plan.file if span is None else span.file.name,
        "line": 0 if span is None else span.line,
        "step": step,
    }


def shown_goal(frame: Frame) -> str:
    """Return the goal of a frame without its ``+``: ``!go(dock)``, or the event that it handles: ``+low(9)``."""
    goal = frame[GOAL]
    told = shown_event(goal)
    return told.removeprefix("+") if goal[0].kind and not goal[0].failing else told


def place_of(intention: Intention, numbers: PlanNumbers) -> dict[str, Any]:
    """Return plan, file and line of an intention's current step; empty without a stack."""
    if not intention.frames:
        return {}
    frame = intention.frames[-1]
    span = _span(frame)
    if span is None:
        return {"plan": numbers[frame[PLAN]]}
    return {"plan": numbers[frame[PLAN]], "file": span.file.name, "line": span.line}


def step_of(frame: Frame) -> str:
    """Return the current step of a frame, with the values of its variables; empty at the end of the plan."""
    info = getattr(frame[STEP], "info", None)
    if info is None:
        return ""
    try:
        return cut(named(Place(frame, info).step()))
    except Exception:
        # Output for users must not make a run fail.
        return _written(info.node.span)


def _span(frame: Frame) -> Span | None:
    info: StepInfo | None = getattr(frame[STEP], "info", None)
    plan: Plan = frame[PLAN]
    return plan.node.span if info is None else info.node.span


def _written(span: Span | None) -> str:
    return "" if span is None else cut(span.file.lines[span.line - 1][span.column - 1 :].strip())
