"""The selection functions of a fair agent.

They select the oldest message and event, the first applicable plan, and intentions in a circle. A program can filter the
applicable plans with rules for ``select__option(Trigger, Intention, Plan, Bindings)``: the first plan for which they
hold is selected. With the label annotation ``all_unifs``, every answer of the plan's context is an option, not only the
first.
"""

from collections.abc import Iterator, Mapping, Sequence

from jacaros.bdi.rules.plan_terms import bindings_of, plan_term
from jacaros.bdi.rules.query import solve_formula
from jacaros.bdi.rules.searching import run
from jacaros.bdi.state.belief_base import SELECT_OPTION
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations, literal_of
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal, Trigger
from jacaros.terms.plans import trigger
from jacaros.terms.unifier import undo
from jacaros.terms.values import Term, Var


class Fair:
    """See `jacaros.bdi.state.selections.Selections`."""

    __slots__ = ("agent", "option_filter", "plain", "refused", "urgencies")

    chooses = False

    def __init__(self, agent: Circumstance) -> None:
        self.agent = agent
        self.plain = True
        self.option_filter = agent.beliefs[SELECT_OPTION]
        self.refused = False
        self.urgencies: Mapping[Trigger, int] | None = None

    def urgency_of(self, intention: Intention) -> int:
        """Return 0: no intention is more urgent than others."""
        del intention
        return 0

    def select_messages(self) -> Sequence[SpeechAct]:
        """Return the oldest message."""
        return (self.agent.incoming.messages.popleft(),)

    def select_event(self) -> Event | None:
        """Return the oldest event."""
        events = self.agent.events
        return events.popleft() if events else None

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

    def select_intention(self) -> Intention | None:
        """Return the intention whose last turn is the longest ago."""
        intentions = self.agent.intentions
        return intentions.popleft() if intentions else None

    def rank(self) -> None:
        """Do nothing: first come, first served."""

    def note_intention(self, intention: Intention) -> None:
        """Do nothing: the intention is queued last."""

    def note_message(self, message: SpeechAct) -> None:
        """Do nothing: the message is read last."""


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
