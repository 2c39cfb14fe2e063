"""What artifact types offer to agents, as editors show it: operations, observable properties and signals."""

import ast
import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import Final, NamedTuple
from typing import Literal as OneOf

from jacaros.agents.body.body import ACTIONS
from jacaros.agents.checks.flow import Adder
from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.class_sources import ClassSources
from jacaros.artifacts.env.environment import (
    Blackboard,
    Console,
    ManualRepository,
    SystemArtifact,
    WorkspaceArtifact,
)
from jacaros.artifacts.env.manual import described_usages, own_classes
from jacaros.artifacts.kernel.declaration import DeclaredOperation
from jacaros.editors.symbols.docstrings import markdown, parameters_in, unit_in
from jacaros.runtime.files.texts import file_text
from jacaros.runtime.mas.checks.observables import Observables, value_of_words

_STANDARD: Final = (Blackboard, Console, ManualRepository, SystemArtifact, WorkspaceArtifact)
"""The types of the artifacts that each workspace has."""
_BODY: Final = "the agent's body"
_NAMING: Final = ("define_property", "signal", "robot_property")
"""Methods whose first argument names a property or signal."""
EVERYWHERE: Final = frozenset({_BODY, *(each.__name__ for each in _STANDARD)})
"""Holders of what every agent can use."""


class ArgumentWords(NamedTuple):
    """A parameter of an operation, or a value of a property.

    Attributes:
        words: kind and unit in words.
        unit: in words; empty if unknown.
    """

    name: str
    words: str = ""
    unit: str = ""

    @property
    def meaning(self) -> str:
        """Kind and unit, such as ``a number in metres``; empty if nothing is known."""
        has_unit = not self.unit or self.unit in self.words
        return self.words if has_unit else f"{self.words} in {self.unit}" if self.words else self.unit


@dataclass(frozen=True)
class Offered:
    """One operation, property or signal.

    Attributes:
        how: which of them.
        name: as agents write it.
        arguments: names and units.
        least: least number of arguments of a call.
        is_open: whether it accepts any further ones.
        holder: the artifact type.
        text: description, as Markdown.
        find: returns where it is declared.
    """

    how: OneOf["operation", "property", "signal"]
    name: str
    arguments: tuple[ArgumentWords, ...]
    least: int
    is_open: bool
    holder: str
    text: str
    find: Callable[[], Span | None]

    @property
    def role(self) -> str:
        """What it is, with its artifact type."""
        return f"{'an' if self.how == 'operation' else 'a'} {self.how} of `{self.holder}`"

    def takes(self, count: int) -> bool:
        """Return whether it may have that number of arguments."""
        return self.least <= count and (self.is_open or count <= len(self.arguments))

    def __str__(self) -> str:
        names = [each.name for each in self.arguments] + ["..."] * self.is_open
        return f"{self.name}({', '.join(names)})" if names else self.name


def offered_by(artifact_type: type[Artifact], observables: Observables) -> list[Offered]:
    """Return what agents can use of an artifact type."""
    found = [_operation(artifact_type, each) for each in artifact_type.interface.operations]
    texts = {
        usage.partition("(")[0]: text
        for section in ("Properties", "Signals")
        for usage, text in described_usages(artifact_type, section)
    }
    for name, adders in (observables.of([artifact_type]) or {}).items():
        distinct = {each.size: each for each in reversed(adders)}
        found += [_observable(artifact_type, name, each, texts.get(name, "")) for each in distinct.values()]
    return found


def _operation(kind: type[Artifact], declared: DeclaredOperation) -> Offered:
    words: dict[str, str] = getattr(declared.source, "parameter_words", dict)()
    doc, signature = declared.source.__doc__, declared.signature

    def argument(name: str, expected: str, output: bool) -> ArgumentWords:
        told = words.get(name, "")
        unit = value_of_words(told).unit or unit_in(doc, name)
        return ArgumentWords(name, told or ("output" if output else expected), unit)

    arguments = tuple([argument(each.name, each.expected, each.output) for each in signature.parameters])
    method = getattr(declared.source, "__name__", declared.name)
    find = partial(_declared_at, kind, declared.name, method)
    least, is_open = signature.fewest, signature.rest is not None
    return Offered("operation", declared.name, arguments, least, is_open, kind.__name__, markdown(doc), find)


def _observable(kind: type[Artifact], name: str, adder: Adder, text: str) -> Offered:
    inside = adder.usage.partition("(")[2].rpartition(")")[0]
    names = [each.strip(" '") for each in inside.split(",") if each.strip()] if adder.size is not None else []
    units = [each.unit for each in adder.values] + [""] * len(names)
    arguments = tuple([ArgumentWords(each, "", unit) for each, unit in zip(names, units, strict=False)])
    how: OneOf["property", "signal"] = "signal" if adder.how == "signal" else "property"
    find = partial(_declared_at, kind, name, "")
    return Offered(how, name, arguments, len(names), adder.size is None, kind.__name__, markdown(text), find)


@cache
def standard_offers() -> tuple[Offered, ...]:
    """Return the operations that every agent has: those of its own body and of the standard artifacts."""
    observables = Observables()
    found = [each for kind in _STANDARD for each in offered_by(kind, observables)]
    for (name, arity), action in ACTIONS.items():
        names = parameters_in(action.__doc__, arity) or ("",) * arity
        arguments = tuple(map(ArgumentWords, names))
        text = markdown(action.__doc__)
        found.append(Offered("operation", name, arguments, arity, False, _BODY, text, lambda: None))
    own = {(each.name, len(each.arguments)): each for each in found}  # the body's `makeArtifact` comes first
    return tuple(own.values())


# Where it is declared.


def _declared_at(kind: type[Artifact], name: str, method: str) -> Span | None:
    """Return where an operation or property is declared, in a mapping file or in Python."""
    part, mapping = getattr(kind, "part", None), getattr(kind, "mapping", None)
    if part is not None and mapping is not None:
        file = SourceFile(str(Path(mapping.file).resolve()), mapping.text)
        groups = (part.operations, part.topics, part.frames, part.parameters, part.derived)
        for place in (each.place for group in groups for each in group if each.name == name):
            return Span(file, place.line, place.column, place.line, place.column + len(name))
    sources = ClassSources()  # kept only here: syntax trees are large
    for each in own_classes(kind):
        code, path = sources.of(each), inspect.getsourcefile(each) if sources.of(each) else None
        if code is None or path is None:
            continue
        for node in ast.walk(code):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name == method:
                start = node.col_offset + (10 if isinstance(node, ast.AsyncFunctionDef) else 4)
                return _span(path, node.lineno, start, len(node.name))
            if not method and isinstance(node, ast.Call) and name in _named_by(node):
                first = node.args[0]
                return _span(path, first.lineno, first.col_offset, len(name) + 2)
    return None


def _named_by(call: ast.Call) -> Iterator[str]:
    if isinstance(call.func, ast.Attribute) and call.func.attr in _NAMING:
        yield from (str(each.value) for each in call.args[:1] if isinstance(each, ast.Constant))


@lru_cache(32)
def _source(path: str) -> SourceFile:
    return SourceFile(path, file_text(Path(path)))


def _span(path: str, line: int, offset: int, length: int) -> Span:
    return Span(_source(path), line, offset + 1, line, offset + 1 + length)
