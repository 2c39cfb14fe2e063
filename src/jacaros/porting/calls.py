"""Calls of methods: those of the class, of CArtAgO, and of Java's library."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from jacaros.porting import library, percepts
from jacaros.porting.reading import children, field, source
from jacaros.porting.scope import ATOM, AWAIT, TIMES, Py, Scope, Unported
from jacaros.porting.types import (
    AGENT,
    ARTIFACT_ID,
    BOOLEAN,
    BUILDERS,
    DOUBLE,
    INT,
    LOCKS,
    LOGGER,
    OUT,
    PROPERTY,
    STRING,
    UNKNOWN,
    VOID,
    JavaType,
)

if TYPE_CHECKING:
    from tree_sitter import Node

Translate = Callable[["Node", Scope], Py]

_RENAMED = {
    "defineObsProperty": ("define_property", JavaType(PROPERTY)),
    "hasObsProperty": ("has_property", BOOLEAN),
    "hasObsPropertyByTemplate": ("has_property", BOOLEAN),
    "removeObsProperty": ("remove_property", VOID),
    "removeObsPropertyByTemplate": ("remove_property", VOID),
    "updateObsProperty": ("update_property", VOID),
    "failed": ("fail", VOID),
    "commit": ("commit", VOID),
}
"""Methods of artifacts whose arguments stay the same, with the types of their results."""
_CALLERS = ("getCurrentOpAgentId", "getOpUserId", "getOpUserName", "getCurrentOpAgentName")
_READ = {
    "intValue": INT,
    "longValue": INT,
    "doubleValue": DOUBLE,
    "floatValue": DOUBLE,
    "booleanValue": BOOLEAN,
}
_READ |= {"stringValue": STRING, "getValue": UNKNOWN, "byteValue": INT, "charValue": STRING}
_LOGGED = ("info", "warning", "severe", "fine", "finer", "finest", "config", "debug", "error", "warn")


def call(node: Node, scope: Scope, value: Translate, is_statement: bool = False) -> Py:
    """Translate a call.

    Raises:
        Unported: it has no translation.
    """
    target, name = node.child_by_field_name("object"), source(field(node, "name"))
    arguments = children(field(node, "arguments"))
    if target is None or target.type in ("this", "super") or source(target).endswith(".this"):
        return _own(node, name, arguments, scope, value)
    if (found := _static(node, source(target), name, arguments, scope, value)) is not None:
        return found
    thing = value(target, scope)
    values = [value(each, scope) for each in arguments]
    if thing.type.name == PROPERTY:
        return _of_property(node, thing, name, values, scope)
    if name == "toString" and not values and thing.type.name not in BUILDERS:
        return Py(f"text({thing.text})", STRING) if thing.type.name not in (AGENT, "String") else thing
    if name in ("equals", "equalsIgnoreCase", "compareTo") or thing.type.name not in scope.of.file.classes:
        found = (
            _identity(thing, name, values, scope)
            or percepts.of_term(thing, name, values, scope)
            or library.method(thing, name, values, is_statement)
        )
        if found is None:
            raise Unported(node)
        return found
    owner = scope.of.file.classes[thing.type.name]
    method = owner.method(name, len(values))
    if method is None or owner.name not in scope.of.file.ported or method.pauses:
        raise Unported(node)
    return Py(f"{thing.atom}.{method.name}({_listed(values)})", method.result)


def _listed(values: list[Py]) -> str:
    return ", ".join(each.text for each in values)


def _own(node: Node, name: str, arguments: list[Node], scope: Scope, value: Translate) -> Py:
    if scope.method is None and not scope.of.is_artifact:
        raise Unported(node)
    is_super = source(node).startswith("super.")
    method = scope.of.method(name, len(arguments), is_super)
    if method is not None:
        if method.is_static or not (scope.method and scope.method.is_static):
            values = [value(each, scope) for each in arguments]
            target = scope.of.name if method.is_static else "super()" if is_super else "self"
            return _awaited(
                f"{target}.{method.name}({_listed(values)})", method.result, method.pauses, node, scope
            )
        raise Unported(node)
    if not scope.of.is_artifact:
        raise Unported(node)
    if scope.of.is_environment and (found := percepts.call(node, name, arguments, scope, value)) is not None:
        return found
    # An artifact has no other `init` than its own; that of a `GUIArtifact` opens its window.
    if name == "init" and scope.of.base not in scope.of.file.classes:
        setup = scope.of.setup
        return _awaited("self.setup()", VOID, setup.pauses, node, scope) if setup else Py("", VOID)
    return _of_artifact(node, name, arguments, scope, value)


def _awaited(text: str, kind: JavaType, pauses: bool, node: Node, scope: Scope) -> Py:
    if not pauses:
        return Py(text, kind)
    if not scope.can_wait:
        raise Unported(node)
    return Py(f"await {text}", kind, AWAIT)


def _of_artifact(node: Node, name: str, arguments: list[Node], scope: Scope, value: Translate) -> Py:
    if name in ("await", "execInternalOp"):
        return _by_name(node, name, arguments, scope, value)
    if name == "makeArtifact":
        return _made(node, arguments, scope, value)
    values = [value(each, scope) for each in arguments]
    listed = _listed(values)
    if name in _RENAMED:
        method, kind = _RENAMED[name]
        where = ""
        return Py(f"self.{method}({listed})", kind, ATOM, where)
    if name in ("getObsProperty", "getObsPropertyByTemplate") and values:
        where = f"where=({_listed(values[1:])},)" if values[1:] else ""
        return Py(values[0].text, JavaType(PROPERTY), ATOM, where)
    if name == "signal" and values:
        return Py(f"self.signal{'_to' if values[0].type.name == AGENT else ''}({listed})", VOID)
    if name == "execLinkedOp" and len(values) > 1:
        return _awaited(f"self.call_linked({listed})", VOID, True, node, scope)
    if name in ("await_time", "delay") and len(values) == 1:
        return pause(values[0], name == "delay", node, scope)
    if name in _CALLERS and not values:
        return Py("self.caller", STRING if name.endswith("Name") else JavaType(AGENT))
    if name == "getCreatorId":
        return Py("self.id.creator", JavaType(AGENT))
    if name == "getId" and not values:
        return Py("self.id", JavaType(ARTIFACT_ID))
    if name == "log" and len(values) == 1:
        return logged(values[0])
    if name == "lookupArtifact" and len(values) == 1:
        return Py(f"self.workspace.lookup({listed})", JavaType(ARTIFACT_ID))
    if name == "dispose" and len(values) == 1:
        return Py(f"self.workspace.dispose_artifact({listed})", VOID)
    raise Unported(node)


def _by_name(node: Node, name: str, arguments: list[Node], scope: Scope, value: Translate) -> Py:
    """Translate a call that names a guard or an internal operation by a string."""
    if not arguments or arguments[0].type != "string_literal":
        raise Unported(node)
    method = scope.of.method(source(arguments[0])[1:-1], len(arguments) - 1)
    if method is None:
        raise Unported(node)
    values = [value(each, scope) for each in arguments[1:]]
    if name == "execInternalOp":
        return Py(f"self.start({', '.join((f'self.{method.name}', *(each.text for each in values)))})", VOID)
    guard = f"lambda: self.{method.name}({_listed(values)})" if values else f"self.{method.name}"
    return _awaited(f"self.until({guard})", VOID, True, node, scope)


def _made(node: Node, arguments: list[Node], scope: Scope, value: Translate) -> Py:
    if len(arguments) != 3:
        raise Unported(node)
    config = arguments[2]
    initial = children(field(config, "arguments")) if config.type == "object_creation_expression" else []
    if not initial and "DEFAULT_CONFIG" not in source(config) and config.type != "object_creation_expression":
        raise Unported(node)
    name, kind, *values = [value(each, scope) for each in (*arguments[:2], *initial)]
    given = f", ({_listed(values)},)" if values else ""
    text = f"self.workspace.make_artifact({name.text}, {kind.text}{given})"
    return _awaited(text, JavaType(ARTIFACT_ID), True, node, scope)


def pause(milliseconds: Py, holds: bool, node: Node, scope: Scope) -> Py:
    """Return the wait for a number of milliseconds, which *holds* the artifact or lets others use it."""
    text = milliseconds.text
    seconds = f"{int(text) / 1000:g}" if text.isdecimal() else f"{milliseconds.within(TIMES)} / 1000"
    return _awaited(f"self.{'clock.' if holds else ''}sleep({seconds})", VOID, True, node, scope)


def logged(text: Py) -> Py:
    """Return the log of a text."""
    return Py(f"self.log({text.text if text.type == STRING else f'text({text.text})'})", VOID)


def _of_property(node: Node, thing: Py, name: str, values: list[Py], scope: Scope) -> Py:
    """Translate a call of an observable property."""
    listed = ", ".join((thing.text, *(each.text for each in values)))
    selected = ", ".join(filter(None, (listed, thing.where)))
    if name == "updateValue" and len(values) == 2:
        return Py(f"self.update_value({selected})", VOID)
    if name in ("updateValue", "updateValues"):
        return Py(f"self.update_property({selected})", VOID)
    if name == "getName" and not values:
        return Py(thing.text, STRING)
    if thing.where:
        raise Unported(node)
    if name in _READ:
        return Py(f"self.value({listed})", _READ[name])
    if name == "getValues":
        return Py(f"self.values({listed})", JavaType("[]"))
    raise Unported(node)


def _identity(thing: Py, name: str, values: list[Py], scope: Scope) -> Py | None:
    """Translate calls that ask an agent or artifact for its name, and those of output parameters."""
    kind = thing.type.name
    if kind == AGENT and name in ("getAgentName", "getGlobalId", "getLocalId"):
        return Py(thing.text, STRING)
    if kind == ARTIFACT_ID and name in ("getName", "getArtifactType"):
        text = "self.name" if thing.text == "self.id" else f"{thing.atom}.name"
        return Py(text if name == "getName" else f"{thing.atom}.type_name", STRING)
    if kind == OUT and name == "set" and len(values) == 1:
        return Py(f"{thing.text}.set({values[0].text})", VOID)
    if kind == OUT and name == "get" and not values:
        return Py(f"{thing.text}.value", thing.type.element())
    if (kind == LOGGER and name in _LOGGED) and values and scope.of.is_artifact:
        return logged(values[0])
    if kind in LOCKS and name in ("lock", "unlock"):
        return Py("", VOID)  # an operation has its artifact for itself
    if kind == "Entry" and name in ("getKey", "getValue"):
        is_key = name == "getKey"
        return Py(f"{thing.text}_{'key' if is_key else 'value'}", thing.type.element(0 if is_key else -1))
    if kind == "Exception":
        if name in ("getMessage", "getLocalizedMessage"):
            return Py(f"str({thing.text})", STRING)
        if (
            name == "printStackTrace"
            and scope.of.is_artifact
            and not (scope.method and scope.method.is_static)
        ):
            return Py(f"self.log(str({thing.text}))", VOID)
    return None


def _static(
    node: Node, target: str, name: str, arguments: list[Node], scope: Scope, value: Translate
) -> Py | None:
    """Translate a call of a class; None if the target is not a class."""
    if target in scope.variables or target in scope.of.members:
        return None
    if target in ("System.out", "System.err") and name in ("println", "print", "printf"):
        if not scope.of.is_artifact or name == "printf" or (scope.method and scope.method.is_static):
            raise Unported(node)
        return logged(value(arguments[0], scope) if arguments else Py('""', STRING))
    if (target, name) == ("Thread", "sleep") and scope.of.is_artifact:
        return pause(value(arguments[0], scope), not scope.of.is_environment, node, scope)
    if (target, name) == ("System", "currentTimeMillis") and scope.of.is_artifact:
        return Py("int(self.clock.now() * 1000)", INT)
    last = target.rpartition(".")[2]
    if (found := percepts.static(node, last, name, arguments, scope, value)) is not None:
        return found
    values = [value(each, scope) for each in arguments] if last in library.CLASSES else []
    if last in library.CLASSES:
        found = library.function(last, name, values)
        if found is None:
            raise Unported(node)
        return found
    owner = scope.of.file.classes.get(last)
    if owner is None or owner.is_enum:
        return None
    method = owner.method(name, len(arguments))
    if method is None or not method.is_static or owner.name not in scope.of.file.ported:
        raise Unported(node)
    return Py(
        f"{owner.name}.{method.name}({_listed([value(each, scope) for each in arguments])})", method.result
    )
