"""Records of one mind: its plans, beliefs, deliberations, messages and intentions, with their causes."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import FailingContexts
from jacaros.agents.mind.rules.meta_events import observe_mind
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.intention import PLAN, Frame, Intention
from jacaros.agents.mind.state.plan import OpenFact, Plan, Rule
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.terms.values import Annotated, Annotations, Functor, Term, atom
from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import shown, shown_event
from jacaros.runtime.mas.history.causes import CauseRecords
from jacaros.runtime.mas.history.intentions import IntentionRecords, Looks, Moments, place_of
from jacaros.runtime.mas.history.programs import ProgramRecords
from jacaros.runtime.trace import Cause

PER_SECOND = 10
"""Maximum number of contexts of one agent that are examined per second of the run's clock, at about 50 µs each."""
IN_ALL = 100
"""The same limit for all agents of a run."""
_FORGOTTEN = 100
"""Number of finished intentions whose causes are forgotten at once."""
MOST_OPTIONS = 12
"""Maximum number of plans of one deliberation that are examined."""


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


class RateLimit:
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


KEPT = 5_000
"""Number of messages that are kept until they are read or answered."""


class MessageRecords:
    """Records each message when it is sent, and when it is read.

    Args:
        links: creates the links of causal chains.
        cause: returns the cause of what the agent with a name is doing.
        tell: takes the records.
    """

    def __init__(self, links: CauseRecords, cause: Callable[[str], Cause | None], tell: RecordSink) -> None:
        self._links, self._cause, self._tell = links, cause, tell
        self._known: dict[str, Cause] = {}

    def sent(self, message: SpeechAct, cause: Cause | None = None) -> None:
        """Record a delivered message. *cause* led to it in another system."""
        if cause is not None:
            self._links.need(cause)
        else:
            cause = self._cause(message.sender) or self._known.get(message.in_reply_to or "")
        told = f"{message.sender} -> {message.receiver} {message.performative} {shown(message.content)}"
        link = self._links.link("message", told, cause)
        self._known[message.id] = link
        if len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        self._record(message, link, "sent")

    def read(self, message: SpeechAct) -> Cause | None:
        """Record that a message is read. Return its link, or None if its sending was not observed."""
        link = self._known.get(message.id)
        if link is not None:
            self._record(message, link, "read")
        return link

    def _record(self, message: SpeechAct, link: Cause, state: str) -> None:
        question = self._known.get(message.in_reply_to) if message.in_reply_to is not None else None
        self._tell(
            records.MessageRecord(
                link.id,
                message.sender,
                message.receiver,
                message.performative,
                shown(message.content),
                None if question is None else question.id,
                state,
                link.parent,
            )
        )


MOST_BELIEFS = 1000
"""Maximum number of beliefs of one agent that are recorded when its observation begins."""

_NOTHING = atom("nothing")


class Shared(NamedTuple):
    """What the records of all minds of a run share.

    Attributes:
        tell: takes the records.
        t: returns times.
        links: creates the links of causal chains.
        examinations: limits the contexts of plans of all agents that are examined.
        programs, messages, looks: record programs and messages, check intentions.
    """

    tell: RecordSink
    t: Moments
    links: CauseRecords
    examinations: RateLimit
    programs: ProgramRecords
    messages: MessageRecords
    looks: Looks


