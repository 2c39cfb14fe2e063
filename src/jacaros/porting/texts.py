"""Concatenation of strings, and terms that Java writes as strings."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from jacaros.porting.reading import field, source
from jacaros.porting.scope import PLUS, Py, Scope
from jacaros.porting.types import INTEGERS, TEXTS

if TYPE_CHECKING:
    from tree_sitter import Node

Translate = Callable[["Node", Scope], Py]
_WORD = re.compile(
    r"\s*(?:(\x00\d+\x00)|(-?\d+(?:\.\d+)?)|(\"(?:[^\"\\]|\\.)*\")|(~?[a-zA-Z_][\w.]*)|(.))", re.DOTALL
)


def operands(node: Node) -> list[Node]:
    """Return the operands of a chain of ``+``."""
    if node.type == "binary_expression" and source(field(node, "operator")) == "+":
        return [*operands(field(node, "left")), field(node, "right")]
    return [node]


def joined(nodes: Sequence[Node], scope: Scope, value: Translate) -> str:
    """Return the concatenation of the operands of ``+``, as an f-string if possible."""
    parts = [value(node, scope) for node in nodes]
    first = next(index for index, part in enumerate(parts) if part.type.name in TEXTS)
    if first > 1:  # Java adds the numbers in front
        total = " + ".join(part.within(PLUS) for part in parts[:first])
        parts = [Py(total, parts[0].type, PLUS), *parts[first:]]
    if all(part.type.name in TEXTS for part in parts) and not any(_is_literal(part) for part in parts):
        return " + ".join(part.within(PLUS) for part in parts)
    inside = [_inside(part) for part in parts]
    if None in inside:
        return " + ".join(_as_text(part).within(PLUS + 1) for part in parts)
    if all(map(_is_literal, parts)):
        return '"' + "".join(part.text[1:-1] for part in parts) + '"'
    return 'f"' + "".join(filter(None, inside)) + '"'


def _is_literal(part: Py) -> bool:
    return (
        part.text.startswith('"')
        and part.text.endswith('"')
        and '"' not in part.text[1:-1].replace(r"\"", "")
    )


def _as_text(part: Py) -> Py:
    """Return an expression for the text of a value, as agents print it."""
    if part.type.name in TEXTS:
        return part
    return Py(f"{'str' if part.type.name in INTEGERS else 'text'}({part.text})")


def _inside(part: Py) -> str | None:
    """Return a part of an f-string; None if Python 3.11 does not allow it there."""
    if _is_literal(part):
        return part.text[1:-1].replace("{", "{{").replace("}", "}}")
    part = Py(re.sub(r"^str\((\w+)\)$", r"\1", part.text), part.type)
    expression = part.text if part.type.name in (*TEXTS, *INTEGERS) else f"text({part.text})"
    if "\\" in expression or ("'" in expression and '"' in expression) or expression.startswith("{"):
        return None
    expression = expression.replace('"', "'")
    return f"{{({expression})}}" if "lambda" in expression else f"{{{expression}}}"


class Term:
    """A term such as ``jug(5, X)``: its functor and the Python expressions of its arguments.

    Attributes:
        is_text: whether it is not a literal but a value: a number, a string, or an expression.
    """

    def __init__(self, functor: str, arguments: list[Term] | None = None, is_value: bool = False) -> None:
        self.functor = functor
        self.arguments = arguments or []
        self.is_value = is_value

    @property
    def python(self) -> str:
        """The Python expression of the term."""
        if self.is_value:
            return self.functor
        if not self.arguments:
            return f'Atom("{self.functor}")'
        return f'Structure("{self.functor}", ({", ".join(each.python for each in self.arguments)},))'

    @property
    def listed(self) -> str:
        """Its functor and arguments, as arguments of a call."""
        return ", ".join((f'"{self.functor}"', *(each.python for each in self.arguments)))


def term_of(nodes: Sequence[Node], scope: Scope, value: Translate) -> Term | None:
    """Return the term that Java parses from a concatenation; None if its structure is not visible."""
    pieces: list[str] = []
    values: list[str] = []
    for node in nodes:
        if node.type == "string_literal":
            pieces.append(source(node)[1:-1].replace(r"\"", '"'))
        else:
            pieces.append(f"\x00{len(values)}\x00")
            values.append(value(node, scope).text)
    words = [match for match in _WORD.finditer("".join(pieces)) if match[0].strip()]
    try:
        found, end = _term(words, 0, values)
    except (IndexError, ValueError):
        return None
    return found if end == len(words) and (not found.is_value) else None


def _term(words: list[re.Match[str]], at: int, values: list[str]) -> tuple[Term, int]:
    hole, number, string, name, other = words[at].groups()
    if hole:
        if words[at + 1 : at + 2] and words[at + 1][5] is None:
            raise ValueError("a value beside a word")
        return Term(values[int(hole.strip("\x00"))], is_value=True), at + 1
    if number or string:
        return Term(number or string, is_value=True), at + 1
    if other or not name or name.startswith("~"):  # no artifact has a negated property
        raise ValueError(other)
    if at + 1 == len(words) or words[at + 1][5] != "(":
        return Term(name), at + 1
    arguments, at = [], at + 1
    while words[at][5] in ("(", ","):
        argument, at = _term(words, at + 1, values)
        arguments.append(argument)
    if words[at][5] != ")":
        raise ValueError("unclosed")
    return Term(name, arguments), at + 1
