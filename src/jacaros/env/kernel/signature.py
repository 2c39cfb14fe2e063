"""The parameters of an operation: the number of arguments, their kinds, and the outputs."""

import inspect
import typing
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from jacaros.env.errors import InvalidArtifact
from jacaros.env.kernel.acceptance import kind_of
from jacaros.env.kernel.kinds import Accept, Unsuitable, shown
from jacaros.env.values import Atom, Out, Structure

_ANY_OUTPUT = kind_of(Out).expected
_NOTHING = object()
"""Marks an annotation that cannot be resolved."""


class WrongArguments(Exception):
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
    accept: Accept


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
            raise WrongArguments(
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
