"""Records of deliberations: which plan an agent took for an event, and why none of those before it."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

from jacaros.bdi.explaining.failing_context import FailingContexts
from jacaros.bdi.mind import Mind
from jacaros.bdi.state.intention import PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Goal, Trigger
from jacaros.mas.history.programs import PlanNumbers
from jacaros.mas.history.words import shown_event
from jacaros.trace import Cause, Tracer

PER_SECOND = 10
"""Contexts of one agent that are examined in a second of the run's clock; each costs some 50 microseconds."""
IN_ALL = 100
"""The same for all agents of a run."""
MOST_OPTIONS = 12
"""Plans of one deliberation that are examined."""

Tell = Callable[[str, Mapping[str, Any]], None]


class Links(Tracer, Protocol):
    """Makes the links of chains, and records them (`jacaros.mas.history.causes.CauseRecords`)."""

    def need(self, cause: Cause) -> None:
        """Record a link and those that led to it."""


class _Reason(NamedTuple):
    """What led to the plan of a frame.

    Attributes:
        depth: number of frames before it was put on the stack, or replaced the top of it (tail call).
        frame: of the plan.
        link: of the deliberation that took it.
    """

    depth: int
    frame: Frame
    link: Cause

    def is_on(self, frames: list[Frame]) -> bool:
        """Whether the frame is still on a stack."""
        return any(each is self.frame for each in frames[max(0, self.depth - 1) : self.depth + 1])


class Allowance:
    """Allows something so often in a second of the run's clock.

    Args:
        t: seconds of the run's clock.
        most: how often.
    """

    def __init__(self, t: Callable[[], float], most: int) -> None:
        self._t, self._most = t, most
        self._second, self._taken = -1, 0

    def take(self) -> bool:
        """Whether it is allowed once more."""
        second = int(self._t())
        if second != self._second:
            self._second, self._taken = second, 0
        self._taken += 1
        return self._taken <= self._most


class DeliberationRecords:
    """Records the deliberations of one agent, and keeps what led to the plans on its stacks.

    Args:
        mind: of the agent.
        numbers: of its plans.
        links: makes the links.
        t: seconds of the run's clock.
        in_all: allows contexts of all agents to be examined.
        tell: takes the kind of a record and its data.
    """

    def __init__(
        self,
        mind: Mind,
        numbers: PlanNumbers,
        links: Links,
        t: Callable[[], float],
        in_all: Allowance,
        tell: Tell,
    ) -> None:
        self._mind, self._numbers, self._links, self._tell = mind, numbers, links, tell
        self._in_all = in_all
        self._reasons: dict[int, list[_Reason]] = {}
        """By intention, what led to the plans on its stack, the lowest first."""
        self._candidates: dict[Trigger, list[Plan]] = {}
        self._allowance = Allowance(t, PER_SECOND)

    def plans_changed(self) -> None:
        """Look for candidates anew."""
        self._candidates.clear()

    def cause_of(self, intention: Intention) -> Cause | None:
        """Return what led to the plan on top of an intention."""
        reasons = self._reasons.get(intention.id)
        while reasons and not reasons[-1].is_on(intention.frames):
            reasons.pop()
        return reasons[-1].link if reasons else intention.cause

    def selected(
        self,
        goal: Goal,
        annotations: EventAnnotations,
        intention: Intention | None,
        frame: Frame | None,
        cause: Cause | None,
    ) -> Cause | None:
        """Record a deliberation, see `jacaros.bdi.state.observing.MindObserver`."""
        plans = self._plans_for(goal[0])
        if not plans and frame is None and not goal[0].kind:
            return cause  # nobody asked for this event
        parent = self.cause_of(intention) if intention is not None else cause
        trigger = shown_event(goal)
        link = self._links.link("event", trigger, parent)
        if intention is not None and frame is not None:
            reason = _Reason(len(intention.frames), frame, link)
            self._reasons.setdefault(intention.id, []).append(reason)
        if parent is not None:
            self._links.need(parent)
        chosen = None if frame is None else frame[PLAN]
        place = plans.index(chosen) if chosen in plans else len(plans) if chosen is None else 0
        record = {
            "id": link.id,
            "parent": link.parent,
            "agent": self._mind.name,
            "trigger": trigger,
            "intention": None if intention is None else intention.id,
            "chosen": None if chosen is None else self._numbers[chosen],
            "options": self._options(goal, annotations, plans[:place]),
            "untried": [self._numbers[plan] for plan in plans[place + 1 :]],
        }
        self._tell("deliberation", record)
        return link

    def _plans_for(self, kind: Trigger) -> list[Plan]:
        found = self._candidates.get(kind)
        if found is None:
            found = self._candidates[kind] = self._mind.library.relevant(kind)
        return found

    def _options(
        self, goal: Goal, annotations: EventAnnotations, plans: list[Plan]
    ) -> list[dict[str, object]]:
        options: list[dict[str, object]] = []
        if not plans:
            return options
        contexts = FailingContexts(self._mind, goal, annotations)
        for plan in plans[:MOST_OPTIONS]:
            if not (self._allowance.take() and self._in_all.take()):
                break
            if contexts.fits(plan):
                options.append({"plan": self._numbers[plan], "why": contexts.stop(plan)})
        return options

    def forget(self) -> None:
        """Forget the stacks of intentions that are over."""
        for number in [number for number in self._reasons if number not in self._mind.alive]:
            del self._reasons[number]
