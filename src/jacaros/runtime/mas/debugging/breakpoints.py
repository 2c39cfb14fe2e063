"""Breakpoints: where a debugger stops a run, before an event is handled or a step is run."""

from collections.abc import Mapping
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_trigger
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.language.nodes import nodes_in
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    EVENT_ANNOTATIONS,
    EVENT_GOAL,
    PLAN,
    STEP,
    Event,
    Frame,
    Intention,
)
from jacaros.agents.mind.state.plan import Plan, StepInfo
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, literal_of
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import annotations_of, functor_of
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.debugging.conditions import Condition, HitCount, LogMessage, bindings_of


class Breakpoint:
    """A condition for stopping a run.

    Attributes:
        text: its text, such as ``patrol.asl:14``, unique among the breakpoints of a debugger.
    """

    text: str

    @property
    def met(self) -> str:
        """Its text, with the values that met it."""
        return self.text

    def data(self) -> dict[str, Any]:
        """Return plain data that describes it, for `breakpoint_at`."""
        raise NotImplementedError

    def meets_event(self, agent: Circumstance, event: Event) -> bool:
        """Return whether the run stops before *agent* selects a plan for *event*."""
        del agent, event
        return False

    def meets_step(self, agent: Circumstance, intention: Intention) -> bool:
        """Return whether the run stops before *agent* runs the next step of *intention*."""
        del agent, intention
        return False


class LineBreakpoint(Breakpoint):
    """Stops before the first step on a line of a program. On the line where a plan begins, it stops before its first step.

    Args:
        file: name of the file as in diagnostics, or the end of it, such as ``patrol.asl``.
        line: number of the line, from 1.
        condition: stop only if it holds, such as ``Level < 20``; it may use the variables of the plan. Empty for always.
        hits: stop only at these visits, such as ``3``, ``>= 3`` or ``% 3``. Empty for all.
        log: log this text instead of stopping, such as ``at {X}, {battery(B)}``. Empty to stop.

    Raises:
        AslError: the condition, or a formula of the text, has errors.
        UsageError: one of them calls an internal action that acts or waits, or the hit count is invalid.
    """

    def __init__(self, file: str, line: int, condition: str = "", hits: str = "", log: str = "") -> None:
        self.file, self.line = file, line
        self._given = {"condition": condition, "hits": hits, "log": log}
        self._condition = Condition(condition) if condition else None
        self._hits = HitCount(hits) if hits else None
        self._log = LogMessage(log) if log else None
        self.text = f"{file}:{line}{f' if {condition}' if condition else ''}"

    def data(self) -> dict[str, Any]:
        given = {name: value for name, value in self._given.items() if value}
        return {"line": {"file": self.file, "line": self.line, **given}}

    def meets_step(self, agent: Circumstance, intention: Intention) -> bool:
        """Return whether it is the first step of its plan on the line, and the condition and the hit count are met."""
        frame: Frame = intention.frames[-1]
        return (
            self._is_at(frame)
            and (self._condition is None or self._condition.answer(agent, bindings_of(frame)) is not None)
            and (self._hits is None or self._hits.counts())
        )

    def logs(self, agent: Circumstance, intention: Intention) -> str | None:
        """Return what to log instead of stopping the run; None to stop it."""
        return None if self._log is None else self._log.text(agent, bindings_of(intention.frames[-1]))

    def _is_at(self, frame: Frame) -> bool:
        plan: Plan = frame[PLAN]
        return self.is_in(plan.file) and (
            first_line(frame) == self.line or (is_at_first_step(frame) and self.line in head_lines(plan))
        )

    def is_in(self, file: str) -> bool:
        """Return whether it is in this file."""
        return file == self.file or file.endswith(f"/{self.file}")


