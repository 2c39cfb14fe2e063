"""Records of deliberations: the plan that an agent chose for an event, and why it rejected those before it."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import FailingContexts
from jacaros.agents.mind.state.intention import PLAN, Frame, Intention
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.mas.history.causes import CauseRecords
from jacaros.mas.history.programs import PlanNumbers
from jacaros.mas.history.words import shown_event
from jacaros.runtime.trace import Cause

PER_SECOND = 10
"""Maximum number of contexts of one agent that are examined per second of the run's clock, at about 50 µs each."""
IN_ALL = 100
"""The same limit for all agents of a run."""
MOST_OPTIONS = 12
"""Maximum number of plans of one deliberation that are examined."""

Tell = Callable[[str, Mapping[str, Any]], None]


class _Reason(NamedTuple):
    """The cause of the plan of a frame.

    Attributes:
        depth: number of frames below it when it was pushed, or replaced the top of the stack (tail call).
        frame: frame of the plan.
        link: link of the deliberation that chose it.
    """

    depth: int
    frame: Frame
    link: Cause

    def is_on(self, frames: list[Frame]) -> bool:
        """Return whether the frame is still on a stack."""
        return any(each is self.frame for each in frames[max(0, self.depth - 1) : self.depth + 1])


class Allowance:
    """Limits how often something happens per second of the run's clock.

    Args:
        t: returns seconds of the run's clock.
        most: the limit.
    """

    def __init__(self, t: Callable[[], float], most: int) -> None:
        self._t, self._most = t, most
        self._second, self._taken = -1, 0

    def take(self) -> bool:
        """Return whether it is allowed once more."""
        second = int(self._t())
        if second != self._second:
            self._second, self._taken = second, 0
        self._taken += 1
        return self._taken <= self._most


class DeliberationRecords:
    """Records the deliberations of one agent, and keeps the causes of the plans on its stacks.

    Args:
        mind: mind of the agent.
        numbers: numbers of its plans.
        links: creates links.
        t: returns seconds of the run's clock.
        in_all: limits the contexts of all agents that are examined.
        tell: takes the kind of a record and its data.
    """

    def __init__(
        self,
        mind: Mind,
        numbers: PlanNumbers,
        links: CauseRecords,
        t: Callable[[], float],
        in_all: Allowance,
        tell: Tell,
    ) -> None:
        self._mind, self._numbers, self._links, self._tell = mind, numbers, links, tell
        self._in_all = in_all
        self._reasons: dict[int, list[_Reason]] = {}
        """By intention, the causes of the plans on its stack, the lowest first."""
        self._candidates: dict[Trigger, list[Plan]] = {}
        self._allowance = Allowance(t, PER_SECOND)

    def plans_changed(self) -> None:
        """Compute the candidates again."""
        self._candidates.clear()

    def cause_of(self, intention: Intention) -> Cause | None:
        """Return the cause of the plan on top of an intention."""
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
        """Record a deliberation. See `jacaros.agents.mind.state.act.MindObserver`."""
        plans = self._plans_for(goal[0])
        if not plans and frame is None and not goal[0].kind:
            return cause  # no plan is relevant for this event
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
        """Forget the stacks of finished intentions."""
        for number in [number for number in self._reasons if number not in self._mind.alive]:
            del self._reasons[number]
