"""The Python classes for the classes of a Java file."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from jacaros.porting import environments
from jacaros.porting.expressions import value
from jacaros.porting.model import INIT, FileModel, JavaClass, Member, Method, local_name
from jacaros.porting.reading import children, documentation, field, line_of, modifiers, source
from jacaros.porting.scope import Py, Scope, Unported
from jacaros.porting.statements import INDENT, Body, Place
from jacaros.porting.types import LISTS, LOGGER, MAPS, SETS, JavaType, annotation_of, default_of

if TYPE_CHECKING:
    from tree_sitter import Node

_IMPORTED = {
    "jacaros.artifacts": (
        *("Artifact", "ArtifactId", "Atom", "OperationFailed", "Out", "Structure"),
        *("initializer", "internal_operation", "link", "operation", "text"),
    ),
    "enum": ("StrEnum",),
    "typing": ("Any", "ClassVar"),
}
_WIDTH = 88
"""Length from which ruff and black wrap a line."""
_MODULES = ("math", "random", "re", "sys")


class Writer:
    """Writes the classes of a file.

    Attributes:
        left: what is left to a person.
        windows: what shows windows, which is left out.
    """

    def __init__(self, model: FileModel) -> None:
        self._model = model
        self._written: set[str] = set()
        self.left: list[Place] = []
        self.windows: list[Place] = []

    def file(self) -> str:
        """Return the Python file."""
        every_class = list(self._model.classes.values())
        shown = [each for each in every_class if self._is_shown(each)]
        # What is not ported comes last: a comment there belongs to no class.
        shown.sort(
            key=lambda each: (each.name not in self._model.ported, each.is_artifact, len(each.lineage))
        )
        parts = [self._class(each) for each in shown]
        code = "\n\n\n".join("\n".join(part) for part in parts)
        if "functor_of(" in code:
            code = f"{environments.FUNCTOR}\n\n\n{code}"
        if "parts_of(" in code:
            code = f"{environments.PARTS}\n\n\n{code}"
        code = without_unused(code)
        return f'"""Ported from {self._model.java.name}."""\n{_rules(code)}{_imports(code)}\n\n\n{code}\n'

    def _is_shown(self, of: JavaClass) -> bool:
        """Return whether a class is in the file; one of a file beside it only if it is ported."""
        own = of.java is self._model.java or of.name in self._model.ported
        return own and of.node.type != "interface_declaration"

    def _class(self, of: JavaClass) -> list[str]:
        if of.name not in self._model.ported:
            return self._not_ported(of)
        lines = self._enum(of) if of.is_enum else self._body(of)
        self._written.add(of.name)
        return lines

    def _not_ported(self, of: JavaClass) -> list[str]:
        first, last = line_of(of.node), of.node.end_point[0] + 1
        about = f"# Java, lines {first} to {last}: class {of.name}"
        if of.is_window:
            self.windows.append((of.java.name, of.node))
            return [f"{about}, a window, is left out"]
        self.left.append((of.java.name, of.node))
        return [about, *(f"#     {line}".rstrip() for line in of.java.code(of.node))]

    def _enum(self, of: JavaClass) -> list[str]:
        names = [
            source(field(each, "name"))
            for each in children(field(of.node, "body"))
            if each.type == "enum_constant"
        ]
        return [
            f"class {of.name}(StrEnum):",
            *_document(of.node, of.name),
            *(f'{INDENT}{name} = "{name}"' for name in names),
        ]

    def _body(self, of: JavaClass) -> list[str]:
        base = "Artifact" if of.is_artifact and of.base not in self._written else of.base
        plain = f"class {of.name}({base}):" if base not in ("", "Object") else f"class {of.name}:"
        lines = [plain, *_document(of.node, of.name)]
        if of.ports:
            quoted = ", ".join(f'"{port}"' for port in of.ports)
            lines += ["", f"{INDENT}ports = ({quoted},)"]
        statics = [line for each in of.members.values() if each.is_static for line in self._static(each, of)]
        lines += ["", *_indented(statics)] if statics else []
        starts = [each for each in of.methods if _is_start(each, of)]
        for method in starts:
            lines += ["", *_indented(self._start(method, of, starts))]
        has_values = any(not each.is_static for each in of.members.values())
        if not starts and (of.is_environment or of.setup or has_values):
            lines += ["", *_indented(self._start(None, of, starts))]
        for method in of.methods:
            if method not in starts and not _is_left_out(method, of):
                lines += ["", *_indented(self._method(method, of))]
        if of.is_environment:
            lines += ["", *_indented(environments.operations(of))]
        return lines

    # ---- fields

    def _static(self, member: Member, of: JavaClass) -> Iterator[str]:
        if member.type.name == LOGGER or self._model.is_window(member.type.name):
            return
        kind = member.type.name
        hint = ": ClassVar[Any]" if kind in LISTS or kind in MAPS or kind in SETS else ""
        try:
            initial = (
                value(member.value, Scope(of, in_class_body=True)).text
                if member.value
                else default_of(member.type)
            )
        except Unported:
            assert member.value is not None
            self.left.append((of.java.name, member.value))
            yield from self._comment(member.value, of)
            initial = "None"
        yield f"{of.attribute(member.name)}{hint} = {initial}"

    @staticmethod
    def _comment(node: Node, of: JavaClass) -> Iterator[str]:
        first, *more = of.java.code(node)
        yield f"# Java, line {line_of(node)}: {first}"
        yield from (f"#     {line}".rstrip() for line in more)

    def _fields(self, body: Body) -> Iterator[str]:
        """Give the fields their initial values."""
        of = body.scope.of
        # An artifact with an `init` of its own need not call that of the class that it extends.
        owners = of.lineage[::-1] if of.is_artifact else [of]
        for owner, member in [(each, member) for each in owners for member in each.members.values()]:
            if member.is_static or member.type.name == LOGGER:
                continue
            if self._model.is_window(member.type.name):
                continue
            target = f"self.{owner.attribute(member.name)}"
            try:
                initial = value(member.value, body.scope).text if member.value else default_of(member.type)
            except Unported:
                assert member.value is not None
                body.left.append((owner.java.name, member.value))
                yield from self._comment(member.value, owner)
                yield f"{target} = None"
                yield body.failure(line_of(member.value))
                continue
            hint = _hint(member.type, initial)
            yield f"{target}{hint} = {initial}"

    # ---- methods

    def _start(self, method: Method | None, of: JavaClass, starts: list[Method]) -> list[str]:
        """Write ``init`` or ``__init__``, which also gives the fields their values."""
        name = INIT if of.is_artifact else "__init__"
        scope = Scope(of, method or Method(name, name, [], False, JavaType("void"), [], None, of.node))
        parameters = self._parameters(scope, of) if method else ["self"]
        body = Body(scope)
        before = ["super().__init__()"] if name == "__init__" and of.base in self._written else []
        before += self._fields(body)
        lines = body.block(field(method.node, "body")) if method else []
        pauses = method is not None and method.pauses
        if method is None and of.is_artifact:
            inherited = [each for owner in of.lineage[1:] for each in owner.methods if each.java == INIT]
            call = "super().init(*arguments)" if inherited else "self.setup()" if of.setup else ""
            pauses = any(each.pauses for each in (*inherited, of.setup) if each)
            parameters += ["*arguments: object"] if inherited else []
            lines = [f"{'await ' if pauses else ''}{call}"] if call else []
        self._keep(body)
        lines = [*before, *(lines if lines != ["pass"] or not before else [])]
        if of.is_environment:
            lines = [*environments.BEGIN, *lines, "self.show_percepts()"]
        number = starts.index(method) if method in starts else 0
        head = [] if number == 0 else ["@initializer"]
        name = name if number == 0 else f"{INIT}_{len(scope.method.parameters) if scope.method else 0}"
        word = "async def" if pauses else "def"
        lines = _without_pass(lines)
        return [*head, f"{word} {name}({', '.join(parameters)}) -> None:", *_indented(lines or ["pass"])]

    def _method(self, method: Method, of: JavaClass) -> list[str]:
        scope = Scope(of, method)
        parameters = self._parameters(scope, of)
        decorators = [self._decorator(role, method, of) for role in method.roles]
        if method.is_static:
            decorators.append("@staticmethod")
            parameters = parameters[1:]
        body = Body(scope)
        node = method.node.child_by_field_name("body")
        lines = body.block(node) if node else ["raise NotImplementedError"]
        self._keep(body)
        result = annotation_of(method.result, frozenset(self._written))
        word = "async def" if method.pauses else "def"
        head = f"{word} {method.name}({', '.join(parameters)}) -> {'Any' if result == 'object' else result}:"
        document = _document(method.node)
        if document and lines[-1] == "pass" and all(line.startswith("#") for line in lines[:-1]):
            lines.pop()
        return [*decorators, head, *document, *_indented(lines)]

    def _decorator(self, role: str, method: Method, of: JavaClass) -> str:
        given = [f'name="{method.java}"'] if method.name != method.java else []
        if method.guard:
            guard = of.method(method.guard, len(method.parameters)) or of.method(method.guard, 0)
            given.append(f'guard="{guard.name if guard else method.guard}"')
        return f"@{role}({', '.join(given)})" if given else f"@{role}"

    def _parameters(self, scope: Scope, of: JavaClass) -> list[str]:
        method = scope.method
        assert method is not None
        found = ["self"]
        for index, (java, kind) in enumerate(method.parameters):
            is_rest = method.takes_rest and index == len(method.parameters) - 1
            is_arguments = of.is_environment and method.java == INIT and kind.name == "[]"
            name = local_name(java)
            element = kind.element() if is_arguments else kind
            annotation = annotation_of(element, frozenset(self._written))
            found.append(f"{'*' if is_rest or is_arguments else ''}{name}: {annotation}")
            scope.variables[java] = Py(name, JavaType("[]", (kind,)) if is_rest else kind)
        return found

    def _keep(self, body: Body) -> None:
        self.left += body.left
        self.windows += body.windows


def _is_start(method: Method, of: JavaClass) -> bool:
    if not of.is_artifact:
        return method.name == "__init__"
    has_init = any(each.java == INIT for each in of.methods)
    return method.java == INIT or (method.name == "__init__" and not has_init and not method.parameters)


def _is_left_out(method: Method, of: JavaClass) -> bool:
    """Return whether a method has no use in Python."""
    if method.name == "__hash__" or "abstract" in modifiers(method.node):
        return True
    return (
        (of.is_artifact and method.name == "__init__")
        or (of.is_environment and method.java == "stop")
        or method.java == "main"
    )


def _without_pass(lines: list[str]) -> list[str]:
    """Remove a ``pass`` beside other statements."""
    done = [line for line in lines if line != "pass"]
    return done if any(not line.startswith("#") for line in done) else lines


def _document(node: Node, name: str = "") -> list[str]:
    text = documentation(node)
    if not text and not name:
        return []
    return [f'{INDENT}"""{text or name}."""']


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"{INDENT}{line}" if line else "" for line in lines]


def _hint(kind: JavaType, initial: str) -> str:
    """Return the annotation of a field, where its value does not show its type."""
    if initial in ("[]", "{}", "set()"):
        word = "list[Any]" if kind.name in LISTS else "dict[Any, Any]" if kind.name in MAPS else "set[Any]"
        return f": {word}"
    return ": Any" if initial == "None" else ""


def _rules(code: str) -> str:
    """Return the line that lets ruff accept loops and conditions written as Java does; empty without any."""
    found = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.If) and not node.orelse and len(node.body) == 1:
            inner = node.body[0]
            if isinstance(inner, ast.If) and not inner.orelse:
                found.add("SIM102")
        blocks = [getattr(node, name, []) for name in ("body", "orelse", "finalbody")]
        if any(isinstance(block, list) and _counts_beside(block) for block in blocks):
            found.add("SIM113")
    return f"\n# ruff: noqa: {', '.join(sorted(found))} - as in Java\n" if found else ""


def _counts_beside(block: list[ast.stmt]) -> bool:
    """Return whether a loop has a counter that starts at 0 in the same block."""
    zeros: set[str] = set()
    for each in block:
        match each:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=0)):
                zeros.add(name)
            case ast.For(body=body) if not any(isinstance(inner, ast.Continue) for inner in ast.walk(each)):
                counted = {
                    step.target.id
                    for step in body
                    if isinstance(step, ast.AugAssign) and isinstance(step.target, ast.Name)
                }
                if counted & zeros:
                    return True
    return False


def _imports(code: str) -> str:
    code = re.sub(r"^ *#.*$", "", code, flags=re.MULTILINE)
    lines = [f"import {module}" for module in _MODULES if re.search(rf"\b{module}\.", code)]
    blocks = {}
    for module, names in _IMPORTED.items():
        used = [name for name in names if re.search(rf"(?<![\w.\"']){name}\b(?!\")", code)]
        if used:
            line = f"from {module} import {', '.join(used)}"
            wrapped = "".join(f"{INDENT}{name},\n" for name in used)
            blocks[module] = line if len(line) <= _WIDTH else f"from {module} import (\n{wrapped})"
    standard = [*lines, *(blocks[module] for module in ("enum", "typing") if module in blocks)]
    own = [blocks["jacaros.artifacts"]] if "jacaros.artifacts" in blocks else []
    return "\n".join(
        [*([""] if standard or own else []), *standard, *([""] if standard and own else []), *own]
    )


def without_unused(code: str) -> str:
    """Mark the local variables that are never read: their names begin with an underscore."""
    lines = code.splitlines()
    for function in ast.walk(ast.parse(code)):
        if not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        names = [each for each in ast.walk(function) if isinstance(each, ast.Name)]
        read = {each.id for each in names if not isinstance(each.ctx, ast.Store)}
        for each in sorted(names, key=lambda name: -name.col_offset):  # from the right: columns stay valid
            if isinstance(each.ctx, ast.Store) and each.id not in read and not each.id.startswith("_"):
                line = lines[each.lineno - 1]
                offset = len(line.encode()[: each.col_offset].decode())
                lines[each.lineno - 1] = f"{line[:offset]}_{line[offset:]}"
    return "\n".join(lines)
