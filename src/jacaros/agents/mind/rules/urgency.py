"""Which message, event, plan and intention goes first: the fair agent, and urgency.

A plan sets it in its label, ``@bump[urgency(10)]``, or the agent's option ``urgency`` sets it for all plans for events
of a name. More urgent items go first; among equals the order is Jason's. The rules:

* A plan without an urgency has urgency 0.
* An event is as urgent as the most urgent plan for events of its kind, applicable or not; one that an intention has
  posted is at least as urgent as this intention.
* An intention is as urgent as the most urgent plan on its stack.
* In each cycle the most urgent event is handled, unless a more urgent intention is ready, and then the most urgent
  intention runs a step.
* Messages are read in order, one in each cycle. When an urgent one arrives, it and all earlier messages are read in the
  same cycle. Percepts are always taken in together.
* Atomic intentions are not interrupted.

The queues are plain as long as nothing in them is urgent, whatever plans there are. Urgent items are noted before they
are queued: all waiting items have urgency 0 then, so the queues are already in order, however long they are, and are
kept in order until nothing urgent is left. They are sorted only after a change of plans. So an urgent plan costs
unrelated events one table lookup each.
"""

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Generic, TypeVar

from jacaros.agents.mind.rules.body_steps import bindings_of, plan_term
from jacaros.agents.mind.rules.proc_msg import RECEIVED
from jacaros.agents.mind.rules.query import solve_formula
from jacaros.agents.mind.rules.searching import run
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.belief_base import SELECT_OPTION, Table
from jacaros.agents.mind.state.circumstance import Circumstance, Selections
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    EVENT_GOAL,
    EVENT_INTENTION,
    GOAL,
    PLAN,
    Event,
    Frame,
    Intention,
)
from jacaros.agents.mind.state.plan import Plan, every_plan
from jacaros.agents.mind.state.plan_library import concerns
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger, literal_of
from jacaros.agents.mind.state.triggers import trigger as event_kind
from jacaros.agents.terms.plans import trigger
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import Functor, Term, Var, functor_of, is_list, list_items

# The selection functions of a fair agent.
#
# They select the oldest message and event, the first applicable plan, and intentions in a circle. A program can filter the
# applicable plans with rules for ``select__option(Trigger, Intention, Plan, Bindings)``: the first plan for which they
# hold is selected. With the label annotation ``all_unifs``, every answer of the plan's context is an option, not only the
# first.


class OptionFilter(Table):
    """The beliefs and rules of an agent that filter applicable plans: from the first one on, they are asked."""

    __slots__ = ("_agent",)

    def __init__(self, functor: Functor, agent: Circumstance) -> None:
        super().__init__(functor, agent.beliefs)
        self._agent = agent

    def add(self, row: Any, annotations: tuple[Term, ...], last: bool = False) -> tuple[Term, ...] | None:
        """Put in an entry, see `Table.add`."""
        self._agent.unusual = True
        return super().add(row, annotations, last)


class Fair(Selections):
    """Takes what came first, and the first applicable plan that passes the rules that filter plans."""

    __slots__ = ()

    def __init__(self, agent: Circumstance) -> None:
        if SELECT_OPTION not in agent.beliefs:
            agent.beliefs[SELECT_OPTION] = OptionFilter(SELECT_OPTION, agent)
        super().__init__(agent, agent.beliefs[SELECT_OPTION])

    def select_option(
        self, goal: Goal, annotations: EventAnnotations, intention: Intention | None
    ) -> Frame | None:
        """Return the first applicable plan that passes the rules that filter plans."""
        agent = self.agent
        for frame in options(agent, goal, annotations):
            if _passes(agent, frame, intention):
                self.refused = False
                return frame
            self.refused = True
        return None


