"""Records of intentions: changes in those of agents that had a turn, at most ten times a second."""

from collections.abc import Callable, Sequence
from itertools import chain, repeat
from operator import is_
from typing import Any, NamedTuple

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.mind.actions.goals import TIME
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import Place, place_of_call
from jacaros.agents.mind.rules.urgency import Urgent
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.agents.mind.state.pending import (
    ASK,
    GOAL_CONDITION,
    CoroutineWait,
    PendingCondition,
    PendingEvent,
    Waiting,
    is_action,
)
from jacaros.agents.mind.state.plan import Plan, StepInfo
from jacaros.agents.mind.state.triggers import Goal, literal_of
from jacaros.agents.terms.substitution import is_ground
from jacaros.agents.terms.values import Term, annotations_of
from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import cut, named, shown, shown_event
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.mas.history.programs import PlanNumbers
from jacaros.runtime.trace import Cause

PERIOD = 0.1
"""Seconds of the run's clock between two checks of an agent."""
MOST = 100
"""Maximum number of intentions of one agent that are checked."""
DEEPEST = 24
"""Maximum number of recorded goals of a stack: the lowest one, and those next to the top."""
MOST_AGENTS = 50
"""Maximum number of agents that are checked per period. Of thousands of busy agents, some are checked later."""

Moments = Callable[..., float]
"""Returns the seconds from the beginning of the run to a moment of its clock (default: now), with millisecond precision."""


class Looks:
    """Checks agents that had a turn, `PERIOD` seconds after the first of them had it.

    Args:
        clock: clock of the run.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._due: list[Callable[[], None]] = []
        self._timer: Timer | None = None

    def soon(self, look: Callable[[], None]) -> None:
        """Call *look*, which checks an agent, soon."""
        self._due.append(look)
        if self._timer is None:
            self._timer = self._clock.call_later(PERIOD, self.look)

    def look(self) -> None:
        """Check the agents that are due now."""
        self.stop()
        due, self._due = self._due[:MOST_AGENTS], self._due[MOST_AGENTS:]
        if self._due:
            self._timer = self._clock.call_later(PERIOD, self.look)
        for look in due:
            look()

    def stop(self) -> None:
        """Stop checking until an agent has a turn."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class _Level(NamedTuple):
    """A level of a stack as recorded. Without variables in its goals, it is valid until its step changes."""

    frame: Frame
    above: Frame | None
    step: object
    lasting: bool
    data: records.StackedGoal

    def is_still(self, frame: Frame, above: Frame | None) -> bool:
        """Return whether nothing of it has changed."""
        return self.lasting and self.frame is frame and self.above is above and self.step is frame[STEP]


class _Seen(NamedTuple):
    """What was recorded of an intention: the levels of its stack, and what changes with it, compared by identity."""

    depth: int
    parts: tuple[object, ...]
    levels: list[_Level]


