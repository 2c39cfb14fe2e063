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

The queues are plain as long as nothing in them is urgent, whatever plans there are.  Code that adds something urgent notes
it (`Urgency.rank`).  The next cycle then puts the queues in order, and they are kept in order until nothing urgent is
left.  So an urgent plan costs unrelated events one look-up in a table each.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Generic, TypeVar

from jacaros.bdi.rules.proc_msg import RECEIVED, read_message
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


class Urgency:
    """How urgent things are for one agent.

    Args:
        agent: whose plans and options say so.

    Attributes:
        by_trigger: the urgency of the most urgent plan for each event kind, sub-plans included.
    """

    def __init__(self, agent: Circumstance) -> None:
        self._agent = agent
        self._named = dict(agent.options.urgency)
        self.by_trigger = _ByTrigger(self.of_plan, agent)
        self._looked_at = 0
        self._to_read = 0

    def forget(self) -> None:
        """Plans have come or gone."""
        self.by_trigger.clear()

    def rank(self) -> None:
        """Something urgent comes into the queues: from the next cycle on they are in order of urgency."""
        self._agent.urgent = self._agent.called = True

    def note_goal(self, kind: Trigger) -> None:
        """An event of a kind is about to be queued, or handled at once."""
        if self.by_trigger[kind]:
            self.rank()

    def note_event(self, event: Event) -> None:
        """An event is about to be queued."""
        if self.by_trigger[event[EVENT_GOAL][0]] or (
            (intention := event[EVENT_INTENTION]) is not None and self.of_intention(intention)
        ):
            self.rank()

    def note_intention(self, intention: Intention) -> None:
        """An intention that waited, was suspended or is new is about to be queued."""
        if self.of_intention(intention):
            self.rank()

    def settle(self) -> None:
        """Put the queues in order of urgency, or make them plain again when nothing urgent is left in them.

        Queues from which the agent's class chooses stay as they are.
        """
        agent = self._agent
        if agent.events.__class__ is deque:
            agent.events = UrgentQueue(self.of_event, agent.events)
        if agent.intentions.__class__ is deque:
            agent.intentions = UrgentQueue(self.of_intention, agent.intentions)
        if not (self._holds_urgent(agent.events) or self._holds_urgent(agent.intentions)):
            agent.urgent = False
            if isinstance(agent.events, UrgentQueue):
                agent.events = deque(agent.events)
            if isinstance(agent.intentions, UrgentQueue):
                agent.intentions = deque(agent.intentions)

    def _holds_urgent(self, queue: "deque[Event] | deque[Intention]") -> bool:
        return isinstance(queue, UrgentQueue) and bool(queue) and queue.first_urgency() > 0

    def of_plan(self, plan: Plan) -> int:
        """The urgency of a plan: what the agent's option says of its event, else what its label says."""
        symbol = plan.trigger_functor() if self._named else None
        if symbol is None:
            return plan.urgency
        name = f"{symbol.namespace}::{symbol.name}" if symbol.namespace else symbol.name
        return self._named.get(name, plan.urgency)

    def of_event(self, event: Event) -> int:
        """The urgency of an event, not below that of the intention that posted it."""
        urgency = self.by_trigger[event[EVENT_GOAL][0]]
        intention = event[EVENT_INTENTION]
        return urgency if intention is None else max(urgency, self.of_intention(intention))

    def of_intention(self, intention: Intention) -> int:
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

    def of_message(self, message: SpeechAct) -> int:
        """The urgency of the events that a message may lead to."""
        urgency = self.by_trigger[RECEIVED]
        kind = _TRIGGERS.get(message.performative)
        if kind is not None:
            content = message.content
            for item in list_items(content) if is_list(content) else (content,):
                symbol = functor_of(item)
                if symbol is not None:
                    urgency = max(urgency, self.by_trigger[trigger(*kind, symbol)])
        return urgency

    def messages_to_read(self) -> int:
        """How many messages are to be read in this cycle: one, or all up to the last about something urgent."""
        inbox = self._agent.inbox
        if inbox.__class__ is not deque:
            # The agent's class chooses its messages itself.
            return 1
        for place in range(self._looked_at, len(inbox)):
            if self.of_message(inbox[place]) > 0:
                self._to_read = place + 1
        count = max(1, self._to_read)
        self._looked_at, self._to_read = len(inbox) - count, 0
        return count

    def may_take_event(self) -> bool:
        """Whether the next event has its turn: while a more urgent intention is ready it waits."""
        events, intentions = self._agent.events, self._agent.intentions
        if not (intentions and isinstance(events, UrgentQueue) and isinstance(intentions, UrgentQueue)):
            return True
        return self.of_event(events[0]) >= self.of_intention(intentions[0])


