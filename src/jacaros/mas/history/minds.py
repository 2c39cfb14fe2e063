"""Records of one mind: its plans, beliefs, messages and intentions, with their causes."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.meta_events import observe_mind
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.intention import Frame, Intention
from jacaros.agents.mind.state.plan import OpenFact, Rule
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.values import Annotated, Functor, Term, atom
from jacaros.mas.history.causes import CauseRecords
from jacaros.mas.history.deliberations import Allowance, DeliberationRecords
from jacaros.mas.history.intentions import IntentionRecords, Looks, Moments
from jacaros.mas.history.messages import MessageRecords
from jacaros.mas.history.programs import ProgramRecords
from jacaros.mas.history.steps import place_of
from jacaros.mas.history.words import shown
from jacaros.runtime.trace import Cause

MOST_BELIEFS = 1000
"""Maximum number of beliefs of one agent that are recorded when its observation begins."""

Annotations = tuple[Term, ...]
_NOTHING = atom("nothing")


class Records(NamedTuple):
    """What the records of all minds of a run share.

    Attributes:
        tell: takes the kind of a record and its data.
        t: returns times.
        links: creates the links of causal chains.
        examinations: limits the contexts of plans that are examined.
        programs, messages, looks: record programs and messages, check intentions.
    """

    tell: Callable[[str, Mapping[str, Any]], None]
    t: Moments
    links: CauseRecords
    examinations: Allowance
    programs: ProgramRecords
    messages: MessageRecords
    looks: Looks


class MindRecords:
    """Records one mind. It is the mind's `jacaros.agents.mind.state.act.MindObserver`.

    Args:
        mind: the mind.
        records: what it shares with those of other minds.
    """

    def __init__(self, mind: Mind, records: Records) -> None:
        self._mind, self._records = mind, records
        self._numbers = records.programs.begin(mind)
        self._deliberations = DeliberationRecords(
            mind, self._numbers, records.links, records.t, records.examinations, records.tell
        )
        cause_of = self._deliberations.cause_of
        self.intentions = IntentionRecords(
            mind, self._numbers, cause_of, records.t, records.tell, records.looks
        )
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
            self._records.programs.record(self._mind, self._numbers)
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
        return self._deliberations.selected(goal, annotations, intention, frame, cause)

    def cause(self) -> Cause | None:
        """Return the cause of the step, or message, that the mind is processing."""
        current = self._mind.current
        return self._message if current is None else self._deliberations.cause_of(current)

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
        record: dict[str, Any] = {
            "agent": self._mind.name,
            "op": operator,
            "belief": self._shown_fact(operator, symbol, row) + self._shown_annotations(annotations),
        }
        if cause is not None:
            record["cause"] = cause.id
        current = self._mind.current
        if current is not None:
            place = place_of(current, self._numbers)
            record |= {"intention": current.id, "file": place.get("file", ""), "line": place.get("line", 0)}
        self._records.tell("belief", record)

    def reads(self, message: SpeechAct | None) -> None:
        """Record a message that is read. It is the cause of its effects."""
        self._message = None if message is None else self._records.messages.read(message)

    def plans_changed(self) -> None:
        """Record the program again at the end of the turn."""
        self._deliberations.plans_changed()
        self._plans_changed = True

    # ---- beliefs

    def _record_beliefs(self) -> None:
        """Record present beliefs."""
        left = MOST_BELIEFS
        for symbol, table in list(self._mind.beliefs.items()):
            for entry, annotations in table.entries()[: max(0, left)]:
                left -= 1
                if not isinstance(entry, Rule):
                    fact = entry.head() if isinstance(entry, OpenFact) else literal(symbol, entry)
                    told = shown(fact) + self._shown_annotations(annotations)
                    self._records.tell("belief", {"agent": self._mind.name, "op": "+", "belief": told})

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
