"""Find the classes that a project file names (the project's own and Jason's belief bases), and create objects of them."""

import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Generic, NamedTuple, TypeVar

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import load_program, parse_literal
from jacaros.asl.lowering import lower_value
from jacaros.asl.nodes import Rule
from jacaros.body.values import to_value
from jacaros.env.values import Atom, Out, Structure
from jacaros.errors import JacarosError
from jacaros.extension.belief_base import BeliefBase, Keeper
from jacaros.extension.literal import Literal, literal_of
from jacaros.project_modules import ProjectModules
from jacaros.suggestions import aside
from jacaros.terms.values import Term, arguments_of
from jacaros.text_files import file_text

T = TypeVar("T")

_JASON_BASES = "jason.bb."


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


def base_of(modules: ProjectModules, written: str, kind: type[BeliefBase]) -> Made[BeliefBase] | None:
    """Create the object for ``beliefBaseClass``, which may name one of Jason's classes."""
    name, terms = _split(written)
    if name == f"{_JASON_BASES}ChainBB":
        links = [base_of(modules, str(to_value(term)), kind) for term in terms]
        if any(link is None for link in links):
            raise UnknownClass(f"{written}: unknown belief base in the chain")
        return Made(ChainBB(*[(link.made, link.arguments) for link in links if link is not None]), ())
    if name.startswith(_JASON_BASES):
        known = _STANDARD_BASES.get(name.removeprefix(_JASON_BASES))
        return None if known is None else Made(known(), _values(terms))
    return object_of(modules, written, kind)


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


class TextPersistentBB(BeliefBase):
    """Keeps beliefs in a text file between runs (``jason.bb.TextPersistentBB``).

    Its arguments name the predicates to keep: ``count``, ``count(_)`` or ``"count/1"``; without arguments, all are kept.
    An argument that ends with ``.bb`` is the file, relative to the project's folder; the default is the agent's name
    with ``.bb``. Kept beliefs are there from the beginning, without events; percepts are not kept. The file is replaced
    as a whole when the agent ends, never half written.
    """

    def init(self, *arguments: object) -> None:
        names = [argument for argument in arguments if not _is_file(argument)]
        files = [str(argument) for argument in arguments if _is_file(argument)]
        self._kept = [_signature(name) for name in names]
        self._file = self.folder / (files[0] if files else f"{self.agent.name}.bb")
        if not self._file.is_file():
            return
        try:
            program, _ = load_program(str(self._file), file_text(self._file))
        except (OSError, UnicodeError, AslError) as wrong:
            raise JacarosError(f"cannot read {self._file}: {wrong}") from wrong
        for node in reversed(program.beliefs):
            if not isinstance(node, Rule):
                self._tables.keep(literal_of(lower_value(node)))

    def stop(self) -> None:
        kept = [kept for belief in self if (kept := self._to_keep(belief)) is not None]
        text = "".join(f"{belief}.\n" for belief in kept)
        self._file.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=self._file.parent, prefix=f".{self._file.name}.")
        try:
            # A temporary file is private to the user; the file that it replaces may have been readable by
            # others.
            Path(name).chmod(_mode(self._file))
            with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            Path(name).replace(self._file)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise

    def _to_keep(self, belief: Literal) -> Literal | None:
        wanted = not self._kept or any(
            belief.functor == name and arity in (None, belief.arity) for name, arity in self._kept
        )
        sources = [source for source in belief.sources if source != "percept"]
        return belief if wanted and sources else None


