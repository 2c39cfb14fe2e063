"""Environments of Jason: percepts, and the terms that they and actions are made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from jacaros.porting.scope import COMPARE, Py, Scope, Unported
from jacaros.porting.texts import operands, term_of
from jacaros.porting.types import BOOLEAN, DOUBLE, INT, STRING, TERMS, VOID, JavaType

if TYPE_CHECKING:
    from tree_sitter import Node

Translate = Callable[["Node", Scope], Py]
_LITERAL = JavaType("Literal")
_PARSERS = frozenset({"parseLiteral", "parseTerm", "parseStructure"})
_CREATED = frozenset({"createLiteral", "createStructure", "createAtom", "createNumber", "createString"})
_IGNORED = frozenset({"informAgsEnvironmentChanged", "stop", "init", "setSleep"})
_CHANGES = {
    "addPercept": "addPercept",
    "removePercept": "removePercept",
    "containsPercept": "containsPercept",
}


def call(node: Node, name: str, arguments: list[Node], scope: Scope, value: Translate) -> Py | None:
    """Translate a method of ``jason.environment.Environment``; None if it is another one."""
    if name in _IGNORED:
        return Py("", VOID)
    if name == "clearPercepts" or name == "clearAllPercepts":
        return Py("self.clearPercepts()", VOID)
    if name in _CHANGES and arguments:
        # The first of two arguments is the agent that perceives it.
        term = value(arguments[-1], scope)
        agent = "" if len(arguments) == 1 else f", {value(arguments[0], scope).text}"
        return Py(f"self.{name}({term.text}{agent})", BOOLEAN)
    if name == "isRunning":
        return Py("True", BOOLEAN)
    if name == "getArgs" or name not in _PARSERS:
        return None
    return _parsed(node, arguments, scope, value)


def static(
    node: Node, owner: str, name: str, arguments: list[Node], scope: Scope, value: Translate
) -> Py | None:
    """Translate a function that makes a term; None if it is another one."""
    if owner not in ("Literal", "ASSyntax", "Structure", "Term", "LiteralImpl", "Atom", "ListTermImpl"):
        return None
    if name in _PARSERS:
        return _parsed(node, arguments, scope, value)
    if name not in _CREATED or not arguments:
        raise Unported(node)
    first, *rest = [value(each, scope) for each in arguments]
    if name in ("createNumber", "createString"):
        return Py(first.text, DOUBLE if name == "createNumber" else STRING, first.tight)
    return _made(first, rest)


def _made(functor: Py, arguments: list[Py]) -> Py:
    if not arguments:
        return Py(f"Atom({functor.text})", _LITERAL)
    return Py(f"Structure({functor.text}, ({', '.join(each.text for each in arguments)},))", _LITERAL)


def _parsed(node: Node, arguments: list[Node], scope: Scope, value: Translate) -> Py:
    term = term_of(operands(arguments[0]), scope, value) if len(arguments) == 1 else None
    if term is None:
        raise Unported(node)
    return Py(term.python, _LITERAL)


def of_term(thing: Py, name: str, values: list[Py], scope: Scope) -> Py | None:
    """Translate a method of a term; None if it has no translation."""
    if thing.type.name not in TERMS:
        return None
    if name == "getFunctor" and not values:
        return Py(f"functor_of({thing.text})", STRING)
    if name == "getTerm" and len(values) == 1:
        return Py(f"{thing.atom}.arguments[{values[0].text}]", JavaType("Term"))
    if name == "getArity" and not values:
        return Py(f"len({thing.atom}.arguments)", INT)
    if name == "solve" and not values:
        return Py(f"float({thing.text})", DOUBLE)
    if name == "getString" and not values:
        return Py(f"str({thing.text})", STRING)
    if name == "equals" and len(values) == 1:
        return Py(f"{thing.text} == {values[0].text}", BOOLEAN, COMPARE)
    return None
