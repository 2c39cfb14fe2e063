"""Connect the overridden methods of an `Agent` subclass to its mind, and nothing else.

The mind does not know of this: its selection functions are replaced by ones that call the methods.
"""

from collections.abc import Callable
from typing import TypeVar, cast

from jacaros.bdi.mind import Mind
from jacaros.bdi.rules.selections import options
from jacaros.bdi.rules.urgency import Urgent
from jacaros.bdi.state.intention import PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.bdi.state.triggers import Goal
from jacaros.extension.agent import Agent, agent_of, give_face
from jacaros.extension.calling import FAULTS, crash_text
from jacaros.extension.views import Message, Option, overridden
from jacaros.terms.unifier import bind, undo
from jacaros.terms.values import Term, Var

Result = TypeVar("Result")


class CustomMind(Mind):
    """The mind of an agent with a project's class: it asks the class about messages and its end."""

    __slots__ = ()

    def accepts(self, message: SpeechAct) -> bool:
        accepts = overridden(agent_of(self), Agent, "soc_acc")
        return accepts is None or ask(self, accepts, bool, True, Message(message))

    def accept_kill(self, killer: str) -> bool:
        accepts = overridden(agent_of(self), Agent, "kill_acc")
        return accepts is None or ask(self, accepts, bool, True, killer)


class Chosen(Urgent):
    """The selection functions of an agent whose class overrides `Agent.select_option`."""

    __slots__ = ("_choose", "_mind")

    chooses = True

    def __init__(self, mind: Mind, choose: Callable[..., object]) -> None:
        super().__init__(mind)
        self._mind, self._choose = mind, choose
        self.look_anew()

    def select_option(
        self, goal: Goal, annotations: EventAnnotations, intention: Intention | None
    ) -> Frame | None:
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

        def check(chosen: object) -> Option | None:
            if chosen is None or any(chosen is each for each in found):
                return cast("Option | None", chosen)
            raise ValueError(f"it returned {chosen!r}, which is not one of the choices")

        default: Option | None = found[0]
        chosen = ask(self._mind, self._choose, check, default, tuple(found))
        for option, (frame, bindings) in zip(found, held, strict=True):
            if option is chosen:
                for variable, value in bindings:
                    bind(variable, value, trail)
                return frame
        return None


def begin_as(mind: Mind, face: Agent) -> None:
    """Connect an object of the project's class, before the mind has any beliefs."""
    give_face(mind, face)
    select_option = overridden(face, Agent, "select_option")
    if select_option is not None:
        mind.selections = Chosen(mind, select_option)


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
        name = getattr(method, "__qualname__", repr(method))
        owner.architecture.log("error", crash_text(name, method, error))
        return default
