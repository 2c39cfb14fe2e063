"""The agent classes of projects: found by name, and connected to their minds.

The mind does not know of this: its selection functions are replaced by ones that call the methods.
"""

from collections.abc import Callable
from types import ModuleType
from typing import NamedTuple, TypeVar, cast

from jacaros.agents.body.values import to_value
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.urgency import Urgent, options
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.intention import PLAN, Frame, Intention
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.python.agent import Agent, Message, Option, agent_of, give_face, overridden
from jacaros.agents.python.declaring import FAULTS, crash_text
from jacaros.agents.terms.unifier import bind, undo
from jacaros.agents.terms.values import Term, Var, arguments_of
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.files.texts import aside

# Find the classes that a project file names, and create objects of them.


class UnknownClass(JacarosError):
    """Raised when the project's Python code lacks a class named in a project file."""


class Made(NamedTuple):
    """An object of a class named in a project file, and the arguments of its `init`."""

    made: Agent
    arguments: tuple[object, ...]


def object_of(modules: ProjectModules, written: str) -> Made | None:
    """Create an object of a class named in a project file; None if the project does not have the module."""
    name, terms = _split(written)
    found = _find_class(modules, name)
    if found is None:
        return None
    try:
        return Made(found(), tuple(map(to_value, terms)))
    except Exception as error:
        raise JacarosError(f"cannot create {name}: {type(error).__name__}: {error}") from error


def _split(written: str) -> tuple[str, tuple[Term, ...]]:
    name, bracket, rest = written.strip().partition("(")
    if not bracket:
        return name, ()
    try:
        return name.strip(), arguments_of(lower_value(parse_literal(f"arguments({rest}")))
    except AslError as wrong:
        message = wrong.diagnostics[0].message
        raise JacarosError(f"invalid arguments of {written}: {message}") from wrong


def _find_class(modules: ProjectModules, name: str) -> type[Agent] | None:
    """Return the subclass of `Agent` that ``my.Careful`` names; None if the project does not have it.

    A module of the project may have other things of a Java package than this class.

    Raises:
        ModuleUnreadable: the module cannot be imported.
        UnknownClass: the class of that name is not an `Agent`, or the module has others that are; the text lists them.
    """
    path, _, last = name.rpartition(".")
    # The module of ``my.inner.Careful``, or all of the package ``my``.
    whole = "." in path and modules.place(path) is not None
    found = modules.load(path if whole else name.partition(".")[0])
    if not found:
        return None
    for module in found:
        modules.require_seen(module, last)
        candidate = vars(module).get(last)
        if isinstance(candidate, type) and issubclass(candidate, Agent):
            return candidate
    known = sorted({key for module in found for key, value in vars(module).items() if _is_own(value, module)})
    there = f"it has {', '.join(known)}" if known else "it has no class derived from jacaros.Agent"
    meant = aside(name, [f"{path}.{each}".lstrip(".") for each in known])
    if not known and not any(last in vars(module) for module in found):
        return None
    raise UnknownClass(f"unknown class {last} in {found[0].__file__ or path}: {there}{meant}")


def _is_own(value: object, module: ModuleType) -> bool:
    return isinstance(value, type) and issubclass(value, Agent) and value.__module__ == module.__name__


T = TypeVar("T")


class CustomMind(Mind):
    """The mind of an agent with a project's class: it asks the class about messages and its end."""

    __slots__ = ()

    def accepts(self, message: SpeechAct) -> bool:
        return ask(self, agent_of(self).soc_acc, bool, True, Message(message))

    def accept_kill(self, killer: str) -> bool:
        return ask(self, agent_of(self).kill_acc, bool, True, killer)


class Chosen(Urgent):
    """The selection functions of an agent whose class overrides `Agent.select_option`."""

    __slots__ = ("_choose", "_mind")

    def __init__(self, mind: Mind, choose: Callable[..., object]) -> None:
        super().__init__(mind)
        self.chooses = mind.unusual = True
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
    check: Callable[[object], T],
    default: T,
    *arguments: object,
) -> T:
    """Call a method of the project's class; use the default if it raises or returns an invalid value."""
    try:
        return check(method(*arguments))
    except FAULTS as error:
        name = getattr(method, "__qualname__", repr(method))
        owner.architecture.log("error", crash_text(name, method, error))
        return default
