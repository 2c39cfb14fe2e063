"""Manuals: what an artifact type offers, for agents, users and the inspector."""

import ast
import inspect
import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.class_sources import ClassSources
from jacaros.artifacts.env.operation import LINK, OPERATION
from jacaros.artifacts.kernel.declaration import DeclaredOperation, Signature

# Properties and signals of an artifact type, read from its source and docstrings.


_DEFINES = {"define_property": 0, "update_property": 0, "signal": 0, "signal_to": 1}
"""The methods that make something observable, and the index of the argument that names it."""

Usages = dict[str, str]
"""From a name to its usage with values, such as ``count(start)``."""

Entries = dict[str, tuple[str, str]]
"""From a name to its usage and description."""


def own_classes(artifact_type: type) -> list[type]:
    """Return the class and its user-defined base classes, the most general last."""
    return [each for each in artifact_type.__mro__ if issubclass(each, Artifact) and each is not Artifact]


def usages_in(kind: type, sources: ClassSources) -> Iterator[tuple[str, str]]:
    """Yield name and usage of each property and signal where the code of one class defines, updates or sends it."""
    return _calls(sources.of(kind), tuple(_DEFINES))


def _written(artifact_type: type, *methods: str) -> Usages:
    """Return what the code of the class names in these methods, the most general class first."""
    found, sources = Usages(), ClassSources()
    for each in reversed(own_classes(artifact_type)):
        for name, usage in _calls(sources.of(each), methods):
            found.setdefault(name, usage)
    return found