class _ByTrigger(dict[Trigger, int]):
    """The urgency of event kinds, worked out when it is first asked for."""

    def __init__(self, of_plan: Callable[[Plan], int], agent: Circumstance) -> None:
        super().__init__()
        self._of_plan, self._agent = of_plan, agent

    def __missing__(self, kind: Trigger) -> int:
        plans = _with_inner(self._agent.library.plans)
        urgency = max((self._of_plan(plan) for plan in plans if concerns(plan, kind)), default=0)
        self[kind] = urgency
        return urgency


class UrgentQueue(deque[Item], Generic[Item]):
    """A queue in which the more urgent stands before the less urgent, and equals in the order in which they came."""

    def __init__(self, urgency: Callable[[Item], int], items: Iterable[Item] = ()) -> None:
        super().__init__(sorted(items, key=urgency, reverse=True))
        self._urgency = urgency

    def first_urgency(self) -> int:
        """The urgency of the first item, which is the greatest."""
        return self._urgency(self[0])

    def append(self, item: Item) -> None:
        """Put an item behind those that are as urgent, or more."""
        urgency = self._urgency(item)
        # Nothing is below 0: what is not urgent needs no look at the others.
        if urgency == 0 or not self or self._urgency(self[-1]) >= urgency:
            super().append(item)
            return
        low, high = 0, len(self) - 1
        while low < high:
            middle = (low + high) // 2
            if self._urgency(self[middle]) >= urgency:
                low = middle + 1
            else:
                high = middle
        self.insert(low, item)

    def extendleft(self, items: Iterable[Item]) -> None:
        """Put items back before those that are as urgent."""
        for item in items:
            urgency = self._urgency(item)
            place = next((i for i, other in enumerate(self) if self._urgency(other) <= urgency), len(self))
            self.insert(place, item)

    def sort(self) -> None:
        """Bring the items into their order again: their urgency is another now."""
        items = sorted(self, key=self._urgency, reverse=True)
        self.clear()
        self.extend(items)


def _with_inner(plans: Sequence[Plan]) -> Iterator[Plan]:
    for plan in plans:
        yield plan
        yield from _with_inner(plan.subplans)


def has_urgent_plans(agent: Circumstance) -> bool:
    """Whether a plan, or the agent's option, says that something is urgent."""
    return bool(agent.options.urgency) or any(plan.urgency for plan in _with_inner(agent.library.plans))


def plans_changed(agent: Circumstance) -> None:
    """See whether an agent has urgent plans; to be called whenever its plans have changed."""
    if agent.urgency is not None:
        agent.urgency.forget()
    elif has_urgent_plans(agent):
        agent.urgency = Urgency(agent)
    else:
        return
    agent.urgency.rank()
    # In the next cycle: the step that is being made has the queues in its hands.
    agent.do_soon(_sort)


def _sort(agent: Circumstance) -> None:
    """Bring queues that are in order of urgency into order again: plans have come or gone."""
    for queue in (agent.events, agent.intentions):
        if isinstance(queue, UrgentQueue):
            queue.sort()


def read_urgent_messages(agent: Any) -> None:
    """Read the message whose turn it is; all up to the last about something urgent, when there is one."""
    for _ in range(agent.urgency.messages_to_read()):
        read_message(agent)
