"""Statements that only show something in a window: they are left out, and the operation continues."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from jacaros.porting.model import declarator
from jacaros.porting.reading import children, every, field, source
from jacaros.porting.scope import Scope
from jacaros.porting.types import UNKNOWN, JavaType, type_of

if TYPE_CHECKING:
    from tree_sitter import Node

_EVENTS = re.compile(r"link\w+ToOp")
"""Methods of ``GUIArtifact`` that connect a part of a window with an operation."""
_GIVES = re.compile(r"(set|add|put|register)\w*")
"""Methods that give a window to a model or a collection."""


def only_shows(node: Node, scope: Scope) -> bool:
    """Return whether a statement only makes or changes a window."""
    if node.type == "local_variable_declaration":
        return scope.of.file.is_window(type_of(field(node, "type")).name)
    if node.type != "expression_statement":
        return False
    expression = children(node)[0]
    if expression.type == "assignment_expression":
        return _is_window(field(expression, "left"), node, scope)
    if expression.type != "method_invocation":
        return False
    target, name = expression.child_by_field_name("object"), source(field(expression, "name"))
    if scope.of.base == "GUIArtifact" and _EVENTS.fullmatch(name):
        return True
    given = children(field(expression, "arguments")) if target is not None and _GIVES.fullmatch(name) else []
    return any(_is_window(each, node, scope) for each in (target, *given) if each is not None)


def outermost(node: Node) -> Node:
    """Return the body of the method that a node is in."""
    while node.parent is not None and node.parent.type not in (
        "method_declaration",
        "constructor_declaration",
    ):
        node = node.parent
    return node


def _is_window(thing: Node, node: Node, scope: Scope) -> bool:
    while thing.type in ("method_invocation", "field_access", "array_access"):
        inner = thing.child_by_field_name("array" if thing.type == "array_access" else "object")
        if inner is None or inner.type == "this":
            break
        thing = inner
    if thing.type == "object_creation_expression":
        return scope.of.file.is_window(type_of(field(thing, "type")).name)
    name = source(thing).removeprefix("this.")
    return any(map(scope.of.file.is_window, (name, _declared(name, node, scope).name)))


def _declared(name: str, node: Node, scope: Scope) -> JavaType:
    """Return the type of a variable, also of one that is not ported."""
    for each in every(outermost(node), "local_variable_declaration"):
        for variable in each.children_by_field_name("declarator"):
            found, _, kind = declarator(variable, each)
            if found == name:
                return kind
    parameters = dict(scope.method.parameters) if scope.method else {}
    member = scope.of.members.get(name)
    return parameters.get(name) or (member.type if member else UNKNOWN)
