"""Connect the overridden methods of an `Agent` subclass to its mind, and nothing else.

The mind does not know of this: its selection functions are replaced by ones that call the methods.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar, cast

from jacaros.bdi.actions.internal_action import ActionError
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import belief_update
from jacaros.bdi.rules.failure import error_terms
from jacaros.bdi.rules.selections import options
from jacaros.bdi.rules.urgency import Urgent
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import literal, parts
from jacaros.bdi.state.event import EVENT_INTENTION, Event, Raised
from jacaros.bdi.state.intention import PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Failure
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal
from jacaros.extension.agent import Agent, agent_of, give_face, overridden
from jacaros.extension.calling import FAULTS, crash_text
from jacaros.extension.literal import Literal, literal_from
from jacaros.extension.views import EventView, IntentionView, Message, Option, PerceptView
from jacaros.terms.text import text
from jacaros.terms.unifier import bind, undo
from jacaros.terms.values import BY_SELF, Functor, Term, Var
from jacaros.trace import Cause

Item = TypeVar("Item")
Seen = TypeVar("Seen")
Result = TypeVar("Result")
Change = TypeVar("Change", bound=Callable[[Any, Functor, tuple[Term, ...], tuple[Term, ...]], Raised])

_SELECTION_FUNCTIONS = ("select_message", "select_event", "select_option", "select_intention")


def _asked_first(change: Change) -> Change:
    """Wrap the addition of a belief so that it asks the agent's class first."""

    def add(
        mind: "CustomMind", symbol: Functor, row: tuple[Term, ...], annotations: tuple[Term, ...]
    ) -> Raised:
        mind._revise(literal_from(symbol, row, annotations), None)
        return change(mind, symbol, row, annotations)

    return cast("Change", add)


class CustomMind(Mind):
    """The mind of an agent with a project's class: it asks the class about changes of beliefs, if `brf` is overridden."""

    _revises: Callable[..., object] | None = None
    _notices: Callable[..., object] | None = None

    def begin_as(self, face: Agent) -> None:
        """Connect an object of the project's class, before the mind has any beliefs."""
        give_face(self, face)
        if any(overridden(face, name) for name in _SELECTION_FUNCTIONS):
            self.selections = Chosen(self, face)
        self._revises = overridden(face, "brf")
        self.features.usual_events = self.features.usual_events and self._revises is None
        self._notices = overridden(face, "buf")

    def accepts(self, message: SpeechAct) -> bool:
        accepts = overridden(agent_of(self), "soc_acc")
        return accepts is None or ask(self, accepts, bool, True, Message(message))

    def perceive(self, percepts: list[Percept]) -> None:
        if self._notices is not None and percepts:
            seen = [PerceptView(percept) for percept in percepts]
            kept = ask(self, self._notices, _of(seen), seen, seen)
            percepts = [percept.raw for percept in kept]
        super().perceive(percepts)

    def accept_kill(self, killer: str) -> bool:
        accepts = overridden(agent_of(self), "kill_acc")
        return accepts is None or ask(self, accepts, bool, True, killer)

    # changes of beliefs, see `jacaros.bdi.rules.belief_update`

    add_belief = _asked_first(belief_update.add_belief)
    add_belief_last = _asked_first(belief_update.add_belief_last)
    add_belief_apart = _asked_first(belief_update.add_belief_apart)

    def replace_belief(self, symbol: Functor, row: tuple[Term, ...], annotations: tuple[Term, ...]) -> Raised:
        self.delete_any(symbol, annotations)
        return self.add_belief(symbol, row, annotations)

    def delete_belief(
        self, symbol: Functor, arguments: tuple[Term, ...], annotations: tuple[Term, ...], apart: bool
    ) -> Raised:
        self._revise(None, literal_from(symbol, arguments, annotations))
        return super().delete_belief(symbol, arguments, annotations, apart)

    def delete_any(self, symbol: Functor, annotations: tuple[Term, ...] = BY_SELF) -> None:
        anything = tuple(Var() for _ in range(symbol.arity))
        self._revise(None, literal_from(symbol, anything, annotations))
        super().delete_any(symbol, annotations)

    def tell(self, term: Term, cause: Cause | None = None) -> bool:
        return self._is_refused(term, told=True) or super().tell(term, cause)

    def believe(
        self,
        symbol: Functor,
        row: tuple[Term, ...],
        annotations: tuple[Term, ...],
        cause: Cause | None = None,
    ) -> None:
        if not self._is_refused(literal(symbol, row, annotations), told=True):
            super().believe(symbol, row, annotations, cause)

    def untell(self, term: Term) -> bool:
        return self._is_refused(term, told=False) or super().untell(term)

    def _is_refused(self, term: Term, told: bool) -> bool:
        if self._revises is None:
            return False
        symbol, row, annotations = parts(term)
        if symbol is None:
            return False
        literal = literal_from(symbol, row, annotations)
        try:
            self._revise(literal if told else None, None if told else literal)
        except Failure:
            self.architecture.log("info", f"the agent's class refused the belief {text(term)}")
            return True
        return False

    def _revise(self, added: Literal | None, removed: Literal | None) -> None:
        """Call `brf` of the class.

        Raises:
            Failure: with ``belief_revision_failed``.
        """
        if self._revises is None:
            return
        intention = IntentionView(self.current) if self.current is not None else None
        try:
            answer = self._revises(added, removed, intention)
            message = f"the agent's class refuses to {'add' if added else 'remove'} {added or removed}"
        except ActionError as refused:
            answer, message = False, str(refused)
        except FAULTS as error:
            answer, message = False, crash_text(_name(self._revises), self._revises, error)
            self.architecture.log("error", message)
        if answer is False:
            raise Failure(*error_terms("belief_revision_failed", message))