class IntentionRecords:
    """Records the longer intentions of one agent. Those that begin and end between two checks are left out.

    Args:
        mind: mind of the agent.
        numbers: numbers of its plans.
        cause: returns the cause of an intention's current step.
        t: returns times.
        tell: takes the records.
        looks: checks the agent after its turns.
    """

    def __init__(
        self,
        mind: Mind,
        numbers: PlanNumbers,
        cause: Callable[[Intention], Cause | None],
        t: Moments,
        tell: RecordSink,
        looks: Looks,
    ) -> None:
        self._mind, self._cause, self._t = mind, cause, t
        self._numbers, self._tell, self._looks = numbers, tell, looks
        self._seen: dict[int, _Seen] = {}
        self._is_due = False

    def had_turn(self) -> None:
        """Schedule a check of the agent."""
        if not self._is_due:
            self._is_due = True
            self._looks.soon(self.look)

    def look(self) -> None:
        """Record the intentions that have changed since the last check, and those that have ended."""
        self._is_due = False
        alive = self._mind.alive
        for number in [number for number in self._seen if number not in alive]:
            del self._seen[number]
            self._tell(records.IntentionRecord(self._mind.name, number, "over"))
        for _, intention in zip(range(MOST), list(alive.values()), strict=False):
            if frames := intention.frames:
                parts = frames[-1], frames[-1][STEP], intention.waiting, intention.suspended
                seen = self._seen.get(intention.id)
                if seen is None or seen.depth != len(frames) or not all(map(is_, seen.parts, parts)):
                    levels = self._levels(frames, seen.levels if seen is not None else ())
                    self._seen[intention.id] = _Seen(len(frames), parts, levels)
                    self._record(intention, [each.data for each in levels])

    def _levels(self, frames: Sequence[Frame], known: Sequence[_Level]) -> list[_Level]:
        """Return the goals of a stack from the bottom up, with their current steps."""
        levels = levels_of(frames)
        if len(levels) > DEEPEST:
            levels = [levels[0], *levels[1 - DEEPEST :]]
        return [
            before if before is not None and before.is_still(*level) else self._level(*level)
            for before, level in zip(chain(known, repeat(None)), levels, strict=False)
        ]

    def _level(self, frame: Frame, above: Frame | None) -> _Level:
        plan: Plan = frame[PLAN]
        span = place_in_stack(frame, above)
        if above is None:
            step, lasting = step_of(frame), False
        else:
            step = shown_goal(above)
            lasting = all(is_ground(literal_of(each[GOAL], ())) for each in (frame, above))
        file, line = (plan.file, 0) if span is None else (span.file.name, span.line)
        data = records.StackedGoal(shown_goal(frame), self._numbers[plan], file, line, step)
        return _Level(frame, above, frame[STEP], lasting, data)

    def _record(self, intention: Intention, stack: list[records.StackedGoal]) -> None:
        waiting, suspended, cause = intention.waiting, intention.suspended, self._cause(intention)
        self._tell(
            records.IntentionRecord(
                self._mind.name,
                intention.id,
                "suspended" if suspended is not None else "waits" if waiting is not None else "runs",
                stack,
                "" if waiting is None or waiting.ended else waits_for(waiting),
                self._t(None if waiting is None else waiting.began),
                "" if suspended is None else shown(suspended),
                self._urgency(intention),
                0 if cause is None else cause.id,
            )
        )

    def _urgency(self, intention: Intention) -> int:
        selections = self._mind.selections
        if not isinstance(selections, Urgent):
            return 0
        return max(selections.of_plan(frame[PLAN]) for frame in intention.frames)


def levels_of(frames: Sequence[Frame]) -> list[tuple[Frame, Frame | None]]:
    """Return the visible frames of a stack from the bottom up, each with the one above it."""
    frames = [frame for frame in frames if frame[GOAL][0].functor.namespace != "jacaros"]
    # A goal from outside that has not had its turn has no frame of a plan yet.
    return list(zip(frames, [*frames[1:], None], strict=False))


def place_in_stack(frame: Frame, above: Frame | None) -> Span | None:
    """Return where the plan of a frame is: at its next step, or where it called the goal of the frame above it."""
    return _span(frame) if above is None else place_of_call(frame, above[GOAL][0].functor)


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
    span, plan = _span(frame), {"plan": numbers[frame[PLAN]]}
    return plan if span is None else {**plan, "file": span.file.name, "line": span.line}


def place_of_step(intention: Intention) -> tuple[Goal, str, int]:
    """Return the goal or event that the current step of an intention is for, its file and line."""
    frame = intention.frames[-1]
    span = _span(frame)
    return (frame[GOAL], *((frame[PLAN].file, 0) if span is None else (span.file.name, span.line)))


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


# ---- waits


def waits_for(waiting: Waiting) -> str:
    """Return what ends a wait."""
    if waiting.act is not None:
        return _act(waiting)
    if isinstance(waiting, CoroutineWait):
        return f"the Python coroutine {shown(waiting.reason)}"
    if waiting.reason in (ASK, GOAL_CONDITION):
        return "an answer" if waiting.reason is ASK else "the condition of its goal"
    kinds = {type(each) for each in waiting.pending}
    what = "the event " if PendingEvent in kinds else "the condition " if PendingCondition in kinds else ""
    return f"{what}{shown(_awaited(waiting))}" if what else _time(waiting)


def _awaited(waiting: Waiting) -> Term:
    """Return the subject of a ``.wait``. See `jacaros.agents.mind.actions.goals`."""
    found = annotations_of(waiting.reason)
    return found[0] if found else waiting.reason


def _time(waiting: Waiting) -> str:
    awaited = _awaited(waiting)
    if awaited.__class__ is tuple and awaited[0] is TIME and isinstance(awaited[1], float):
        return f"{awaited[1] / 1000:g} s"
    return shown(awaited)


def _act(waiting: Waiting) -> str:
    reason = waiting.reason
    if reason.__class__ is tuple and not is_action(reason):  # needs(wheels)
        return f"the resource{'s' if len(reason) > 2 else ''} {', '.join(map(shown, reason[1:]))}"
    return f"the action {shown(reason[1] if reason.__class__ is tuple else reason)}"
