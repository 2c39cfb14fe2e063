"""The declaration of an operation, made from a marked method or from a function."""

import inspect
import math
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from itertools import chain
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from jacaros.artifacts.env.arbiter import read_uses
from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.env.expectation import Expect, mistake_in
from jacaros.artifacts.env.operation import INIT, INTERNAL, LINK, OPERATION, Mark, WhenPreempted, marks_of
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.artifacts.kernel.acceptance import AcceptValue, Unsuitable, kind_of, shown
from jacaros.artifacts.kernel.effects import expecting
from jacaros.runtime.files.texts import aside

# The parameters of an operation: the number of arguments, their kinds, and the outputs.


_ANY_OUTPUT = kind_of(Out).expected
_NOTHING = object()
"""Marks an annotation that cannot be resolved."""


class ArgumentMismatch(Exception):
    """The arguments of a call do not match. The text names parameter, value and expected kind."""


class Parameter(NamedTuple):
    """One parameter of an operation.

    Attributes:
        name: its Python name.
        expected: the kind of value it accepts, for messages.
        output: whether the operation stores a result there.
        optional: whether it has a default value.
        accept: checks and converts an argument.
    """

    name: str
    expected: str
    output: bool
    optional: bool
    accept: AcceptValue


class Signature:
    """The parameters of one operation, computed once when its class is created.

    Attributes:
        parameters: the positional parameters.
        rest: accepts any number of further arguments (``*args``). None without.
        unknown: annotations that cannot be resolved, by parameter. Such a parameter accepts any value.
        fewest: least number of arguments.
        is_written: whether it is that of a Python function as written, not of a mapping file.
    """

    __slots__ = ("_accepts", "fewest", "is_written", "parameters", "rest", "unknown")

    def __init__(
        self,
        parameters: tuple[Parameter, ...],
        rest: Parameter | None,
        unknown: Mapping[str, str] = MappingProxyType({}),
        is_written: bool = True,
    ) -> None:
        self.is_written = is_written
        self.parameters, self.rest, self.unknown = parameters, rest, unknown
        self._accepts = tuple(parameter.accept for parameter in parameters)
        self.fewest = sum(not parameter.optional for parameter in parameters)

    @property
    def arities(self) -> range:
        """The numbers of arguments that it accepts without `rest`."""
        return range(self.fewest, len(self.parameters) + 1)

    def takes(self, count: int) -> bool:
        """Return whether it can be called with *count* arguments."""
        return self.fewest <= count and (self.rest is not None or count <= len(self.parameters))

    def bind(self, arguments: tuple[object, ...]) -> tuple[object, ...]:
        """Check *arguments*, whose number is right, and convert them.

        Raises:
            WrongArguments: one is not of the expected kind.
        """
        if not arguments:
            return arguments
        bound: list[object] = []
        try:
            if self.rest is None:
                for accept, argument in zip(self._accepts, arguments):  # noqa: B905  # defaults may be left out
                    bound.append(accept(argument))
            else:
                for position, argument in enumerate(arguments):
                    bound.append(self._parameter(position).accept(argument))
        except Unsuitable as unsuitable:
            position = len(bound)
            parameter = self._parameter(position)
            part = f": {unsuitable}" if str(unsuitable) else ""
            if isinstance(arguments[position], Out) and not parameter.output:
                part += "; give it a value before the call"
                if self.is_written:
                    part += f", or, for an output, annotate the parameter: `{parameter.name}: Out`"
            raise ArgumentMismatch(
                f"argument {position + 1} ({parameter.name}): expected {parameter.expected}, "
                f"found {shown(arguments[position])}{part}"
            ) from None
        return tuple(bound)

    def _parameter(self, position: int) -> Parameter:
        if position < len(self.parameters):
            return self.parameters[position]
        assert self.rest is not None
        return self.rest

    def __str__(self) -> str:
        shown = [_shown(each) for each in self.parameters]
        return ", ".join([*shown, "..."] if self.rest else shown)


def _shown(parameter: Parameter) -> str:
    """Return a parameter as text. Of most outputs only the name is known."""
    if not parameter.output:
        return f"{parameter.name}: {parameter.expected}" + (" (optional)" if parameter.optional else "")
    unknown = parameter.expected == _ANY_OUTPUT
    return f"-{parameter.name}" if unknown else f"-{parameter.name}: {parameter.expected}"


