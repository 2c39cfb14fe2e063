"""Where an intention is in its plans: the stack of its goals, each with the step that it is at."""

from typing import Any

from jacaros.asl.source import Span
from jacaros.bdi.explaining.failure_reason import StepPlace, place_of_call
from jacaros.bdi.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.bdi.state.plan import Plan, StepInfo
from jacaros.mas.history.programs import PlanNumbers
from jacaros.mas.history.words import cut, named, shown_event

DEEPEST = 24
"""Goals of a stack that are recorded: the lowest one, and those next to the top."""


def stack_of(intention: Intention, numbers: PlanNumbers) -> list[dict[str, Any]]:
    """Return the goals of an intention from the bottom up, with the steps they are at."""
    frames = [frame for frame in intention.frames if frame[GOAL][0].functor.namespace != "jacaros"]
    shown = list(enumerate(frames))
    if len(shown) > DEEPEST:
        shown = [shown[0], *shown[1 - DEEPEST :]]
    return [_level(frame, frames[index + 1 : index + 2], numbers) for index, frame in shown]


def _level(frame: Frame, above: list[Frame], numbers: PlanNumbers) -> dict[str, Any]:
    plan: Plan = frame[PLAN]
    if above:
        span, step = place_of_call(frame, above[0][GOAL][0].functor), shown_goal(above[0])
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
    """Return plan, file and line of the step that an intention is at; empty without a stack."""
    if not intention.frames:
        return {}
    frame = intention.frames[-1]
    span = _span(frame)
    if span is None:
        return {"plan": numbers[frame[PLAN]]}
    return {"plan": numbers[frame[PLAN]], "file": span.file.name, "line": span.line}


def step_of(frame: Frame) -> str:
    """Return the step that a frame is at, with the values of its variables; empty at the end of the plan."""
    info = getattr(frame[STEP], "info", None)
    if info is None:
        return ""
    try:
        return cut(named(StepPlace(frame, info).step()))
    except Exception:
        # What is shown to people can never make a run fail.
        return _written(info.node.span)


def _span(frame: Frame) -> Span | None:
    info: StepInfo | None = getattr(frame[STEP], "info", None)
    plan: Plan = frame[PLAN]
    return plan.node.span if info is None else info.node.span


def _written(span: Span | None) -> str:
    return "" if span is None else cut(span.file.lines[span.line - 1][span.column - 1 :].strip())