class PlanBreakpoint(Breakpoint):
    """Stops before the first step of a plan.

    Args:
        label: label of the plan. Plans without one are called ``p__N``.
        agent: name of the agent. None for all.
    """

    def __init__(self, label: str, agent: str | None = None) -> None:
        self.label, self.agent = label.removeprefix("@"), agent
        self.text = f"@{self.label}" + (f" of {agent}" if agent is not None else "")

    def data(self) -> dict[str, Any]:
        return {"plan": {"plan": self.label, "agent": self.agent}}

    def meets_step(self, agent: Circumstance, intention: Intention) -> bool:
        """Return whether it is the first step of the plan."""
        frame: Frame = intention.frames[-1]
        return (
            self.agent in (None, agent.name)
            and is_at_first_step(frame)
            and text(frame[PLAN].label) == self.label
        )


class EventBreakpoint(Breakpoint):
    """Stops before a plan is selected for an event that unifies with a pattern.

    Args:
        pattern: a trigger, such as ``+low``, ``+!go(_)`` or ``-battery(0)[source(percept)]``.
        agent: name of the agent. None for all.

    Raises:
        AslError: the pattern is not a trigger.
        UsageError: the pattern is a variable.
    """

    def __init__(self, pattern: str, agent: str | None = None) -> None:
        node = parse_trigger(pattern)
        self.pattern = pattern
        self._operator, self._kind = node.operator, node.kind
        names = Variables()
        self._pattern = lower_value(node.literal, names.__getitem__)
        self._functor = functor_of(self._pattern)
        if self._functor is None:
            raise UsageError(
                f"expected an event, found the variable `{pattern}`; write an event such as `+!go(_)`"
            )
        self.agent = agent
        self.text = pattern + (f" of {agent}" if agent is not None else "")

    def data(self) -> dict[str, Any]:
        return {"event": self.pattern, "agent": self.agent}

    def meets_event(self, agent: Circumstance, event: Event) -> bool:
        """Return whether the event unifies with the pattern. Events without a plan are noted when they occur."""
        goal = event[EVENT_GOAL]
        return (goal[0].kind != "" or agent.may_handle(goal[0])) and self.fits(
            agent, goal, event[EVENT_ANNOTATIONS]
        )

    def fits(self, agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> bool:
        """Return whether a goal, belief change or signal of an agent unifies with the pattern."""
        kind = goal[0]
        if kind.operator != self._operator or kind.kind != self._kind or kind.functor is not self._functor:
            return False
        if self.agent not in (None, agent.name):
            return False
        literal = literal_of(goal, annotations if annotations_of(self._pattern) else ())
        trail = Trail()
        try:
            return unify(self._pattern, literal, trail)
        finally:
            undo(trail, 0)


class ConditionBreakpoint(Breakpoint):
    """Stops when a condition of an agent becomes true. It is evaluated before each of the agent's events and steps.

    Args:
        condition: such as ``battery(B) & B < 20``.
        agent: name of the agent.

    Raises:
        AslError: the text is not a condition.
        UsageError: the condition calls an internal action that acts or waits.
    """

    def __init__(self, condition: str, agent: str) -> None:
        self._condition = Condition(condition)
        self.condition, self.agent = condition, agent
        self.text = f"{condition} of {agent}"
        self._held: bool | None = None
        self._values = ""

    @property
    def met(self) -> str:
        return f"{self.text} with {self._values}" if self._values else self.text

    def data(self) -> dict[str, Any]:
        return {"condition": self.condition, "agent": self.agent}

    def becomes_true(self, agent: Circumstance) -> bool:
        """Return whether the condition holds, and did not at the last evaluation. At the first one, return False."""
        if agent.name != self.agent:
            return False
        found = self._condition.answer(agent)
        before, self._held = self._held, found is not None
        if found is not None:
            self._values = ", ".join(f"{name}={value}" for name, value in found.items())
        return self._held and before is False

    def meets_event(self, agent: Circumstance, event: Event) -> bool:
        return self.becomes_true(agent)

    def meets_step(self, agent: Circumstance, intention: Intention) -> bool:
        return self.becomes_true(agent)


FAILURES: Mapping[str, str] = {
    "goal": "goal fails",
    "plan": "plan not found",
    "operation": "operation fails",
}
"""Kinds of failures, the most general one first, and how breakpoints for them are shown."""


class FailureBreakpoint(Breakpoint):
    """Stops after the step in which a goal failed, whether or not a plan handles the failure.

    Args:
        kind: one of `FAILURES`.

    Raises:
        UsageError: the kind is unknown.
    """

    def __init__(self, kind: str) -> None:
        if kind not in FAILURES:
            raise UsageError(f"unknown failure `{kind}`; expected {', '.join(FAILURES)}")
        self.kind, self.text = kind, FAILURES[kind]

    def data(self) -> dict[str, Any]:
        return {"failure": self.kind}


def is_at_first_step(frame: Frame) -> bool:
    """Return whether no step of the plan of a frame has run."""
    return frame[STEP] is frame[PLAN].first


def step_line(info: StepInfo | None) -> int:
    """Return the line of a step; 0 if it is unknown."""
    return info.node.span.line if info is not None and info.node.span is not None else 0


def first_line(frame: Frame) -> int:
    """Return the line of the next step if it is the first one of its plan on that line, else 0: a line stops a run once."""
    step: Any = frame[STEP]
    info: StepInfo | None = getattr(step, "info", None)
    line = step_line(info)
    if not line:
        return 0
    steps: dict[str, StepInfo] = getattr(step, "steps", frame[PLAN].steps)
    # A loop has one step for its beginning and one for its rounds, at the same location.
    at_line = (each for each in steps.values() if step_line(each) == line)
    first = min(at_line, key=lambda each: each.node.span.column if each.node.span is not None else 0)
    return line if first is info else 0


def head_lines(plan: Plan) -> range:
    """Return the lines from the beginning of a plan to the line before its first step; the whole plan without steps."""
    span, body = plan.node.span, plan.node.body
    if span is None:
        return range(0)
    steps = getattr(body, "steps", ())
    first = steps[0].span.line if steps and steps[0].span is not None else span.end_line + 1
    return range(span.line, first)


def lines_that_stop(plan: Plan) -> set[int]:
    """Return the lines of a plan, and of nested plans, where a `LineBreakpoint` can stop a run."""
    found = set(head_lines(plan))
    for body in nodes_in(nodes.Body, plan.node.body):
        found.update(step.span.line for step in body.steps if step.span is not None)
    for inner in plan.subplans:
        found |= lines_that_stop(inner)
    return found


def breakpoint_at(at: Mapping[str, Any]) -> Breakpoint:
    """Return the breakpoint for data.

    Args:
        at: ``{"line": {"file": F, "line": N}}``, ``{"plan": {"plan": LABEL, "agent": A}}``,
            ``{"event": TRIGGER, "agent": A}``, ``{"condition": CONDITION, "agent": A}`` or ``{"failure": KIND}``. The agent
            of plans and events is optional, as are ``condition``, ``hits`` and ``log`` of a line (`LineBreakpoint`).

    Raises:
        AslError: a trigger or condition has errors.
        UsageError: the data does not describe a breakpoint.
    """
    try:
        match at:
            case {"line": {"file": file, "line": line} as given}:
                qualified = (str(given.get(each) or "") for each in ("condition", "hits", "log"))
                return LineBreakpoint(str(file), int(line), *qualified)
            case {"plan": {"plan": label} as plan}:
                return PlanBreakpoint(str(label), plan.get("agent"))
            case {"event": pattern}:
                return EventBreakpoint(str(pattern), at.get("agent"))
            case {"condition": condition, "agent": str(agent)}:
                return ConditionBreakpoint(str(condition), agent)
            case {"failure": kind}:
                return FailureBreakpoint(str(kind))
            case {"condition": _}:
                raise UsageError("expected the name of an agent for a condition")
    except (TypeError, ValueError) as wrong:
        raise UsageError(f"invalid breakpoint: {dict(at)!r}") from wrong
    raise UsageError(f"invalid breakpoint: {dict(at)!r}; expected line, plan, event, condition or failure")
