"""The port of a mind to what chooses: which message, event, plan and intention goes first."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from jacaros.bdi.state.belief_base import Table
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal, Trigger


class Selections(Protocol):
    """The selection functions of one agent, as the published semantics have them (S_M, S_E, S_O, S_I).

    `jacaros.bdi.rules.selections.Fair` takes what came first, `jacaros.bdi.rules.urgency.Urgent` what is most urgent, and
    the class of a project what it likes.  Each takes what it chooses out of its queue.

    Attributes:
        plain: at present the first of each queue goes first, so an intention may stay in its turn while nothing else
            needs a cycle. Code that makes it False must set `Incoming.called`.
        chooses: applicable plans are chosen by `select_option`, as with rules in `option_filter`; otherwise the first
            one is taken.
        option_filter: beliefs and rules of the program that filter applicable plans (``select__option/4``).
        urgencies: how urgent events of each kind are; None when they are all alike.
        refused: there were applicable plans for the last event, and none of them was let pass.
    """

    plain: bool
    chooses: bool
    option_filter: Table
    urgencies: Mapping[Trigger, int] | None
    refused: bool

    def urgency_of(self, intention: Intention) -> int:
        """How urgent an intention is."""

    def select_messages(self) -> Sequence[SpeechAct]:
        """Those that are read in this cycle, of a mailbox that is not empty."""

    def select_event(self) -> Event | None:
        """The one that is taken up now; None when none is to be."""

    def select_option(
        self, goal: Goal, annotations: EventAnnotations, intention: Intention | None
    ) -> Frame | None:
        """The frame of the plan that is taken for an event (of that intention, if it is one's own)."""

    def select_intention(self) -> Intention | None:
        """The one that makes a step now."""

    def rank(self) -> None:
        """An event of an urgent kind is about to be queued, or handled at once."""

    def note_message(self, message: SpeechAct) -> None:
        """A message is about to be queued."""

    def note_intention(self, intention: Intention) -> None:
        """An intention that waited, was suspended or is new is about to be queued."""
