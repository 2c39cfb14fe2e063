"""The port through which the reasons of a mind are observed: what led to which plan, belief and act."""

from collections.abc import Mapping
from typing import Any, Protocol

from jacaros.bdi.state.intention import Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.values import Functor, Term
from jacaros.trace import Cause


class MindObserver(Protocol):
    """Hears what one mind does and why; it changes nothing and raises nothing."""

    def selected(
        self,
        goal: Goal,
        annotations: EventAnnotations,
        intention: Intention | None,
        frame: Frame | None,
        cause: Cause | None,
    ) -> Cause | None:
        """Hear which plan was taken for a goal or event.

        Args:
            goal: as it was before plans were tried.
            annotations: of the goal.
            intention: that posted it, None for an event from outside.
            frame: of the plan that was taken, None when no plan is applicable.
            cause: of an event from outside.

        Returns:
            the cause of what the plan does.
        """

    def cause(self) -> Cause | None:
        """Return what led to the step, or the message, that the mind is at; None for neither."""

    def place(self, intention: Intention) -> Mapping[str, Any]:
        """Return plan, file and line of the step that an intention is at."""

    def changed(
        self,
        operator: str,
        symbol: Functor,
        row: tuple[Term, ...],
        annotations: tuple[Term, ...],
        cause: Cause | None,
    ) -> None:
        """Hear of a belief that was added (``+``) or deleted (``-``); *annotations* came or went."""

    def reads(self, message: SpeechAct | None) -> None:
        """Hear that the mind begins to read a message, and (None) that it has read it."""

    def plans_changed(self) -> None:
        """Hear that plans came or went."""
