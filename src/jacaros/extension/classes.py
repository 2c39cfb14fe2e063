"""From the class names of a project file to objects: agents, belief bases and architectures."""

from collections.abc import Iterator
from difflib import get_close_matches
from types import ModuleType
from typing import Generic, NamedTuple, TypeVar

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import parse_literal
from jacaros.asl.lowering import lower_value
from jacaros.body.values import to_value
from jacaros.errors import JacarosError
from jacaros.extension.agent import Agent
from jacaros.extension.architecture import AgentArch
from jacaros.extension.belief_base import BeliefBase
from jacaros.extension.standard_bases import STANDARD_BASES, ChainBB
from jacaros.project_modules import ProjectModules
from jacaros.terms.values import Term, arguments_of

T = TypeVar("T")

_JASON_BASES = "jason.bb."


class UnknownClass(JacarosError):
    """A project file names a class that its Python code does not have."""


class Made(NamedTuple, Generic[T]):
    """An object of a class that a project file names, and the arguments of its `init`."""

    made: T
    arguments: tuple[object, ...]


def agent_object(modules: ProjectModules, written: str) -> Made[Agent] | None:
    """An object for ``agentClass``; None when the project has no such module."""
    return _object(modules, written, Agent)


def architecture_object(modules: ProjectModules, written: str) -> Made[AgentArch] | None:
    """An object for ``agentArchClass``; None when the project has no such module."""
    return _object(modules, written, AgentArch)


def base_object(modules: ProjectModules, written: str) -> Made[BeliefBase] | None:
    """An object for ``beliefBaseClass``; None when the project has no such module."""
    name, terms = _split(written)
    if name == f"{_JASON_BASES}ChainBB":
        links = [base_object(modules, str(to_value(term))) for term in terms]
        if any(link is None for link in links):
            raise UnknownClass(f"{written}: one of these belief bases is not known")
        return Made(ChainBB(*[(link.made, link.arguments) for link in links if link is not None]), ())
    if name.startswith(_JASON_BASES):
        known = STANDARD_BASES.get(name.removeprefix(_JASON_BASES))
        return None if known is None else Made(known(), _values(terms))
    return _object(modules, written, BeliefBase)


def _object(modules: ProjectModules, written: str, kind: type[T]) -> Made[T] | None:
    name, terms = _split(written)
    found = find_class(modules, name, kind)
    if found is None:
        return None
    try:
        return Made(found(), _values(terms))
    except Exception as error:
        raise JacarosError(f"{name} cannot be made: {type(error).__name__}: {error}") from error


def _split(written: str) -> tuple[str, tuple[Term, ...]]:
    """The name of a class and its arguments."""
    name, bracket, rest = written.strip().partition("(")
    if not bracket:
        return name, ()
    try:
        return name.strip(), arguments_of(lower_value(parse_literal(f"arguments({rest}")))
    except AslError as wrong:
        message = wrong.diagnostics[0].message
        raise JacarosError(f"the arguments of {written} cannot be read: {message}") from wrong


def _values(terms: tuple[Term, ...]) -> tuple[object, ...]:
    return tuple(to_value(term) for term in terms)


def find_class(modules: ProjectModules, name: str, kind: type[T]) -> type[T] | None:
    """The subclass of *kind* that ``my.Careful`` names; None when the project has no such module.

    Raises:
        ModuleUnreadable: the module cannot be imported.
        UnknownClass: it has no such class; the text says what it has.
    """
    path, _, last = name.rpartition(".")
    found = list(_modules_of(modules, path or last))
    if not found:
        return None
    for module in found:
        modules.require_seen(module, last)
        candidate = vars(module).get(last)
        if isinstance(candidate, type) and issubclass(candidate, kind):
            return candidate
    known = sorted(
        {key for module in found for key, value in vars(module).items() if _is_own(value, kind, module)}
    )
    there = f"it has {', '.join(known)}" if known else f"it has no class derived from jacaros.{kind.__name__}"
    close = get_close_matches(last, known, 1)
    meant = f"; did you mean {path}.{close[0]}?" if close else ""
    raise UnknownClass(f"there is no class {last} in {found[0].__file__ or path}: {there}{meant}")


def _is_own(value: object, kind: type[object], module: ModuleType) -> bool:
    return isinstance(value, type) and issubclass(value, kind) and value.__module__ == module.__name__


def _modules_of(modules: ProjectModules, path: str) -> Iterator[ModuleType]:
    """The module of that path, then those of its package: ``my.Careful`` may stand in ``my/careful.py``."""
    loaded = list(modules.load(path.partition(".")[0]))
    if "." in path and modules.place(path) is not None:
        loaded = list(modules.load(path))
    yield from loaded
