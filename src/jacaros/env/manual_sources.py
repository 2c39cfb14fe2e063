"""Properties and signals of an artifact type, read from its source and docstrings."""

import ast
import inspect
import re
import textwrap
from collections.abc import Iterable, Iterator

from jacaros.env.artifact import Artifact

_DEFINES = {"define_property": 0, "signal": 0, "signal_to": 1}
"""The methods that make something observable, and the index of the argument that names it."""

_WORDS: dict[type, str] = {
    bool: "true or false",
    int: "number",
    float: "number",
    str: "text",
    list: "list",
    dict: "map",
}

Usages = dict[str, str]
"""From a name to its usage with values, such as ``count(start)``."""

Entries = dict[str, tuple[str, str]]
"""From a name to its usage and description."""


def own_classes(artifact_type: type) -> list[type]:
    """Return the class and its user-defined base classes, the most general last."""
    return [each for each in artifact_type.__mro__ if issubclass(each, Artifact) and each is not Artifact]


def written_properties(artifact_type: type) -> Usages:
    """Return the properties that the code of the class defines by name, the most general class first."""
    return _written(artifact_type, ("define_property",))


def written_signals(artifact_type: type) -> Usages:
    """Return the signals that the code of the class sends by name, the most general class first."""
    return _written(artifact_type, ("signal", "signal_to"))


def _written(artifact_type: type, methods: tuple[str, ...]) -> Usages:
    found: Usages = {}
    for each in reversed(own_classes(artifact_type)):
        for name, usage in _calls(each, methods):
            found.setdefault(name, usage)
    return found


def _calls(kind: type, methods: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(kind)))
    except (OSError, TypeError, SyntaxError):  # created at run time: no source
        return
    for node in _in_order(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in methods:
            place = _DEFINES[node.func.attr]
            name = node.args[place] if len(node.args) > place else None
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                values = ", ".join(map(_value, node.args[place + 1 :]))
                yield name.value, f"{name.value}({values})" if values else name.value


def _in_order(node: ast.AST) -> Iterator[ast.AST]:
    for child in ast.iter_child_nodes(node):
        yield child
        yield from _in_order(child)


def _value(node: ast.expr) -> str:
    """Return a word for a value, from the expression that computes it."""
    if isinstance(node, ast.Starred):
        return "..."
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return node.attr.lstrip("_")
    if isinstance(node, ast.Constant):
        return _WORDS.get(type(node.value), "value")
    if isinstance(node, ast.List | ast.ListComp | ast.Tuple):
        return "list"
    if isinstance(node, ast.JoinedStr):
        return "text"
    if isinstance(node, ast.Call):
        return _property_read(node) or (
            _value(node.args[0])
            if node.args and not isinstance(node.args[0], ast.Starred)
            else _called(node.func)
        )
    return "value"


def _property_read(call: ast.Call) -> str | None:
    """Return the property that ``self.value("count")`` reads."""
    match call:
        case ast.Call(func=ast.Attribute(attr="value"), args=[ast.Constant(value=str(name)), *_]):
            return name
    return None


def _called(function: ast.expr) -> str:
    if isinstance(function, ast.Name):
        return function.id.lower()
    return function.attr.lstrip("_") if isinstance(function, ast.Attribute) else "value"


def described(artifact_type: type, section: str) -> Entries:
    """Return the entries of a section such as ``Properties:`` in the docstrings of the class and its bases."""
    found: Entries = {}
    for each in reversed(own_classes(artifact_type)):
        for usages, text in _entries(_section(inspect.cleandoc(each.__doc__ or ""), section)):
            for usage in usages:
                found[usage.partition("(")[0]] = (usage, text)
    return found


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