class MindRecords:
    """Records one mind. It is the mind's `jacaros.agents.mind.state.act.MindObserver`.

    Args:
        mind: the mind.
        shared: what it shares with those of other minds.
    """

    def __init__(self, mind: Mind, shared: Shared) -> None:
        self._mind, self._shared = mind, shared
        self._numbers = shared.programs.begin(mind)
        self.intentions = IntentionRecords(
            mind, self._numbers, self._cause_of, shared.t, shared.tell, shared.looks
        )
        self._reasons: dict[int, list[_Reason]] = {}
        """By intention, the causes of the plans on its stack, the lowest first."""
        self._candidates: dict[Trigger, list[Plan]] = {}
        self._allowance = RateLimit(shared.t, PER_SECOND)
        self._message: Cause | None = None
        self._told: dict[int, tuple[Annotations, str]] = {}
        """The texts of annotations, which many beliefs share."""
        self._facts: dict[int, tuple[tuple[Term, ...], str]] = {}
        """The texts of added beliefs, until they are deleted."""
        self._plans_changed = False
        self._record_beliefs()
        observe_mind(mind, self)

    def end(self) -> None:
        """Stop observing."""
        observe_mind(self._mind, None)

    def had_turn(self) -> None:
        """Schedule a check after a turn."""
        if self._plans_changed:
            self._plans_changed = False
            self._shared.programs.record(self._mind, self._numbers)
        alive = self._mind.alive
        if len(self._reasons) > 2 * len(alive) + _FORGOTTEN:
            self._reasons = {number: each for number, each in self._reasons.items() if number in alive}
        self.intentions.had_turn()

    # ---- called by the mind

    def selected(
        self,
        goal: Goal,
        annotations: EventAnnotations,
        intention: Intention | None,
        frame: Frame | None,
        cause: Cause | None,
    ) -> Cause | None:
        """Record a deliberation."""
        plans = self._plans_for(goal[0])
        if not plans and frame is None and not goal[0].kind:
            return cause  # no plan is relevant for this event
        parent = self._cause_of(intention) if intention is not None else cause
        trigger = shown_event(goal)
        link = self._shared.links.link("event", trigger, parent)
        if intention is not None and frame is not None:
            reason = _Reason(len(intention.frames), frame, link)
            self._reasons.setdefault(intention.id, []).append(reason)
        if parent is not None:
            self._shared.links.need(parent)
        chosen = None if frame is None else frame[PLAN]
        place = plans.index(chosen) if chosen in plans else len(plans) if chosen is None else 0
        self._shared.tell(
            records.DeliberationRecord(
                link.id,
                self._mind.name,
                trigger,
                link.parent,
                None if intention is None else intention.id,
                None if chosen is None else self._numbers[chosen],
                self._options(goal, annotations, plans[:place]),
                [self._numbers[plan] for plan in plans[place + 1 :]],
            )
        )
        return link

    def cause(self) -> Cause | None:
        """Return the cause of the step, or message, that the mind is processing."""
        current = self._mind.current
        return self._message if current is None else self._cause_of(current)

    def place(self, intention: Intention) -> Mapping[str, Any]:
        """Return plan, file and line of an intention's current step."""
        return place_of(intention, self._numbers)

    def changed(
        self,
        operator: str,
        symbol: Functor,
        row: tuple[Term, ...],
        annotations: Annotations,
        cause: Cause | None,
    ) -> None:
        """Record a belief that was added or deleted."""
        told = self._shown_fact(operator, symbol, row) + self._shown_annotations(annotations)
        record = records.BeliefRecord(self._mind.name, operator, told, None if cause is None else cause.id)
        current = self._mind.current
        if current is not None:
            place = place_of(current, self._numbers)
            record.intention = current.id
            record.file, record.line = place.get("file", ""), place.get("line", 0)
        self._shared.tell(record)

    def reads(self, message: SpeechAct | None) -> None:
        """Record a message that is read. It is the cause of its effects."""
        self._message = None if message is None else self._shared.messages.read(message)

    def plans_changed(self) -> None:
        """Record the program again at the end of the turn."""
        self._candidates.clear()
        self._plans_changed = True

    # ---- deliberations

    def _cause_of(self, intention: Intention) -> Cause | None:
        """Return the cause of the plan on top of an intention."""
        reasons = self._reasons.get(intention.id)
        while reasons and not reasons[-1].is_on(intention.frames):
            reasons.pop()
        return reasons[-1].link if reasons else intention.cause

    def _plans_for(self, kind: Trigger) -> list[Plan]:
        found = self._candidates.get(kind)
        if found is None:
            found = self._candidates[kind] = self._mind.library.relevant(kind)
        return found

    def _options(
        self, goal: Goal, annotations: EventAnnotations, plans: list[Plan]
    ) -> list[records.OptionRecord]:
        options: list[records.OptionRecord] = []
        if not plans:
            return options
        contexts = FailingContexts(self._mind, goal, annotations)
        for plan in plans[:MOST_OPTIONS]:
            if not (self._allowance.take() and self._shared.examinations.take()):
                break
            if contexts.fits(plan):
                options.append(records.OptionRecord(self._numbers[plan], contexts.stop(plan)))
        return options

    # ---- beliefs

    def _record_beliefs(self) -> None:
        left = MOST_BELIEFS
        for symbol, table in list(self._mind.beliefs.items()):
            for entry, annotations in table.entries()[: max(0, left)]:
                left -= 1
                if not isinstance(entry, Rule):
                    fact = entry.head() if isinstance(entry, OpenFact) else literal(symbol, entry)
                    told = shown(fact) + self._shown_annotations(annotations)
                    self._shared.tell(records.BeliefRecord(self._mind.name, "+", told))

    def _shown_fact(self, operator: str, symbol: Functor, row: tuple[Term, ...]) -> str:
        known = self._facts.pop(id(row), None)
        told = known[1] if known is not None and known[0] is row else shown(literal(symbol, row))
        if operator == "+" and row:
            if len(self._facts) > MOST_BELIEFS:
                self._facts.clear()
            self._facts[id(row)] = row, told
        return told

    def _shown_annotations(self, annotations: Annotations) -> str:
        if not annotations:
            return ""
        known = self._told.get(id(annotations))
        if known is None or known[0] is not annotations:
            if len(self._told) > MOST_BELIEFS:
                self._told.clear()
            told = shown(Annotated(_NOTHING, annotations)).removeprefix(_NOTHING.name)
            known = self._told[id(annotations)] = annotations, told
        return known[1]
