"""Statements of Java in Python."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from jacaros.porting import calls
from jacaros.porting.expressions import negated, value
from jacaros.porting.model import declarator
from jacaros.porting.reading import COMMENTS, children, every, field, line_of, source
from jacaros.porting.scope import COMPARE, Py, Scope, Unported
from jacaros.porting.types import (
    BUILDERS,
    INT,
    LISTS,
    MAPS,
    PROPERTY,
    SETS,
    JavaType,
    default_of,
    type_of,
)
from jacaros.porting.windows import only_shows, outermost

if TYPE_CHECKING:
    from tree_sitter import Node

INDENT = "    "
Place = tuple[str, "Node"]
"""A file, and a part of it."""


class Body:
    """Translates the statements of a method.

    Attributes:
        scope: what is known in it.
        left: the statements that are left to a person.
    """

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self.left: list[Place] = []
        self.windows: list[Place] = []

    def block(self, node: Node) -> list[str]:
        """Translate a block or a single statement; the lines are not indented."""
        inside = node.named_children if node.type in ("block", "constructor_body") else [node]
        return self.statements(inside) or ["pass"]

    def statements(self, nodes: Iterable[Node]) -> list[str]:
        """Translate statements, in a scope of their own."""
        outside = dict(self.scope.variables)
        lines = [line for each in nodes for line in self.statement(each)]
        self.scope.variables = {
            name: each for name, each in self.scope.variables.items() if name in outside
        } | {name: each for name, each in outside.items() if name not in self.scope.variables}
        return (
            lines
            if any(not line.startswith("#") for line in lines)
            else [*lines, *(["pass"] if lines else [])]
        )

    def statement(self, node: Node) -> list[str]:
        """Translate a statement, or leave it to a person: a comment, and a failure at run time."""
        if node.type in COMMENTS:
            return list(_comment(node))
        before, after = self.scope.before, self.scope.after
        self.scope.before, self.scope.after = [], []
        known = dict(self.scope.variables)
        counts = len(self.left), len(self.windows)
        try:
            lines = list(self._translated(node))
            return [*self.scope.before, *lines, *self.scope.after]
        except Unported:
            self.scope.variables = known
            del self.left[counts[0] :], self.windows[counts[1] :]
            return self._left(node)
        finally:
            self.scope.before, self.scope.after = before, after

    def _translated(self, node: Node) -> Iterator[str]:
        translate = _TRANSLATED.get(node.type)
        if translate is None:
            raise Unported(node)
        return translate(self, node)

    # ---- what has no translation

    def _left(self, node: Node) -> list[str]:
        if node.type == "local_variable_declaration":
            for each in node.children_by_field_name("declarator"):
                self.scope.variables[source(field(each, "name"))] = None
        code = self.scope.of.java.code(node)
        line = line_of(node)
        if only_shows(node, self.scope):
            self.windows.append((self.scope.of.java.name, node))
            return [
                f"# Java, line {line}, a window: {code[0]}",
                *(f"#     {each}".rstrip() for each in code[1:]),
            ]
        self.left.append((self.scope.of.java.name, node))
        return [
            f"# Java, line {line}: {code[0]}",
            *(f"#     {each}".rstrip() for each in code[1:]),
            self.failure(line),
        ]

    def failure(self, line: int) -> str:
        """Return the statement that fails at run time, for a line that is not ported."""
        text = f"not ported: line {line} of {self.scope.of.java.name}"
        method = self.scope.method
        if not self.scope.of.is_artifact or (method and method.is_static):
            return f'raise NotImplementedError("{text}")'
        return f'self.fail("{text}", "not_ported", {line})'

    # ---- declarations and expressions

    def _declaration(self, node: Node) -> Iterator[str]:
        for each in node.children_by_field_name("declarator"):
            name, initial, kind = declarator(each, node)
            if initial is None:
                self.scope.declare(name, kind)
                if kind.name != PROPERTY:
                    yield f"{self._name(name)} = {default_of(kind)}"
                continue
            given = value(initial, self.scope)
            kind = (
                given.type
                if kind.name in ("var", "Object") or (not kind.elements and given.type.elements)
                else kind
            )
            if (
                kind.name in LISTS | MAPS | SETS
                and kind.elements == ()
                and type_of(field(node, "type")).elements
            ):
                kind = type_of(field(node, "type"))
            if given.type.name == PROPERTY and not self._is_changed(name, node):
                if given.text.startswith("self."):  # it has just been defined
                    yield given.text
                    given = Py(given.text.partition("(")[2].partition(",")[0].rstrip(")"), given.type)
                self.scope.variables[name] = given
                continue
            self.scope.declare(name, kind)
            yield f"{self._name(name)} = {given.text}"

    def _name(self, name: str) -> str:
        found = self.scope.variables[name]
        assert found is not None
        return found.text

    def _is_changed(self, name: str, node: Node) -> bool:
        assigned = every(outermost(node), "assignment_expression")
        return any(source(field(each, "left")) == name for each in assigned)

    def _expression(self, node: Node) -> Iterator[str]:
        inner = children(node)[0]
        if inner.type == "assignment_expression":
            yield from self._assignment(inner)
        elif inner.type == "update_expression":
            target, sign = children(inner)[0], "+" if "++" in source(inner) else "-"
            yield f"{value(target, self.scope).text} {sign}= 1"
        elif inner.type == "method_invocation":
            yield from calls.call(inner, self.scope, value, is_statement=True).text.splitlines()
        else:
            yield value(inner, self.scope).text

    def _assignment(self, node: Node) -> Iterator[str]:
        sign = source(field(node, "operator"))
        if field(node, "left").type not in ("identifier", "field_access", "array_access"):
            raise Unported(node)
        given = value(field(node, "right"), self.scope)
        left = value(field(node, "left"), self.scope)
        if left.where or sign in (">>>=",) or (left.type.name == PROPERTY and sign != "="):
            raise Unported(node)
        if (
            sign == "+="
            and left.type.name in ("String", *BUILDERS)
            and given.type.name not in ("String", "char")
        ):
            yield f"{left.text} += text({given.text})"
        elif sign == "/=" and left.type.name in ("int", "long") and given.type.name in ("int", "long"):
            yield f"{left.text} = int({left.text} / {given.within(COMPARE)})"
        else:
            yield f"{left.text} {sign} {given.text}"

    # ---- control flow

    def _condition(self, node: Node) -> Py:
        """Translate a condition that is evaluated more than once, or after other statements."""
        count = len(self.scope.before) + len(self.scope.after)
        found = value(node, self.scope)
        if len(self.scope.before) + len(self.scope.after) != count:
            raise Unported(node)
        return found

    def _indented(self, node: Node) -> Iterator[str]:
        return (f"{INDENT}{line}" for line in self.block(node))

    def _if(self, node: Node) -> Iterator[str]:
        yield f"if {self._condition(field(node, 'condition')).text}:"
        yield from self._indented(field(node, "consequence"))
        other = node.child_by_field_name("alternative")
        if other is None:
            return
        if other.type == "if_statement":
            lines = self.statement(other)
            if lines[0].startswith("if "):
                yield f"el{lines[0]}"
                yield from lines[1:]
                return
            yield "else:"
            yield from (f"{INDENT}{line}" for line in lines)
            return
        yield "else:"
        yield from self._indented(other)

    def _while(self, node: Node) -> Iterator[str]:
        yield f"while {self._condition(field(node, 'condition')).text}:"
        yield from self._indented(field(node, "body"))

    def _do(self, node: Node) -> Iterator[str]:
        if any(every(field(node, "body"), "continue_statement")):
            raise Unported(node)
        yield "while True:"
        yield from self._indented(field(node, "body"))
        yield f"{INDENT}if {negated(self._condition(field(node, 'condition'))).text}:"
        yield f"{INDENT * 2}break"

    def _each(self, node: Node) -> Iterator[str]:
        every_one = field(node, "value")
        kind, name = type_of(field(node, "type")), source(field(node, "name"))
        if every_one.type == "method_invocation" and source(field(every_one, "name")) == "entrySet":
            yield from self._each_entry(node, field(every_one, "object"), name)
            return
        things = self._condition(every_one)
        known = self.scope.variables.get(name)
        python = self.scope.declare(name, things.type.element() if kind.name == "var" else kind)
        yield f"for {python} in {things.text}:"
        yield from self._indented(field(node, "body"))
        self.scope.variables[name] = known

    def _each_entry(self, node: Node, target: Node, name: str) -> Iterator[str]:
        """Translate a loop over the entries of a map, whose keys and values are all that is used."""
        things = self._condition(target)
        body = field(node, "body")
        used = [each for each in every(body, "identifier") if source(each) == name]
        read = [each.parent for each in used]
        names = {"getKey": f"{name}_key", "getValue": f"{name}_value"}
        if not all(
            each is not None and each.type == "method_invocation" and source(field(each, "name")) in names
            for each in read
        ):
            raise Unported(node)
        self.scope.variables[name] = Py(name, JavaType("Entry", things.type.elements))
        parts = {source(field(each, "name")) for each in read if each is not None}
        if parts == {"getValue"}:
            yield f"for {names['getValue']} in {things.atom}.values():"
        elif parts == {"getKey"}:
            yield f"for {names['getKey']} in {things.atom}:"
        else:
            yield f"for {names['getKey']}, {names['getValue']} in {things.atom}.items():"
        yield from self._indented(body)
        del self.scope.variables[name]

    def _for(self, node: Node) -> Iterator[str]:
        if (counted := self._counted(node)) is not None:
            yield from counted
            return
        body, updates = field(node, "body"), node.children_by_field_name("update")
        if any(every(body, "continue_statement")):
            raise Unported(node)
        for initial in node.children_by_field_name("init"):
            if initial.type == "local_variable_declaration":
                yield from self._declaration(initial)
            else:
                yield from self._as_statement(initial)
        condition = node.child_by_field_name("condition")
        yield f"while {self._condition(condition).text if condition else 'True'}:"
        lines = self.block(body)
        for update in updates:
            lines = [*lines, *self._as_statement(update)]
        yield from (f"{INDENT}{line}" for line in lines if line != "pass" or len(lines) == 1)

    def _as_statement(self, node: Node) -> Iterator[str]:
        if node.type == "update_expression":
            target, sign = children(node)[0], "+" if "++" in source(node) else "-"
            yield f"{value(target, self.scope).text} {sign}= 1"
        elif node.type == "assignment_expression":
            yield from self._assignment(node)
        else:
            raise Unported(node)

    def _counted(self, node: Node) -> list[str] | None:
        """Translate a loop that counts, ``for (int i = 0; i < n; i++)``; None if it is another one."""
        initial, condition = node.child_by_field_name("init"), node.child_by_field_name("condition")
        updates, body = node.children_by_field_name("update"), field(node, "body")
        if (
            initial is None
            or initial.type != "local_variable_declaration"
            or condition is None
            or len(updates) != 1
        ):
            return None
        names = initial.children_by_field_name("declarator")
        if len(names) != 1 or condition.type != "binary_expression" or updates[0].type != "update_expression":
            return None
        name, first, _ = declarator(names[0], initial)
        up = "++" in source(updates[0])
        sign = source(field(condition, "operator"))
        if (
            source(field(condition, "left")) != name
            or source(children(updates[0])[0]) != name
            or first is None
        ):
            return None
        if sign not in (("<", "<=") if up else (">", ">=")) or _changes(name, body):
            return None
        start, end = self._condition(first), self._condition(field(condition, "right"))
        limit = end.text if len(sign) == 1 else _shifted(end, up)
        known = self.scope.variables.get(name)
        python = self.scope.declare(name, INT)
        limits = limit if up and start.text == "0" else f"{start.text}, {limit}{'' if up else ', -1'}"
        lines = [f"for {python} in range({limits}):", *self._indented(body)]
        self.scope.variables[name] = known
        return lines

    def _switch(self, node: Node) -> Iterator[str]:
        subject = self._condition(field(node, "condition"))
        labels: list[Py] = []
        is_default, word = False, "if"
        groups = children(field(node, "body"))
        for group in groups:
            inside = list(group.named_children)
            while inside and inside[0].type == "switch_label":
                label = inside.pop(0)
                is_default = is_default or not children(label)
                labels += [self._label(each, subject) for each in children(label)]
            if not inside and group is not groups[-1]:
                continue  # falls through to the next one
            if group.type != "switch_rule":
                inside = self._without_break(inside, group is groups[-1], node)
            if is_default:
                if group is not groups[-1]:
                    raise Unported(node)
                yield "else:" if word == "elif" else "if True:"
            else:
                yield f"{word} {_one_of(subject, labels)}:"
            yield from (f"{INDENT}{line}" for line in (self.statements(inside) or ["pass"]))
            labels, is_default, word = [], False, "elif"

    def _label(self, node: Node, subject: Py) -> Py:
        owner = self.scope.of.file.classes.get(subject.type.name)
        if owner is not None and owner.is_enum:
            return Py(f"{owner.name}.{source(node)}")
        return value(node, self.scope)

    @staticmethod
    def _without_break(inside: list[Node], is_last: bool, node: Node) -> list[Node]:
        last = inside[-1] if inside else None
        if last is not None and last.type == "block" and len(inside) == 1:
            inside = list(last.named_children)
            last = inside[-1] if inside else None
        ends = last is not None and last.type in (
            "break_statement",
            "return_statement",
            "throw_statement",
            "continue_statement",
        )
        if last is not None and last.type == "break_statement":
            inside = inside[:-1]
        breaks = any(each.type == "break_statement" for part in inside for each in every(part))
        if not (ends or is_last) or breaks:
            raise Unported(node)
        return inside

    def _try(self, node: Node) -> Iterator[str]:
        body = self.block(field(node, "body"))
        yield "try:"
        yield from (f"{INDENT}{line}" for line in body)
        caught = [each for each in children(node) if each.type == "catch_clause"]
        if caught and (failure := self._kept_failure(body)):
            yield f"except {failure}:"
            yield f"{INDENT}raise"
        if caught:
            yield from self._catch(caught[0], len(caught) > 1, node)
        for each in children(node):
            if each.type == "finally_clause":
                yield "finally:"
                yield from self._indented(children(each)[0])

    def _kept_failure(self, body: list[str]) -> str:
        """Return the exception that a handler must not catch: a failure of the operation is not an exception in Java.

        A failed link or creation is one.
        """
        code = "\n".join(body)
        if not self.scope.of.is_artifact:
            return "NotImplementedError" if "NotImplementedError" in code else ""
        calls_own = any(f"self.{each.name}(" in code for each in self.scope.of.methods)
        can_fail = any(
            f"self.{name}(" in code for name in ("call_linked", "workspace.make_artifact", "workspace.lookup")
        )
        kept = "not_ported" in code or (not can_fail and ("self.fail(" in code or calls_own))
        return "OperationFailed" if kept else ""

    def _catch(self, clause: Node, has_more: bool, node: Node) -> Iterator[str]:
        """Translate the first handler; others are for further kinds of exceptions of Java."""
        parameter = next(each for each in children(clause) if each.type == "catch_formal_parameter")
        java = source(field(parameter, "name"))
        known = self.scope.variables.get(java)
        name = self.scope.declare(java, JavaType("Exception"))
        lines = self.block(field(clause, "body"))
        if has_more and lines != ["pass"]:
            raise Unported(node)
        self.scope.variables[java] = known
        used = any(re.search(rf"\b{name}\b", line) for line in lines if not line.lstrip().startswith("#"))
        rules = "BLE001, S110" if all(line == "pass" or line.startswith("#") for line in lines) else "BLE001"
        yield f"except Exception{f' as {name}' if used else ''}:  # noqa: {rules} - as in Java"
        yield from (f"{INDENT}{line}" for line in lines)

    def _return(self, node: Node) -> Iterator[str]:
        inner = children(node)
        if not inner:
            yield "return"
            return
        found = value(inner[0], self.scope)
        if self.scope.after:
            changes, self.scope.after = self.scope.after, []
            yield from (f"result = {found.text}", *changes, "return result")
        else:
            yield f"return {found.text}"

    def _throw(self, node: Node) -> Iterator[str]:
        made = children(node)[0]
        if made.type != "object_creation_expression":
            raise Unported(node)
        arguments = [value(each, self.scope).text for each in children(field(made, "arguments"))]
        yield f"raise RuntimeError({', '.join(arguments)})"

    def _plain(self, node: Node) -> Iterator[str]:
        if children(node):  # a label
            raise Unported(node)
        yield source(node).rstrip(";").strip()

    def _inner(self, node: Node) -> Iterator[str]:
        yield from self.statements(node.named_children)

    def _synchronized(self, node: Node) -> Iterator[str]:
        yield from self.statements(field(node, "body").named_children)


def _comment(node: Node) -> Iterator[str]:
    text = source(node)
    lines = text.removeprefix("//").splitlines() if text.startswith("//") else text[2:-2].splitlines()
    for line in lines:
        words = line.strip().lstrip("*").strip()
        if words:
            yield f"# {words}"


def _changes(name: str, body: Node) -> bool:
    """Return whether a loop changes its counter."""
    changed = [field(each, "left") for each in every(body, "assignment_expression")]
    changed += [children(each)[0] for each in every(body, "update_expression")]
    return any(source(each) == name for each in changed)


def _shifted(end: Py, up: bool) -> str:
    """Return the end of a range that includes the given one."""
    if end.text.isdecimal():
        return str(int(end.text) + (1 if up else -1))
    for sign in (" - 1", " + 1"):
        if end.text.endswith(sign) and up == (sign == " - 1"):
            return end.text.removesuffix(sign)
    return f"{end.within(COMPARE)} {'+' if up else '-'} 1"


def _one_of(subject: Py, labels: list[Py]) -> str:
    if len(labels) == 1:
        return f"{subject.within(COMPARE + 1)} == {labels[0].text}"
    return f"{subject.within(COMPARE + 1)} in ({', '.join(each.text for each in labels)})"


_TRANSLATED: dict[str, Callable[[Body, Node], Iterator[str]]] = {
    "local_variable_declaration": Body._declaration,
    "expression_statement": Body._expression,
    "if_statement": Body._if,
    "while_statement": Body._while,
    "do_statement": Body._do,
    "for_statement": Body._for,
    "enhanced_for_statement": Body._each,
    "switch_expression": Body._switch,
    "try_statement": Body._try,
    "return_statement": Body._return,
    "throw_statement": Body._throw,
    "break_statement": Body._plain,
    "continue_statement": Body._plain,
    "synchronized_statement": Body._synchronized,
    "block": Body._inner,
    ";": lambda *_: iter(()),
}
