"""Find the classes that a project file names, and create objects of them."""

from collections.abc import Iterator
from types import ModuleType
from typing import Generic, NamedTuple, TypeVar

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import parse_literal
from jacaros.asl.lowering import lower_value
from jacaros.body.values import to_value
from jacaros.errors import JacarosError
from jacaros.project_modules import ProjectModules
from jacaros.suggestions import aside
from jacaros.terms.values import Term, arguments_of

T = TypeVar("T")


class UnknownClass(JacarosError):
    """Raised when the project's Python code lacks a class named in a project file."""


class Made(NamedTuple, Generic[T]):
    """An object of a class named in a project file, and the arguments of its `init`."""

    made: T
    arguments: tuple[object, ...]


def object_of(modules: ProjectModules, written: str, kind: type[T]) -> Made[T] | None:
    """Create an object of a class named in a project file; None if the project does not have the module."""
    name, terms = _split(written)
    found = find_class(modules, name, kind)
    if found is None:
        return None
    try:
        return Made(found(), _values(terms))
    except Exception as error:
        raise JacarosError(f"cannot create {name}: {type(error).__name__}: {error}") from error


def _split(written: str) -> tuple[str, tuple[Term, ...]]:
    """Split a class name from its arguments."""
    name, bracket, rest = written.strip().partition("(")
    if not bracket:
        return name, ()
    try:
        return name.strip(), arguments_of(lower_value(parse_literal(f"arguments({rest}")))
    except AslError as wrong:
        message = wrong.diagnostics[0].message
        raise JacarosError(f"invalid arguments of {written}: {message}") from wrong


def _values(terms: tuple[Term, ...]) -> tuple[object, ...]:
    return tuple(to_value(term) for term in terms)


def find_class(modules: ProjectModules, name: str, kind: type[T]) -> type[T] | None:
    """Return the subclass of *kind* that ``my.Careful`` names; None if the project does not have it.

    A module of the project may have other things of a Java package than this class.

    Raises:
        ModuleUnreadable: the module cannot be imported.
        UnknownClass: the class of that name is not a *kind*, or the module has others that are; the text lists them.
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
    meant = aside(name, [f"{path}.{each}".lstrip(".") for each in known])
    if not known and not any(last in vars(module) for module in found):
        return None
    raise UnknownClass(f"unknown class {last} in {found[0].__file__ or path}: {there}{meant}")


def _is_own(value: object, kind: type[object], module: ModuleType) -> bool:
    return isinstance(value, type) and issubclass(value, kind) and value.__module__ == module.__name__


def _modules_of(modules: ProjectModules, path: str) -> Iterator[ModuleType]:
    """Yield the module of that path, then those of its package: ``my.Careful`` may be in ``my/careful.py``."""
    loaded = list(modules.load(path.partition(".")[0]))
    if "." in path and modules.place(path) is not None:
        loaded = list(modules.load(path))
    yield from loaded
