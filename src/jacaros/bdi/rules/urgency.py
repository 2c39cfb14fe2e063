"""Urgency: which events and intentions of an agent go first, whatever waits before them.

A plan says it in its label, ``@bump[urgency(10)]``, or the agent's option ``urgency`` says it of all plans for events of
a name.  What is more urgent goes first, and among equals the order is Jason's.  The rules:

* A plan without such a word has urgency 0.
* An event is as urgent as the most urgent plan for events of its kind, applicable or not; one that an intention has
  posted is as urgent as this intention at least.
* An intention is as urgent as the most urgent plan on its stack.
* In each cycle the most urgent event is taken up, unless a more urgent intention is ready, and then the most urgent
  intention makes a step.
* Messages are read in their order, one in each cycle; but as soon as one about something urgent has come, all that came
  before it are read in the same cycle, and it too.  Percepts are always worked in all together.
* Atomic intentions are not interrupted.

The queues are plain as long as nothing in them is urgent, whatever plans there are.  What is urgent is noted before it is
queued: all that waits has urgency 0 then, so the queues are in order already, however long they are, and are kept so until
nothing urgent is left.  They are sorted only after a change of plans.  So an urgent plan costs unrelated events one look-up
in a table each.
"""

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Generic, TypeVar

from jacaros.bdi.rules.proc_msg import RECEIVED
from jacaros.bdi.rules.selections import Fair
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_GOAL, EVENT_INTENTION, Event
from jacaros.bdi.state.intention import PLAN, Intention
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.plan_library import concerns
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.terms.values import functor_of, is_list, list_items

