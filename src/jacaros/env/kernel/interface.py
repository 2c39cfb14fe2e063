"""The operations of an artifact type by kind, computed once when the class is created."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

from jacaros.env.errors import InvalidArtifact
from jacaros.env.kernel.declaration import DeclaredOperation, declare_method, name_of
from jacaros.env.operation import INIT, LINK, OPERATION, Mark, marks_of
from jacaros.suggestions import aside


@dataclass(slots=True, eq=False, repr=False)
class OperationTable:
    """Operations of one kind, by name and number of arguments."""

    _exact: dict[tuple[str, int], DeclaredOperation] = field(default_factory=dict)
    _variable: dict[str, DeclaredOperation] = field(default_factory=dict)

    def add(self, declared: DeclaredOperation) -> None:
        """Add an operation. One that is declared deeper in the class hierarchy overrides those it overlaps.

        Raises:
            InvalidArtifact: another method of the same class takes the same number of arguments.
        """
        if declared.signature.rest is not None:
            _check_overlap(self._variable.get(declared.name), declared, "any number of")
            self._variable[declared.name] = declared
            return
        for arity in declared.signature.arities:
            _check_overlap(self._exact.get((declared.name, arity)), declared, str(arity))
            self._exact[declared.name, arity] = declared

    def find(self, name: str, arity: int) -> DeclaredOperation | None:
        """Return the operation for a call. An exact number of arguments has precedence over ``*args``."""
        found = self._exact.get((name, arity))
        if found is not None:
            return found
        found = self._variable.get(name)
        return found if found is not None and found.signature.takes(arity) else None

    def remove(self, name: str) -> None:
        """Remove all operations called *name*."""
        self._variable.pop(name, None)
        for key in [key for key in self._exact if key[0] == name]:
            del self._exact[key]

    def copy(self) -> "OperationTable":
        """Return a table that can be changed independently."""
        return OperationTable(dict(self._exact), dict(self._variable))

    def __iter__(self) -> Iterator[DeclaredOperation]:
        listed = (*self._exact.values(), *self._variable.values())
        return iter({id(each): each for each in listed if not each.common}.values())

    def keys(self) -> list[str]:
        """Return names and arities, such as ``inc/1`` and ``sum/any``, without operations that every artifact has."""
        exact = [f"{name}/{arity}" for (name, arity), each in self._exact.items() if not each.common]
        return exact + [f"{name}/any" for name in self._variable]

    def explain(self, name: str) -> str:
        """Return what exists instead of an operation *name*: other arities, or all operations."""
        keys = self.keys()
        same = [key for key in keys if key.rpartition("/")[0] == name]
        if same:
            return f"; it has {', '.join(same)}"
        offer = f" (it has {', '.join(keys)})" if keys else " (it has none)"
        return offer + aside(name, [key.rpartition("/")[0] for key in keys])


def _check_overlap(present: DeclaredOperation | None, new: DeclaredOperation, arity: str) -> None:
    if present is not None and present.depth == new.depth and present.function is not new.function:
        raise InvalidArtifact(
            f"{name_of(present.source)} and {name_of(new.source)} are both "
            f"{new.kind} {new.name} with {arity} arguments; rename one of them"
        )


@dataclass(frozen=True, slots=True)
class Interface:
    """All operations of an artifact type, or of one artifact that defines more of its own.

    Attributes:
        operations: operations for agents.
        links: operations for other artifacts.
        internals: operations that it starts itself.
        inits: the methods ``init``, of which one is called at creation.
    """

    operations: OperationTable = field(default_factory=OperationTable)
    links: OperationTable = field(default_factory=OperationTable)
    internals: OperationTable = field(default_factory=OperationTable)
    inits: OperationTable = field(default_factory=OperationTable)

    def table(self, kind: str) -> OperationTable:
        """Return the table of operations of one kind."""
        return {OPERATION: self.operations, LINK: self.links, INIT: self.inits}.get(kind, self.internals)

    def own(self, operation: str | Callable[..., object], arity: int) -> DeclaredOperation | None:
        """Return the operation that an artifact starts itself, by name or by method."""
        if isinstance(operation, str):
            found = self.internals.find(operation, arity)
            return found if found is not None else self.operations.find(operation, arity)
        function = _unwatched(getattr(operation, "__func__", operation))
        usual = self.internals.find(getattr(function, "__name__", ""), arity)
        if usual is not None and usual.function is function:
            return usual
        for declared in chain(self.internals, self.operations):
            if declared.function is function and declared.signature.takes(arity):
                return declared
        return None

    def unknown_annotations(self) -> Iterator[tuple[str, str, str]]:
        """Return operation, parameter and text of the annotations that cannot be resolved."""
        for declared in chain(self.operations, self.links, self.internals, self.inits):
            for parameter, written in declared.signature.unknown.items():
                yield name_of(declared.source), parameter, written

    def copy(self) -> "Interface":
        """Return an interface that can be changed independently."""
        return Interface(self.operations.copy(), self.links.copy(), self.internals.copy(), self.inits)


def interface_of(artifact_type: type) -> Interface:
    """Return the interface of an artifact class, from the marks on its methods.

    A method that is overridden without a decorator remains an operation, like any Python method.

    Raises:
        InvalidArtifact: a declaration is invalid. The message names the method.
    """
    marks: dict[str, tuple[int, tuple[Mark, ...]]] = {}
    for depth, each in enumerate(reversed(artifact_type.__mro__)):
        for attribute, member in vars(each).items():
            if marks_of(member):
                marks[attribute] = (depth, marks_of(member))
            if attribute == "init":
                others = tuple(mark for mark in marks_of(member) if mark.kind != INIT)
                marks[attribute] = (depth, (*others, Mark(INIT)))
    interface = Interface()
    for attribute, (depth, declared) in sorted(marks.items(), key=_depth):
        function = _unwatched(getattr(artifact_type, attribute))
        for mark in declared if callable(function) else ():
            interface.table(mark.kind).add(declare_method(mark, attribute, function, artifact_type, depth))
    return interface


def _unwatched(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the user-defined function. See `jacaros.env.kernel.unawaited.watch_operations`."""
    plain: Callable[..., Any] = getattr(function, "plain", function)
    return plain


def _depth(item: tuple[str, tuple[int, Any]]) -> int:
    return item[1][0]
