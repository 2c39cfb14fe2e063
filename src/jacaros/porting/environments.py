"""Environments of Jason as artifacts: an operation for each action, a property for each percept."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from jacaros.artifacts import Artifact
from jacaros.porting.model import JavaClass
from jacaros.porting.reading import children, every, field, source

if TYPE_CHECKING:
    from tree_sitter import Node

BEGIN = (
    "self.percepts: dict[str, Any] = {}",
    "self.shown: dict[str, Any] = {}",
)
FUNCTOR = '''def functor_of(term: object) -> str:
    """Return the functor of a structure, or the text of an atom."""
    return term.functor if isinstance(term, Structure) else str(term)'''
_ACT = '''async def act(self, functor: str, *terms: object) -> None:
    """Execute an action of an agent; it fails if `executeAction` returns false."""
    action = Structure(functor, terms) if terms else Atom(functor)
    if not {call}:
        self.fail(f"action {{text(action)}} failed", "action_failed", action)
    self.show_percepts()'''
_PERCEPTS = '''def addPercept(self, percept: Any, agent: object = None) -> None:
    """Add a percept. In Java only *agent* perceives it; here all agents that focus the artifact do."""
    self.percepts[str(percept)] = percept

def removePercept(self, percept: Any, agent: object = None) -> bool:
    """Remove a percept; return whether it was there."""
    return self.percepts.pop(str(percept), None) is not None

def containsPercept(self, percept: Any, agent: object = None) -> bool:
    """Return whether a percept was added."""
    return str(percept) in self.percepts

def clearPercepts(self) -> None:
    """Remove all percepts."""
    self.percepts.clear()

def show_percepts(self) -> None:
    """Change the properties that differ from the percepts."""
    for key in [key for key in self.shown if key not in self.percepts]:
        self.remove_property(*parts_of(self.shown.pop(key)))
    for key, percept in self.percepts.items():
        if key not in self.shown:
            self.shown[key] = percept
            self.define_property(*parts_of(percept))'''
PARTS = '''def parts_of(term: Any) -> tuple[Any, ...]:
    """Return the functor and the arguments of a term."""
    return (term.functor, *term.arguments) if isinstance(term, Structure) else (str(term),)'''
_EXECUTE = "executeAction"
_FUNCTOR = re.compile(r"[a-z]\w*")


def operations(of: JavaClass) -> list[str]:
    """Return the methods that an environment needs as an artifact."""
    lines: list[str] = []
    execute = of.method(_EXECUTE, 2)
    for name in sorted(set(_actions(of))):
        taken = hasattr(Artifact, name) or any(each.name == name for each in of.methods)
        method, mark = (f"do_{name}", f'(name="{name}")') if taken else (name, "")
        lines += [f"@operation{mark}", f"async def {method}(self, *terms: object) -> None:"]
        lines += [f'    await self.act("{name}", *terms)', ""]
    if execute is not None:
        call = f"{'await ' if execute.pauses else ''}self.{execute.name}(self.caller, action)"
        lines += [*_ACT.format(call=call).splitlines(), ""]
    return [*lines, *_PERCEPTS.splitlines()]


def _actions(of: JavaClass) -> Iterator[str]:
    """Yield the functors that ``executeAction`` compares its action with."""
    execute = of.method(_EXECUTE, 2)
    if execute is None:
        return
    for call in every(execute.node, "method_invocation"):
        if source(field(call, "name")) not in ("equals", "equalsIgnoreCase", "startsWith"):
            continue
        sides = [call.child_by_field_name("object"), *children(field(call, "arguments"))]
        for side in sides:
            yield from _functor(side, of)
    for label in every(execute.node, "switch_label"):
        for each in children(label):
            yield from _functor(each, of)


def _functor(node: Node | None, of: JavaClass) -> Iterator[str]:
    """Yield the functor of a term that a string or a constant of the class gives."""
    if node is None:
        return
    if node.type == "identifier" and (member := of.members.get(source(node))) and member.value:
        strings = list(every(member.value, "string_literal"))
        node = strings[0] if strings else node
    if node.type == "string_literal" and (found := _FUNCTOR.match(source(node)[1:-1])):
        yield found[0]