class Chosen(Urgent):
    """The selection functions of an agent whose class overrides some of them; the others are the usual ones."""

    __slots__ = ("_event", "_intention", "_message", "_mind", "_option")

    def __init__(self, mind: CustomMind, face: Agent) -> None:
        super().__init__(mind)
        self._mind = mind
        self._event = overridden(face, "select_event")
        self._intention = overridden(face, "select_intention")
        self._message = overridden(face, "select_message")
        self._option = overridden(face, "select_option")
        self._orders_events = self._event is None
        self._orders_intentions = self._intention is None
        self.look_anew()

    def _calm_down(self) -> None:
        super()._calm_down()
        self.plain = False

    def select_messages(self) -> Sequence[SpeechAct]:
        if self._message is None:
            return super().select_messages()
        return (self._choose(self._message, self._mind.incoming.messages, Message, lambda message: True),)

    def select_event(self) -> Event | None:
        if self._event is None or not self._mind.events:
            return super().select_event()
        return self._choose(self._event, self._mind.events, EventView, _is_open)

    def select_intention(self) -> Intention | None:
        if self._intention is None or not self._mind.intentions:
            return super().select_intention()
        return self._choose(self._intention, self._mind.intentions, IntentionView, _can_run)

    def _choose(
        self,
        method: Callable[..., object],
        queue: deque[Item],
        view: Callable[[Item], Seen],
        counts: Callable[[Item], bool],
    ) -> Item:
        """Take out of a queue what a method chooses from the items that count; the mind itself removes the others."""
        places = [place for place, item in enumerate(queue) if counts(item)]
        if len(places) < 2 or (len(places) < len(queue) and places[0] != 0):
            return queue.popleft()
        views = [view(queue[place]) for place in places]
        chosen = ask(self._mind, method, _one_of(views), views[0], tuple(views))
        place = places[next(index for index, each in enumerate(views) if each is chosen)]
        item = queue[place]
        del queue[place]
        return item

    def select_option(
        self, goal: Goal, annotations: EventAnnotations, intention: Intention | None
    ) -> Frame | None:
        if self._option is None:
            return super().select_option(goal, annotations, intention)
        # Contexts are evaluated once: random numbers or effects might differ the next time.
        held: list[tuple[Frame, list[tuple[Var, Term]]]] = []
        found: list[Option] = []
        trail = self._mind.trail
        for frame in options(self._mind, goal, annotations):
            found.append(Option(frame[PLAN], frame))
            held.append(([*frame], [(variable, variable.ref) for variable in trail]))
        undo(trail, 0)
        if not found:
            return None
        candidates: list[Option | None] = [*found, None]
        chosen = ask(self._mind, self._option, _one_of(candidates), candidates[0], tuple(found))
        for option, (frame, bindings) in zip(found, held, strict=True):
            if option is chosen:
                for variable, value in bindings:
                    bind(variable, value, trail)
                return frame
        return None


def _is_open(raised: Event) -> bool:
    intention = raised[EVENT_INTENTION]
    return intention is None or not intention.dropped


def _can_run(intention: Intention) -> bool:
    return not intention.dropped and intention.suspended is None


# --- asking ------------------------------------------------------------------------------------------------


def ask(
    owner: Mind,
    method: Callable[..., object],
    check: Callable[[object], Result],
    default: Result,
    *arguments: object,
) -> Result:
    """Call a method of the project's class; use the default if it raises or returns an invalid value."""
    try:
        return check(method(*arguments))
    except FAULTS as error:
        owner.architecture.log("error", crash_text(_name(method), method, error))
        return default


def _name(method: Callable[..., object]) -> str:
    return getattr(method, "__qualname__", repr(method))


def _one_of(items: Sequence[Result]) -> Callable[[object], Result]:
    def check(chosen: object) -> Result:
        for item in items:
            if item is chosen:
                return item
        raise ValueError(f"it returned {chosen!r}, which is not one of the choices")

    return check


def _of(seen: list[PerceptView]) -> Callable[[object], list[PerceptView]]:
    def check(kept: object) -> list[PerceptView]:
        if not isinstance(kept, Iterable):
            raise TypeError(f"it returned {kept!r}, which is not a list of changes")
        found: list[PerceptView] = list(kept)
        for percept in found:
            if not any(percept is other for other in seen):
                raise ValueError(f"it returned {percept!r}, which is not one of the changes")
        return found

    return check