def _calls(code: ast.ClassDef | None, methods: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    for node in _in_order(code) if code is not None else ():
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in methods:
            place = _DEFINES[node.func.attr]
            name = node.args[place] if len(node.args) > place else None
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                values = ", ".join(map(_value, node.args[place + 1 :]))
                yield name.value, f"{name.value}({values})" if values else name.value


def _in_order(root: ast.AST) -> Iterator[ast.AST]:
    below = [root]
    while below:
        node = below.pop()
        yield node
        below += reversed(list(ast.iter_child_nodes(node)))


def _value(node: ast.expr) -> str:
    """Return a word for a value: the name of what is passed or read, the atom in quotes, ``_`` for any other one."""
    match node:
        case ast.Call(ast.Name("Atom"), [ast.Constant(str(name))]):
            return f"'{name}'"
        case ast.Starred():
            return "..."
        case ast.Name(name):
            return name
        case ast.Attribute(_, name):
            return name.lstrip("_")
        case ast.Call(ast.Attribute(_, "value"), [ast.Constant(str(name)), *_]):
            return name
        case ast.Call(_, [first, *_]):
            return _value(first)
    return "_"


def described(artifact_type: type, section: str) -> Entries:
    """Return the entries of a section such as ``Properties:`` in the docstrings of the class and its bases."""
    usages = described_usages(artifact_type, section)
    return {usage.partition("(")[0]: (usage, text) for usage, text in usages}


def described_usages(artifact_type: type, section: str) -> Iterator[tuple[str, str]]:
    """Yield usage and description of all entries of a section; a name may have several numbers of values."""
    for each in reversed(own_classes(artifact_type)):
        for usages, text in _entries(_section(inspect.cleandoc(each.__doc__ or ""), section)):
            yield from ((usage, text) for usage in usages)


def _section(doc: str, wanted: str) -> str:
    for part in re.split(r"\n\s*\n", doc):
        head, _, rest = part.partition("\n")
        if head == f"{wanted}:":
            return textwrap.dedent(rest).strip()
    return ""


def _entries(section: str) -> Iterator[tuple[list[str], str]]:
    """Return usages with their text. Lines with deeper indentation belong to the entry above."""
    entries: list[str] = []
    for line in section.splitlines():
        if line.startswith(" ") and entries:
            entries[-1] += f" {line.strip()}"
        else:
            entries.append(line.strip())
    for entry in entries:
        usage, _, text = entry.partition(": ")
        yield _usages(usage.rstrip(":")), text


def _usages(written: str) -> list[str]:
    """Split usages at commas outside of brackets."""
    return [each.strip() for each in re.split(r",\s*(?![^()]*\))", written)]


def without_sections(doc: str, sections: Iterable[str]) -> str:
    """Return a docstring without these sections."""
    heads = {f"{section}:" for section in sections}
    return "\n\n".join(part for part in doc.split("\n\n") if part.partition("\n")[0] not in heads)


NOT_FOR_USERS = ("Properties", "Signals", "Attributes")
"""Sections of a docstring that are shown elsewhere, or are for authors of artifacts."""


@dataclass(frozen=True, slots=True)
class OperationManual:
    """One operation.

    Attributes:
        name: its name for callers.
        kind: ``operation``, ``linked operation``, ``internal operation``, or ``init`` for the initialisation.
        usage: name and parameters in one line, outputs with a minus sign.
        text: its description.
        guarded: whether it may have to wait before it begins.
        pausable: whether it pauses while the intention that called it is suspended.
    """

    name: str
    kind: str
    usage: str
    text: str
    guarded: bool
    pausable: bool


@dataclass(frozen=True, slots=True)
class ObservableManual:
    """A property or a signal.

    Attributes:
        name: functor of the belief or event.
        usage: the name with words for its values.
        text: its description. Empty if it is only known from the code.
    """

    name: str
    usage: str
    text: str


@dataclass(frozen=True, slots=True)
class Manual:
    """An artifact type.

    Attributes:
        type_name: name of the class.
        text: its description.
        inits: how to create it: each ``init`` with its parameters.
        operations: its operations: for agents, for other artifacts, and internal ones.
        properties: its observable properties.
        signals: its signals.
        ports: its out ports.
    """

    type_name: str
    text: str
    inits: tuple[OperationManual, ...]
    operations: tuple[OperationManual, ...]
    properties: tuple[ObservableManual, ...]
    signals: tuple[ObservableManual, ...]
    ports: tuple[str, ...]

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterator[str]:
        """Return the manual as text, without internal operations."""
        yield self.type_name
        yield from _indented(self.text, 2)
        yield from _titled("made with", map(_operation_lines, self.inits))
        yield from _titled("properties", map(_observable_lines, self.properties))
        yield from _titled("signals", map(_observable_lines, self.signals))
        for title, kind in (("operations", OPERATION), ("linked operations", LINK)):
            yield from _titled(
                title, [_operation_lines(each) for each in self.operations if each.kind == kind]
            )
        if self.ports:
            yield f"out ports: {', '.join(self.ports)}"


def _titled(title: str, parts: Iterable[Iterator[str]]) -> Iterator[str]:
    began = False
    for part in parts:
        if not began:
            yield f"{title}:"
        began = True
        yield from part


def _operation_lines(operation: OperationManual) -> Iterator[str]:
    traits = [
        word for word, has in (("may wait", operation.guarded), ("pausable", operation.pausable)) if has
    ]
    yield f"  {operation.usage}" + (f"  [{', '.join(traits)}]" if traits else "")
    yield from _indented(operation.text, 6)


def _observable_lines(observable: ObservableManual) -> Iterator[str]:
    yield f"  {observable.usage}"
    yield from _indented(observable.text, 6)


def _indented(text: str, width: int) -> Iterator[str]:
    for line in text.splitlines():
        yield f"{' ' * width}{line}".rstrip()


def describe(artifact_type: type[Artifact]) -> Manual:
    """Return the manual of *artifact_type*.

    Properties and signals come from the sections ``Properties:`` and ``Signals:`` of its docstring, and from the names that
    its code defines and sends.
    """
    offered = artifact_type.interface
    tables = (offered.operations, offered.links, offered.internals)
    return Manual(
        artifact_type.__name__,
        without_sections(inspect.cleandoc(artifact_type.__doc__ or ""), NOT_FOR_USERS),
        tuple(map(_describe, offered.inits)) or (_NO_INIT,),
        tuple(_describe(declared) for table in tables for declared in table),
        _observables(described(artifact_type, "Properties"), _written(artifact_type, "define_property")),
        _observables(described(artifact_type, "Signals"), _written(artifact_type, "signal", "signal_to")),
        tuple(artifact_type.ports),
    )


_NO_INIT = OperationManual("init", "init", "init()", "", False, False)


def _observables(told: Entries, written: Usages) -> tuple[ObservableManual, ...]:
    rest = {name: (usage, "") for name, usage in written.items() if name not in told}
    return tuple(ObservableManual(name, *each) for name, each in {**told, **rest}.items())


def _describe(declared: DeclaredOperation) -> OperationManual:
    return OperationManual(
        declared.name,
        declared.kind,
        f"{declared.name}({_worded(declared)})",
        without_sections(inspect.cleandoc(declared.source.__doc__ or ""), ("Raises", "Returns")),
        declared.guard is not None,
        declared.pausable,
    )


def _worded(declared: DeclaredOperation) -> Signature:
    """Return the signature, with descriptions of parameters from mapping files, which have no annotations."""
    signature = declared.signature
    words: dict[str, str] = getattr(declared.source, "parameter_words", dict)()
    parameters = [
        each._replace(expected=words.get(each.name, each.expected)) for each in signature.parameters
    ]
    return Signature(tuple(parameters), signature.rest)
