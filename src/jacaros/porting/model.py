"""The classes of a Java file, with the names that their members get in Python."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from dataclasses import field as attribute
from typing import TYPE_CHECKING

from jacaros.artifacts import Artifact
from jacaros.porting.reading import (
    JavaFile,
    annotation_text,
    children,
    classes,
    every,
    field,
    marks,
    modifiers,
    source,
)
from jacaros.porting.types import JavaType, type_of

if TYPE_CHECKING:
    from tree_sitter import Node

TAKEN = frozenset(
    {
        *(
            "self",
            "abs",
            "all",
            "any",
            "bool",
            "dict",
            "enumerate",
            "float",
            "hash",
            "id",
            "int",
            "isinstance",
            "iter",
        ),
        *(
            "len",
            "list",
            "map",
            "max",
            "min",
            "next",
            "object",
            "print",
            "range",
            "round",
            "set",
            "sorted",
            "str",
        ),
        *(
            "sum",
            "text",
            "tuple",
            "type",
            "math",
            "random",
            "re",
            "sys",
            "Any",
            "Artifact",
            "Atom",
            "ClassVar",
        ),
        *(
            "OperationFailed",
            "Out",
            "StrEnum",
            "Structure",
            "functor_of",
            "internal_operation",
            "initializer",
        ),
        *("link", "operation", "chr", "l", "O", "I"),
    }
)
"""Names that the written code uses, or that linters reject."""
_PAUSING = {"await", "await_time", "delay", "execLinkedOp", "makeArtifact"}
_WINDOWS = ("java.awt", "javax.swing")
_DATA = frozenset({"Point", "Dimension", "Rectangle", "Color"})
"""Classes of AWT that hold data."""
_OF_WINDOWS = re.compile(r"GridWorldView|J[A-Z][a-z]\w+|Canvas|Frame|Panel")
ROLES = {"OPERATION": "operation", "INTERNAL_OPERATION": "internal_operation", "LINK": "link"}
INIT = "init"
_SPECIAL = {"toString": "__str__", "equals": "__eq__", "hashCode": "__hash__"}


def local_name(name: str) -> str:
    """Return the name of a local variable in Python."""
    return f"{name}_" if name in TAKEN or keyword.iskeyword(name) else name


@dataclass(slots=True)
class Member:
    """A field of a class."""

    name: str
    type: JavaType
    value: Node | None
    is_static: bool


@dataclass(slots=True)
class Method:
    """A method or constructor.

    Attributes:
        java: its name in Java.
        name: its name in Python.
        parameters: names and types.
        takes_rest: whether the last parameter stands for any number of arguments.
        result: type of its result.
        roles: names of its decorators.
        guard: name of the guard in Java, or None.
        node: its declaration.
        pauses: whether it is a coroutine in Python.
    """

    java: str
    name: str
    parameters: list[tuple[str, JavaType]]
    takes_rest: bool
    result: JavaType
    roles: list[str]
    guard: str | None
    node: Node
    is_static: bool = False
    pauses: bool = False

    def accepts(self, count: int) -> bool:
        """Return whether it can be called with this number of arguments."""
        wanted = len(self.parameters)
        return count >= wanted - 1 if self.takes_rest else count == wanted


@dataclass(slots=True, eq=False)
class JavaClass:
    """A class of the file, or of a file beside it.

    Attributes:
        java: its file.
        file: all classes that it may use.
    """

    name: str
    node: Node
    base: str
    java: JavaFile
    file: FileModel
    members: dict[str, Member] = attribute(default_factory=dict)
    methods: list[Method] = attribute(default_factory=list)
    ports: list[str] = attribute(default_factory=list)
    is_inner: bool = False

    @property
    def lineage(self) -> list[JavaClass]:
        """The class and those that it extends, as far as they are known."""
        found: list[JavaClass] = [self]
        while (base := self.file.classes.get(found[-1].base)) and base not in found:
            found.append(base)
        return found

    @property
    def is_artifact(self) -> bool:
        """Whether it becomes an artifact."""
        return bool(self.ports) or self.base.endswith(("Artifact", "Environment")) or self._has_operations

    @property
    def is_environment(self) -> bool:
        """Whether it is an environment of Jason."""
        return self.base.endswith("Environment")

    @property
    def is_window(self) -> bool:
        """Whether it shows a window, which is left out."""
        return self.file.is_window(self.base)

    @property
    def is_enum(self) -> bool:
        """Whether it has constants only."""
        return self.node.type == "enum_declaration"

    @property
    def is_plain(self) -> bool:
        """Whether it becomes a class of Python that is not an artifact."""
        if sum(method.name == "__init__" for method in self.methods) > 1:
            return False
        known = ("", "Object", *(each.name for each in self.file.classes.values() if each is not self))
        return self.node.type == "class_declaration" and not self.is_artifact and self.base in known

    @property
    def setup(self) -> Method | None:
        """The method that `init` of ``GUIArtifact`` calls."""
        return self.method("setup", 0) if self.lineage[-1].base == "GUIArtifact" else None

    @property
    def _has_operations(self) -> bool:
        return any(method.roles for method in self.methods)

    def attribute(self, name: str) -> str:
        """Return the name of a field in Python."""
        reserved = self.is_artifact and hasattr(Artifact, name)
        clash = any(method.name == name for method in self.methods)
        return f"{name}_" if reserved or clash or keyword.iskeyword(name) else name

    def method(self, name: str, count: int, of_super: bool = False) -> Method | None:
        """Return the method for a call, which may be inherited; with *of_super* it must be."""
        known = (each for owner in self.lineage[of_super:] for each in owner.methods)
        return next((each for each in known if each.java == name and each.accepts(count)), None)


@dataclass(slots=True)
class FileModel:
    """All classes of a file, and those that it uses of the files beside it."""

    java: JavaFile
    classes: dict[str, JavaClass] = attribute(default_factory=dict)
    windows: set[str] = attribute(default_factory=set)

    def is_window(self, name: str) -> bool:
        """Return whether a type shows a window."""
        known = self.classes.get(name)
        if known is not None:
            return known.is_window
        return name in self.windows or _OF_WINDOWS.fullmatch(name) is not None

    @property
    def ported(self) -> frozenset[str]:
        """Names of the classes that Python code can use."""
        return frozenset(
            each.name for each in self.classes.values() if each.is_plain or each.is_enum or each.is_artifact
        )


Beside = Callable[[str], JavaFile | None]
"""Finds the file of a class beside the file that uses it."""


def model_of(java: JavaFile, beside: Beside) -> FileModel:
    """Read the classes of a file, and those that it uses of the files beside it."""
    model = FileModel(java)
    _add(java, model)
    asked = set(model.classes)
    waiting = [java]
    while waiting:
        for name in sorted(_named(waiting.pop()) - asked):
            asked.add(name)
            other = beside(name)
            if other is not None and any(each.name in model.classes for each in _add(other, model)):
                waiting.append(other)
    for found in sorted(model.classes.values(), key=lambda each: len(each.lineage)):
        _find_pauses(found)
    return model


def _named(java: JavaFile) -> set[str]:
    """Return the names of types in a file."""
    nodes = (*every(java.root, "type_identifier"), *every(java.root, "identifier"))
    return {name for node in nodes if (name := source(node))[:1].isupper()}


def _add(java: JavaFile, model: FileModel) -> list[JavaClass]:
    for each in every(java.root, "import_declaration"):
        name = source(children(each)[0])
        if name.startswith(_WINDOWS) and name.rpartition(".")[2] not in _DATA:
            model.windows.add(name.rpartition(".")[2])
    found = [_class_of(node, java, model) for node in classes(java.root)]
    bases = {each.base for each in model.classes.values()}
    others = [each for each in found if each.is_artifact and each.name not in bases]
    if java is model.java or not others:  # an artifact is a port of its own, unless another one extends it
        model.classes |= {each.name: each for each in found}
    return found


def _class_of(node: Node, java: JavaFile, model: FileModel) -> JavaClass:
    base = node.child_by_field_name("superclass")
    name = type_of(children(base)[0]).name if base else ""
    outer = node.parent is not None and node.parent.type == "class_body"
    found = JavaClass(source(field(node, "name")), node, name, java, model)
    found.is_inner = outer and "static" not in modifiers(node)
    if info := marks(node).get("ARTIFACT_INFO"):
        ports = (annotation_text(each, "name") for each in every(info, "annotation") if each is not info)
        found.ports = [port for port in ports if port]
    body = children(field(node, "body"))
    for declared in body:
        if declared.type in ("method_declaration", "constructor_declaration"):
            found.methods.append(_method_of(declared))
    _name_methods(found)
    for declared in body:
        if declared.type == "field_declaration":
            for each in declared.children_by_field_name("declarator"):
                name, value, kind = declarator(each, declared)
                found.members[name] = Member(name, kind, value, "static" in modifiers(declared))
    return found


def declarator(node: Node, declaration: Node) -> tuple[str, Node | None, JavaType]:
    """Return the name, initial value and type of a declared variable."""
    extra = node.child_by_field_name("dimensions")
    dimensions = source(extra).count("[") if extra else 0
    kind = type_of(declaration.child_by_field_name("type"), dimensions)
    return source(field(node, "name")), node.child_by_field_name("value"), kind


def _method_of(node: Node) -> Method:
    parameters, rest = [], False
    for each in children(node.child_by_field_name("parameters")):
        if each.type == "spread_parameter":
            kind, variable = [part for part in children(each) if part.type != "modifiers"]
            parameters.append((source(field(variable, "name")), type_of(kind)))
            rest = True
        elif each.type == "formal_parameter":
            parameters.append((source(field(each, "name")), type_of(each.child_by_field_name("type"))))
    marked = marks(node)
    guards = (annotation_text(marked[each], "guard") for each in ROLES if each in marked)
    name = source(field(node, "name"))
    return Method(
        name,
        name,
        parameters,
        rest,
        type_of(node.child_by_field_name("type")),
        [role for mark, role in ROLES.items() if mark in marked and name != INIT],
        next(filter(None, guards), None),
        node,
        "static" in modifiers(node),
    )


def _name_methods(found: JavaClass) -> None:
    """Give the methods names that are unique and free in Python."""
    used: set[str] = set()
    for method in found.methods:
        if method.node.type == "constructor_declaration":
            method.name = "__init__"
            continue
        name = method.java if found.is_artifact else _SPECIAL.get(method.java, method.java)
        if keyword.iskeyword(name) or (found.is_artifact and name != INIT and hasattr(Artifact, name)):
            name += "_"
        if name in used:
            name = f"{method.java}_{len(method.parameters)}"
        while name in used:
            name += "_"
        used.add(name)
        method.name = name


def _find_pauses(found: JavaClass) -> None:
    """Find the methods that wait; they are coroutines in Python, and so are their callers."""
    if not found.is_artifact:
        return
    changed = True
    while changed:
        changed = False
        for method in found.methods:
            if not method.pauses and any(
                _waits(call, found) for call in every(method.node, "method_invocation")
            ):
                method.pauses = changed = True


def _waits(call: Node, found: JavaClass) -> bool:
    target, name = call.child_by_field_name("object"), source(field(call, "name"))
    if target is not None and source(target) not in ("this", "super"):
        return (source(target), name) == ("Thread", "sleep")
    of_super = target is not None and source(target) == "super"
    own = found.method(name, len(children(field(call, "arguments"))), of_super)
    return own.pauses if own else name in _PAUSING


def literals(nodes: Iterable[Node]) -> list[str]:
    """Return the texts of string literals."""
    return [source(node)[1:-1] for node in nodes if node.type == "string_literal"]