def signature_of(function: Callable[..., object], skip_first: bool) -> Signature:
    """Return the signature of an operation from its Python function.

    Raises:
        InvalidArtifact: it has parameters that agents cannot pass (keyword-only or ``**``), or no ``self``.
    """
    listed = list(inspect.signature(function).parameters.values())
    if skip_first:
        if not listed:
            raise InvalidArtifact(f"{function.__qualname__}: expected self as first parameter")
        if listed[0].kind is not inspect.Parameter.VAR_POSITIONAL:
            del listed[0]
    kinds, unknown = annotations_of(function)
    unknown.pop("return", None)
    parameters, rest = [], None
    for each in listed:
        if each.kind in (each.KEYWORD_ONLY, each.VAR_KEYWORD):
            raise InvalidArtifact(
                f"{function.__qualname__}: agents cannot pass the keyword parameter {each.name}"
            )
        annotation = kinds.get(each.name, object)
        if each.kind is each.VAR_POSITIONAL:
            rest = _parameter(each, annotation, takes_outputs=annotation is object)
        else:
            parameters.append(_parameter(each, annotation, takes_outputs=False))
    return Signature(tuple(parameters), rest, unknown, not hasattr(function, "__signature__"))


def annotations_of(function: Callable[..., object]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the annotations, resolved if they are strings; and those that cannot be resolved, which accept any value."""
    while isinstance(function, partial):
        function = function.func
    if not inspect.isroutine(function):
        function = type(function).__call__
    try:
        return {name: _known(kind) for name, kind in typing.get_type_hints(function).items()}, {}
    except Exception:
        names = {**vars(typing), "Out": Out, "Atom": Atom, "Structure": Structure}
        names.update(getattr(function, "__globals__", {}))
        written = _written(function)
        found = {name: _resolved(kind, names) for name, kind in written.items()}
        unknown = {name: written[name] for name, kind in found.items() if kind is _NOTHING}
        return {name: object if kind is _NOTHING else kind for name, kind in found.items()}, unknown


def _written(function: Callable[..., object]) -> dict[str, Any]:
    """Return the annotations of a function as written. Those that cannot be resolved are strings."""
    try:
        return dict(function.__annotations__)
    except NameError:
        # Since Python 3.14, they are resolved on access.
        library = import_module("annotationlib")
        found: dict[str, Any] = library.get_annotations(function, format=library.Format.STRING)
        return found


def _resolved(kind: Any, names: dict[str, Any]) -> Any:
    if not isinstance(kind, str):
        return _known(kind)
    try:
        return _known(eval(kind, names))  # user-defined code, which runs anyway
    except Exception:
        return _known(names.get(kind.rpartition(".")[2], _NOTHING))


def _known(kind: Any) -> Any:
    return object if kind is Any else kind


def _parameter(each: inspect.Parameter, annotation: Any, takes_outputs: bool) -> Parameter:
    kind = kind_of(annotation)
    optional = each.default is not each.empty
    accept = _anything if takes_outputs else kind.accept
    output = annotation is Out or typing.get_origin(annotation) is Out
    return Parameter(each.name, kind.expected, output, optional, accept)


def _anything(argument: object) -> object:
    return argument


FOR_ONE_ARTIFACT = 1_000_000
"""Depth of operations that an artifact defines itself: they override those of all its classes."""


@dataclass(frozen=True, slots=True)
class DeclaredOperation:
    """One operation of an artifact type.

    Attributes:
        name: its name for callers.
        kind: `OPERATION` (for agents), `LINK` (for other artifacts) or `INTERNAL`.
        function: takes the artifact and the arguments.
        source: the user-defined function, for messages and the manual.
        signature: its parameters.
        guard: takes the same as `function`. The operation waits while it is false.
        pausable: whether it obeys a pause.
        coroutine: whether it runs as a task, because it may have several steps.
        common: whether every artifact has it.
        depth: depth of its class in the hierarchy. A deeper class overrides those above it.
        uses: resources that it holds while it runs, without the name of the robot.
        when_preempted: what it does when they are taken away.
    """

    name: str
    kind: str
    function: Callable[..., Any]
    source: Callable[..., Any]
    signature: Signature
    guard: Callable[..., object] | None
    pausable: bool
    coroutine: bool
    depth: int
    common: bool = False
    uses: tuple[str, ...] = ()
    when_preempted: WhenPreempted = "finish"


def _nothing(_: object) -> None:
    """Do nothing."""


NOTHING: Final = DeclaredOperation(
    "nothing", INTERNAL, _nothing, _nothing, Signature((), None), None, False, False, 0
)
"""Stands for the operation of requests that have none: refused ones, sensor messages, an ``init`` that does not exist."""


def declare_method(
    mark: Mark, method: str, function: Callable[..., Any], owner: type, depth: int
) -> DeclaredOperation:
    """Declare *function*, the method *method* of the class *owner*, as an operation.

    Raises:
        InvalidArtifact: agents cannot pass one of its parameters, or its guard does not fit.
    """
    guard = None
    if mark.guard is not None:
        guard = getattr(owner, mark.guard, None)
        if not callable(guard):
            methods = [name for name in dir(owner) if not name.startswith("_")]
            help = aside(mark.guard, methods)
            raise InvalidArtifact(f"{function.__qualname__}: unknown guard method {mark.guard}{help}")
    signature = signature_of(function, skip_first=True)
    if guard is not None:
        guard = _suited(guard, signature_of(guard, skip_first=True), signature, function)
    return _declare(mark, mark.name or method, function, function, signature, guard, depth)


def declare_function(
    mark: Mark, name: str, function: Callable[..., Any], guard: Callable[..., Any] | None
) -> DeclaredOperation:
    """Declare a function, which does not take the artifact, as an operation of one artifact.

    Raises:
        InvalidArtifact: as for `declare_method`.
    """

    def call(_: object, *arguments: object) -> object:
        return function(*arguments)

    def check(_: object, *arguments: object) -> object:
        return guard(*arguments) if guard is not None else True

    signature = signature_of(function, skip_first=False)
    suited = None
    if guard is not None:
        suited = _suited(check, signature_of(guard, skip_first=False), signature, function)
    source = function
    while isinstance(source, partial):  # the docstring of a partial is that of the class
        source = source.func
    return _declare(mark, name, call, source, signature, suited, FOR_ONE_ARTIFACT)


def _declare(
    mark: Mark,
    name: str,
    function: Callable[..., Any],
    source: Callable[..., Any],
    signature: Signature,
    guard: Callable[..., object] | None,
    depth: int,
) -> DeclaredOperation:
    uses, when_preempted = _uses(mark, source)
    effects, conditions = (_expected(each, signature, source) for each in (mark.expect, mark.meanwhile))
    if any(each.signal for each in effects):
        raise InvalidArtifact(
            f"{name_of(source)}: expected a property in expect, found a signal; use meanwhile"
        )
    if expects := bool(effects or conditions):
        written = inspect.signature(source).parameters
        usual = {each.name: written[each.name].default for each in signature.parameters}
        function = expecting(function, usual, effects, conditions)
    return DeclaredOperation(
        name,
        mark.kind,
        function,
        source,
        signature,
        guard,
        mark.pausable,
        expects or inspect.iscoroutinefunction(source),
        depth,
        mark.common,
        uses,
        when_preempted,
    )


def _expected(
    given: Expect | Sequence[Expect], signature: Signature, source: Callable[..., Any]
) -> tuple[Expect, ...]:
    """Check the expectations of an operation."""
    given = (given,) if isinstance(given, Expect) else tuple(given)
    names = [parameter.name for parameter in signature.parameters]
    for each in given:
        if not isinstance(each, Expect) or not isinstance(each.values, list | tuple):
            wrong = f"expected an Expect with a list of patterns, found {each!r}"
            raise InvalidArtifact(f'{name_of(source)}: {wrong}; write Expect("docked", [True], within=2)')
        for pattern in each.values:
            if mistake := mistake_in(pattern, names):
                raise InvalidArtifact(f"{name_of(source)}: {each.name}: {'; '.join(mistake)}")
        if wrong := _wrong_setting(each):
            raise InvalidArtifact(f"{name_of(source)}: {each.name}: {wrong}")
    return given


def _wrong_setting(each: Expect) -> str:
    """Return what is wrong with the name, the time or the reason of an expectation; empty if nothing is."""
    is_figure = isinstance(each.within, int | float) and not isinstance(each.within, bool)
    if not is_figure or not 0 <= each.within < math.inf:
        return f"within must be a number of seconds, 0 or more, not {each.within!r}"
    atoms = [("name", each.name)]
    if each.reason is not None and not isinstance(each.reason, Structure):
        atoms.append(("reason", each.reason))
    for what, word in atoms:
        if not isinstance(word, str) or not word[:1].islower() or not word.replace("_", "a").isalnum():
            return f"{what} must be a lower-case letter, then letters, digits and _, not {word!r}"
    return ""


def _uses(mark: Mark, source: Callable[..., Any]) -> tuple[tuple[str, ...], WhenPreempted]:
    """Return what an operation uses, and what it does when it is preempted."""
    try:
        uses = read_uses(mark.uses)
    except ValueError as wrong:
        raise InvalidArtifact(f"{name_of(source)}: {wrong}") from None
    wanted = mark.when_preempted
    if wanted is None:
        return uses, "pause" if mark.pausable else "finish"
    if wanted not in ("pause", "cancel", "finish"):
        raise InvalidArtifact(
            f"{name_of(source)}: expected pause, cancel or finish as when_preempted, found {wanted!r}"
        )
    if wanted == "pause" and not mark.pausable:
        raise InvalidArtifact(f'{name_of(source)}: when_preempted="pause" needs pausable=True')
    return uses, wanted


def _suited(
    guard: Callable[..., object], takes: Signature, wanted: Signature, function: Callable[..., Any]
) -> Callable[..., object]:
    """Check a guard. It takes the parameters of the operation, or none."""
    if inspect.iscoroutinefunction(guard):
        raise InvalidArtifact(f"{name_of(function)}: expected a plain def as guard, found an async def")
    if not takes.parameters and takes.rest is None:
        return lambda artifact, *_: guard(artifact)
    if not all(map(takes.takes, wanted.arities)) or (wanted.rest is not None and takes.rest is None):
        raise InvalidArtifact(
            f"{name_of(function)}: expected a guard with the parameters of the operation ({wanted}), or none; "
            f"found ({takes})"
        )
    return guard


def name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function for messages."""
    return str(getattr(function, "__qualname__", function))


# The operations of an artifact type by kind, computed once when the class is created.


@dataclass(slots=True, eq=False, repr=False)
class OperationTable:
    """Operations of one kind, by name and number of arguments.

    Attributes:
        exact: those that take exactly this number of arguments, which nearly all calls use.
    """

    exact: dict[tuple[str, int], DeclaredOperation] = field(default_factory=dict)
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
            _check_overlap(self.exact.get((declared.name, arity)), declared, str(arity))
            self.exact[declared.name, arity] = declared

    def find(self, name: str, arity: int) -> DeclaredOperation | None:
        """Return the operation for a call. An exact number of arguments has precedence over ``*args``."""
        found = self.exact.get((name, arity))
        if found is not None:
            return found
        found = self._variable.get(name)
        return found if found is not None and found.signature.takes(arity) else None

    def remove(self, name: str) -> None:
        """Remove all operations called *name*."""
        self._variable.pop(name, None)
        for key in [key for key in self.exact if key[0] == name]:
            del self.exact[key]

    def copy(self) -> "OperationTable":
        """Return a table that can be changed independently."""
        return OperationTable(dict(self.exact), dict(self._variable))

    def __iter__(self) -> Iterator[DeclaredOperation]:
        listed = (*self.exact.values(), *self._variable.values())
        return iter({id(each): each for each in listed if not each.common}.values())

    def keys(self) -> list[str]:
        """Return names and arities, such as ``inc/1`` and ``sum/any``, without operations that every artifact has."""
        exact = [f"{name}/{arity}" for (name, arity), each in self.exact.items() if not each.common]
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
class UsageInterface:
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
        function = getattr(operation, "__func__", operation)
        usual = self.internals.find(getattr(function, "__name__", ""), arity)
        if usual is not None and usual.function is function:
            return usual
        for declared in chain(self.internals, self.operations):
            if declared.source is function and declared.signature.takes(arity):
                return declared
        return None

    def unknown_annotations(self) -> Iterator[tuple[str, str, str]]:
        """Return operation, parameter and text of the annotations that cannot be resolved."""
        for declared in chain(self.operations, self.links, self.internals, self.inits):
            for parameter, written in declared.signature.unknown.items():
                yield name_of(declared.source), parameter, written

    def copy(self) -> "UsageInterface":
        """Return an interface that can be changed independently."""
        return UsageInterface(self.operations.copy(), self.links.copy(), self.internals.copy(), self.inits)


def interface_of(artifact_type: type) -> UsageInterface:
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
    interface = UsageInterface()
    for attribute, (depth, declared) in sorted(marks.items(), key=_depth):
        function = getattr(artifact_type, attribute)
        for mark in declared if callable(function) else ():
            interface.table(mark.kind).add(declare_method(mark, attribute, function, artifact_type, depth))
    return interface


def _depth(item: tuple[str, tuple[int, Any]]) -> int:
    return item[1][0]