Item = TypeVar("Item")

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
        "_orders_events",
        "_orders_intentions",
        "_ranked",
        "_urgent_messages",
    )

    def __init__(self, agent: Circumstance) -> None:
        super().__init__(agent)
        self._named = dict(agent.options.urgency)
        self._of_kinds = _OfKinds(self)
        self.urgencies: Mapping[Trigger, int] | None = self._of_kinds
        self._in_order = False
        self._orders_events = self._orders_intentions = True
        self._ranked = False
        self._urgent_messages = 0

    def look_anew(self) -> None:
        """Plans have come or gone, or the queues are filled anew."""
        self._of_kinds.clear()
        self._in_order = False
        self._urgent_messages = sum(self._of_message(message) > 0 for message in self.agent.incoming.messages)
        self.rank()

    def rank(self) -> None:
        """Something urgent comes into the queues: from the next cycle on it goes first."""
        if self._in_order and not self._ranked:
            self._queue_by(UrgentQueue)
        self._ranked, self.plain = True, False
        self.agent.incoming.called = True

    def _queue_by(self, kind: "type[CalmQueue[Any]]") -> None:
        """Make the queues ones of another kind, which the code that runs meanwhile may have at hand."""
        for queue in (self.agent.events, self.agent.intentions):
            if isinstance(queue, CalmQueue):
                queue.__class__ = kind

    # --- what comes into the queues ------------------------------------------------------------------------

    def note_intention(self, intention: Intention) -> None:
        """An intention that waited, was suspended or is new is about to be queued."""
        if not self._ranked and self.urgency_of(intention):
            self.rank()

    def note_message(self, message: SpeechAct) -> None:
        """A message is about to be queued."""
        if self._of_message(message):
            self._urgent_messages += 1
            self.rank()

    # --- the selection functions ---------------------------------------------------------------------------

    def select_messages(self) -> Sequence[SpeechAct]:
        """The oldest one; all up to the last about something urgent, when there is one."""
        inbox = self.agent.incoming.messages
        chosen = [inbox.popleft()]
        self._urgent_messages -= self._urgent_messages > 0 and self._of_message(chosen[0]) > 0
        while inbox and self._urgent_messages > 0:
            chosen.append(inbox.popleft())
            self._urgent_messages -= self._of_message(chosen[-1]) > 0
        return chosen

    def select_event(self) -> Event | None:
        """The most urgent one, unless an intention that is ready is more urgent."""
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
        """The most urgent one."""
        events, intentions = self._put_in_order()
        if self._ranked and not (self._urgent_messages or _holds_urgent(events) or _holds_urgent(intentions)):
            self._calm_down()
        return super().select_intention()

    def _put_in_order(self) -> "tuple[deque[Event], deque[Intention]]":
        """The queues; in order of urgency as long as something urgent is in them.

        They are sorted after a change of plans only, and not within it: code that runs meanwhile has the old ones at hand.
        """
        agent = self.agent
        if not self._in_order:
            self._in_order = True
            if self._orders_events:
                agent.events = UrgentQueue(self._of_event, agent.events)
            if self._orders_intentions:
                agent.intentions = UrgentQueue(self.urgency_of, agent.intentions)
        return agent.events, agent.intentions

    def _calm_down(self) -> None:
        """Nothing urgent is left."""
        self._ranked, self.plain = False, True
        self._queue_by(CalmQueue)

    def may_line_up(self, intention: Intention) -> bool:
        """Whether a new intention may have to wait until there are few."""
        return not self.urgency_of(intention)

    # --- how urgent something is ---------------------------------------------------------------------------

    def of_plan(self, plan: Plan) -> int:
        """The urgency of a plan: what the agent's option says of its event, else what its label says."""
        symbol = plan.trigger_functor() if self._named else None
        if symbol is None:
            return plan.urgency
        name = f"{symbol.namespace}::{symbol.name}" if symbol.namespace else symbol.name
        return self._named.get(name, plan.urgency)

    def _of_event(self, event: Event) -> int:
        urgency = self._of_kinds[event[EVENT_GOAL][0]]
        intention = event[EVENT_INTENTION]
        return urgency if intention is None else max(urgency, self.urgency_of(intention))

    def urgency_of(self, intention: Intention) -> int:
        """The urgency of the most urgent plan on the stack of an intention.

        What was found is noted for each frame with those below it, so that a deep stack is gone through once.
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
        """The urgency of the events that a message may lead to."""
        urgency = self._of_kinds[RECEIVED]
        kind = _TRIGGERS.get(message.performative)
        if kind is not None:
            content = message.content
            for item in list_items(content) if is_list(content) else (content,):
                symbol = functor_of(item)
                if symbol is not None:
                    urgency = max(urgency, self._of_kinds[trigger(*kind, symbol)])
        return urgency


class _OfKinds(dict[Trigger, int]):
    """The urgency of event kinds, worked out when it is first asked for."""

    def __init__(self, urgent: Urgent) -> None:
        super().__init__()
        self._urgent = urgent

    def __missing__(self, kind: Trigger) -> int:
        plans = _with_inner(self._urgent.agent.library.plans)
        self[kind] = max((self._urgent.of_plan(plan) for plan in plans if concerns(plan, kind)), default=0)
        return self[kind]


class CalmQueue(deque[Item], Generic[Item]):
    """A queue in which nothing is urgent: the first goes first.

    Args:
        urgency: of an item.
        items: the first ones.
    """

    __slots__ = ("_urgency",)

    def __init__(self, urgency: Callable[[Item], int], items: Iterable[Item] = ()) -> None:
        super().__init__(sorted(items, key=urgency, reverse=True))
        self._urgency = urgency


class UrgentQueue(CalmQueue[Item]):
    """A queue in which the more urgent stands before the less urgent, and equals in the order in which they came."""

    __slots__ = ()

    def first_urgency(self) -> int:
        """The urgency of the first item, which is the greatest; 0 without any."""
        return self._urgency(self[0]) if self else 0

    def append(self, item: Item) -> None:
        """Put an item behind those that are as urgent, or more."""
        urgency = self._urgency(item)
        # Nothing is below 0: what is not urgent needs no look at the others.
        if urgency == 0 or not self or self._urgency(self[-1]) >= urgency:
            super().append(item)
        else:
            self.insert(bisect_right(self, -urgency, key=lambda other: -self._urgency(other)), item)

    def extendleft(self, items: Iterable[Item]) -> None:
        """Put items back before those that are as urgent."""
        for item in items:
            self.insert(
                bisect_left(self, -self._urgency(item), key=lambda other: -self._urgency(other)), item
            )


def _holds_urgent(queue: "deque[Event] | deque[Intention]") -> bool:
    return isinstance(queue, UrgentQueue) and queue.first_urgency() > 0


def _with_inner(plans: Sequence[Plan]) -> Iterator[Plan]:
    for plan in plans:
        yield plan
        yield from _with_inner(plan.subplans)


def has_urgent_plans(agent: Circumstance) -> bool:
    """Whether a plan, or the agent's option, says that something is urgent."""
    return bool(agent.options.urgency) or any(plan.urgency for plan in _with_inner(agent.library.plans))


def plans_changed(agent: Circumstance) -> None:
    """See whether an agent has urgent plans; to be called whenever its plans have changed."""
    if not isinstance(agent.selections, Urgent):
        if not has_urgent_plans(agent):
            return
        agent.selections = Urgent(agent)
    agent.selections.look_anew()