def options(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> Iterator[Frame]:
    """Yield the frames of all applicable plans, in program order; a frame is valid until the next one is requested."""
    agent.selections.refused = False
    every = agent.library.every_option(goal[0])
    return iter(()) if every is None else every(agent, goal, annotations)


def _passes(agent: Circumstance, frame: Frame, intention: Intention | None) -> bool:
    number: Term = Var("Intention") if intention is None else float(intention.id)
    operator = frame[GOAL][0].operator + frame[GOAL][0].kind
    rest = (number, plan_term(agent, frame[PLAN]), bindings_of(frame))
    # A rule may ask for annotations of the event, but most are written without.
    events = (literal_of(frame[GOAL], frame[ANNOTATIONS]), literal_of(frame[GOAL], ()))
    return any(_holds(agent, (SELECT_OPTION, trigger(operator, event), *rest)) for event in events)


def _holds(agent: Circumstance, question: Term) -> bool:
    mark = len(agent.trail)
    holds = any(True for _ in run(solve_formula(agent, question, agent.trail), agent.options.rule_depth))
    undo(agent.trail, mark)
    return holds


T = TypeVar("T")

_TRIGGERS = {
    "tell": ("+", ""),
    "signal": ("+", ""),
    "untell": ("-", ""),
    "achieve": ("+", "!"),
    "askOne": ("+", "?"),
    "askAll": ("+", "?"),
}
"""Operator and kind of the event that a message leads to."""


class Urgent(Fair):
    """The selection functions of an agent that has urgent plans.

    Args:
        agent: whose plans and options say how urgent things are.
    """

    __slots__ = (
        "_in_order",
        "_named",
        "_of_kinds",
        "_ranked",
        "_urgent_messages",
    )

    def __init__(self, agent: Circumstance) -> None:
        super().__init__(agent)
        self._named = dict(agent.options.urgency)
        self._of_kinds = _OfKinds(self)
        self.urgencies = self._of_kinds
        self._in_order = False
        self._ranked = False
        self._urgent_messages = 0

    def look_anew(self) -> None:
        """Handle added or removed plans, or refilled queues."""
        self._of_kinds.clear()
        self._in_order = False
        self._urgent_messages = sum(self._of_message(message) > 0 for message in self.agent.incoming.messages)
        self.rank()

    def rank(self) -> None:
        """Note that something urgent is about to be queued: from the next cycle on it goes first."""
        if self._in_order and not self._ranked:
            self._queue_by(UrgentQueue)
        self._ranked, self.plain = True, False
        self.agent.incoming.called = True

    def _queue_by(self, kind: "type[CalmQueue[Any]]") -> None:
        """Convert the queues to another kind; running code may still hold them."""
        for queue in (self.agent.events, self.agent.intentions):
            if isinstance(queue, CalmQueue):
                queue.__class__ = kind

    # --- what comes into the queues ------------------------------------------------------------------------

    def note_intention(self, intention: Intention) -> None:
        """Note an intention that waited, was suspended or is new, and is about to be queued."""
        if not self._ranked and self.urgency_of(intention):
            self.rank()

    def note_message(self, message: SpeechAct) -> None:
        """Note a message that is about to be queued."""
        if self._of_message(message):
            self._urgent_messages += 1
            self.rank()

    # --- the selection functions ---------------------------------------------------------------------------

    def select_messages(self) -> Sequence[SpeechAct]:
        """Return the oldest message; if urgent ones wait, all up to the last urgent one."""
        inbox = self.agent.incoming.messages
        chosen = [inbox.popleft()]
        self._urgent_messages -= self._urgent_messages > 0 and self._of_message(chosen[0]) > 0
        while inbox and self._urgent_messages > 0:
            chosen.append(inbox.popleft())
            self._urgent_messages -= self._of_message(chosen[-1]) > 0
        return chosen

    def select_event(self) -> Event | None:
        """Return the most urgent event, unless an intention that is ready is more urgent."""
        events, intentions = self._put_in_order()
        if (
            events
            and intentions
            and isinstance(events, UrgentQueue)
            and isinstance(intentions, UrgentQueue)
            and self._of_event(events[0]) < self.urgency_of(intentions[0])
        ):
            return None
        return super().select_event()

    def select_intention(self) -> Intention | None:
        """Return the most urgent intention."""
        events, intentions = self._put_in_order()
        if self._ranked and not (self._urgent_messages or _holds_urgent(events) or _holds_urgent(intentions)):
            self._calm_down()
        return super().select_intention()

    def _put_in_order(self) -> "tuple[deque[Event], deque[Intention]]":
        """Return the queues; in order of urgency while they contain something urgent.

        They are sorted only after a change of plans, and not during it: running code still holds the old ones.
        """
        agent = self.agent
        if not self._in_order:
            self._in_order = True
            agent.events = UrgentQueue(self._of_event, agent.events)
            agent.intentions = UrgentQueue(self.urgency_of, agent.intentions)
        return agent.events, agent.intentions

    def _calm_down(self) -> None:
        """Switch back to plain queues: nothing urgent is left."""
        self._ranked, self.plain = False, True
        self._queue_by(CalmQueue)

    # --- how urgent something is ---------------------------------------------------------------------------

    def of_plan(self, plan: Plan) -> int:
        """Return the urgency of a plan: from the agent's option for its event, else from its label."""
        symbol = plan.trigger_functor() if self._named else None
        if symbol is None:
            return plan.urgency
        name = f"{symbol.namespace}::{symbol.name}" if symbol.namespace else symbol.name
        return self._named.get(name, plan.urgency)

    def _of_event(self, event: Event) -> int:
        goal, intention = event[EVENT_GOAL], event[EVENT_INTENTION]
        urgency = self._of_kinds[goal[0]]
        if goal[0] is RECEIVED:
            urgency = max(urgency, self._of_content(text(goal[2]), goal[3]))
        return urgency if intention is None else max(urgency, self.urgency_of(intention))

    def urgency_of(self, intention: Intention) -> int:
        """Return the urgency of the most urgent plan on the stack of an intention.

        The result is noted for each frame with those below it, so that a deep stack is walked only once.
        """
        frames = intention.frames
        try:
            known = intention.urgencies
        except AttributeError:
            known = intention.urgencies = []
        del known[len(frames) :]
        while known and known[-1][0] is not frames[len(known) - 1]:
            known.pop()
        urgency = known[-1][1] if known else 0
        for frame in frames[len(known) :]:
            urgency = max(urgency, self.of_plan(frame[PLAN]))
            known.append((frame, urgency))
        return urgency

    def _of_message(self, message: SpeechAct) -> int:
        """Return the urgency of the events that a message may lead to."""
        return max(self._of_kinds[RECEIVED], self._of_content(message.performative, message.content))

    def _of_content(self, performative: str, content: Term) -> int:
        urgency = 0
        kind = _TRIGGERS.get(performative)
        if kind is not None:
            for item in list_items(content) if is_list(content) else (content,):
                symbol = functor_of(item)
                if symbol is not None:
                    urgency = max(urgency, self._of_kinds[event_kind(*kind, symbol)])
        return urgency


class _OfKinds(dict[Trigger, int]):
    """The urgency of event kinds, computed on first use."""

    def __init__(self, urgent: Urgent) -> None:
        super().__init__()
        self._urgent = urgent

    def __missing__(self, kind: Trigger) -> int:
        plans = every_plan(self._urgent.agent.library.plans)
        self[kind] = max((self._urgent.of_plan(plan) for plan in plans if concerns(plan, kind)), default=0)
        return self[kind]


class CalmQueue(deque[T], Generic[T]):
    """A queue in which nothing is urgent: the first goes first.

    Args:
        urgency: of an item.
        items: the first ones.
    """

    __slots__ = ("urgency",)

    def __init__(self, urgency: Callable[[T], int], items: Iterable[T] = ()) -> None:
        super().__init__(sorted(items, key=urgency, reverse=True))
        self.urgency = urgency


class UrgentQueue(CalmQueue[T]):
    """A queue ordered by urgency, and by arrival among equals."""

    __slots__ = ()

    def first_urgency(self) -> int:
        """Return the urgency of the first item, which is the greatest; 0 without any."""
        return self.urgency(self[0]) if self else 0

    def append(self, item: T) -> None:
        """Put an item after those that are as urgent or more."""
        urgency = self.urgency(item)
        # Nothing is below 0, so items that are not urgent need no comparison.
        if urgency == 0 or not self or self.urgency(self[-1]) >= urgency:
            super().append(item)
        else:
            self.insert(bisect_right(self, -urgency, key=lambda other: -self.urgency(other)), item)

    def extendleft(self, items: Iterable[T]) -> None:
        """Put items back before those that are as urgent."""
        for item in items:
            self.insert(bisect_left(self, -self.urgency(item), key=lambda other: -self.urgency(other)), item)


def _holds_urgent(queue: "deque[Event] | deque[Intention]") -> bool:
    return isinstance(queue, UrgentQueue) and queue.first_urgency() > 0


def has_urgent_plans(agent: Circumstance) -> bool:
    """Return whether a plan, or the agent's option, makes something urgent."""
    return bool(agent.options.urgency) or any(plan.urgency for plan in every_plan(agent.library.plans))


def plans_changed(agent: Circumstance) -> None:
    """Check whether an agent has urgent plans; to be called whenever its plans have changed."""
    if not isinstance(agent.selections, Urgent):
        if not has_urgent_plans(agent):
            return
        agent.selections = Urgent(agent)
    agent.selections.look_anew()