class IndexedBB(BeliefBase):
    """Keeps one belief for each key (``jason.bb.IndexedBB``): a new one replaces the old one.

    Its arguments mark the key arguments of a predicate: ``"student(key,_)"``.
    """

    def init(self, *arguments: object) -> None:
        self._keys: dict[tuple[str, int], list[int]] = {}
        for argument in arguments:
            pattern = _pattern(argument)
            places = [place for place, part in enumerate(pattern.arguments) if part == "key"]
            if not places:
                raise JacarosError(f"IndexedBB: {argument} has no key; write student(key,_)")
            self._keys[pattern.functor, pattern.arity] = places
        self._held: dict[tuple[object, ...], Literal] = {}

    def add(self, belief: Literal) -> bool:
        key = self._key(belief)
        if key is not None:
            held = self._held.get(key)
            if held is not None and held.arguments != belief.arguments:
                super().remove(held)
            self._held[key] = belief
        return super().add(belief)

    def remove(self, belief: Literal) -> bool:
        key = self._key(belief)
        if key is not None:
            self._held.pop(key, None)
        return super().remove(belief)

    def _key(self, belief: Literal) -> tuple[object, ...] | None:
        places = self._keys.get((belief.functor, belief.arity))
        if places is None:
            return None
        values = (repr(belief.arguments[place]) for place in places)
        return (belief.functor, belief.negated, belief.namespace, *values)


class ChainBB(BeliefBase):
    """A chain of bases (``jason.bb.ChainBB``): each passes what it keeps to the next one.

    Args:
        links: the bases with their arguments, the first to be called in front.
    """

    def __init__(self, *links: tuple[BeliefBase, tuple[object, ...]]) -> None:
        self._beginnings = links

    def init(self, *arguments: object) -> None:
        """Connect the links and initialise them, the last one first."""
        keeper: Keeper = self._tables
        for link, given in reversed(self._beginnings):
            link.agent, link.folder, link._tables = self.agent, self.folder, keeper
            link.init(*given)
            keeper = _Following(link, self._tables)
        self._first = keeper

    def add(self, belief: Literal) -> bool:
        return self._first.keep(belief)

    def remove(self, belief: Literal) -> bool:
        return self._first.discard(belief)

    def candidates(self, pattern: Literal) -> list[Literal]:
        return [belief for link, _ in self._beginnings for belief in link.candidates(pattern)]

    def stop(self) -> None:
        for link, _ in self._beginnings:
            link.stop()


class _Following:
    """The `Keeper` of a link of a chain: the next link."""

    def __init__(self, link: BeliefBase, tables: Keeper) -> None:
        self._link, self._tables = link, tables

    def keep(self, belief: Literal) -> bool:
        return self._link.add(belief)

    def discard(self, belief: Literal) -> bool:
        return self._link.remove(belief)

    def literals(self) -> Iterator[Term]:
        return self._tables.literals()


_STANDARD_BASES: dict[str, type[BeliefBase]] = {
    "DefaultBeliefBase": BeliefBase,
    "TextPersistentBB": TextPersistentBB,
    "IndexedBB": IndexedBB,
}
"""By the names after ``jason.bb.``; ``ChainBB`` is created from its links."""


def _mode(file: Path) -> int:
    """Return the permissions of a file, or those that a new one would get."""
    if file.exists():
        return stat.S_IMODE(file.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _is_file(argument: object) -> bool:
    return isinstance(argument, str) and not isinstance(argument, Atom) and argument.endswith(".bb")


def _signature(name: object) -> tuple[str, int | None]:
    """Return the name and number of arguments of a predicate, None for any number."""
    if isinstance(name, Structure):
        return name.functor, len(name.arguments)
    text = str(name)
    functor, slash, arity = text.partition("/")
    if slash and arity.isdigit():
        return functor, int(arity)
    if "(" in text:
        pattern = _pattern(text)
        return pattern.functor, pattern.arity
    return text, None


def _pattern(argument: object) -> Literal:
    """Return a pattern of a predicate, such as ``student(key,_)``, whichever way it is written."""
    if isinstance(argument, Structure):
        parts = tuple(None if isinstance(part, Out) else str(part) for part in argument.arguments)
        return Literal(argument.functor, parts)
    parsed = literal_of(lower_value(parse_literal(str(argument))))
    return Literal(parsed.functor, tuple(None if isinstance(p, Out) else str(p) for p in parsed.arguments))
