"""The parameters of an operation: how many arguments it takes, of which kinds, and which are outputs."""

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
"""What an annotation is that names nothing."""


class WrongArguments(Exception):
    """The arguments of a call do not fit; the text names parameter, value and expected kind."""


class Parameter(NamedTuple):
    """One parameter of an operation.

    Attributes:
        name: as in Python.
        expected: the kind of value it takes, for people.
        output: True when the operation leaves a result there.
        optional: True when it has a default value.
        accept: checks and converts an argument.
    """

    name: str
    expected: str
    output: bool
    optional: bool
    accept: Accept


class Signature:
    """The parameters of one operation, worked out once when its class is made.

    Attributes:
        parameters: those with a place of their own.
        rest: stands for any number of further arguments (``*args``); None when there are no more.
        unknown: annotations that name nothing, by parameter: it accepts anything.
        fewest: least number of arguments.
    """

    __slots__ = ("_accepts", "fewest", "parameters", "rest", "unknown")

    def __init__(
        self,
        parameters: tuple[Parameter, ...],
        rest: Parameter | None,
        unknown: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.parameters, self.rest, self.unknown = parameters, rest, unknown
        self._accepts = tuple(parameter.accept for parameter in parameters)
        self.fewest = sum(not parameter.optional for parameter in parameters)

    @property
    def arities(self) -> range:
        """The numbers of arguments that it takes without the help of `rest`."""
        return range(self.fewest, len(self.parameters) + 1)

    def takes(self, count: int) -> bool:
        """True when it can be called with *count* arguments."""
        return self.fewest <= count and (self.rest is not None or count <= len(self.parameters))

    def bind(self, arguments: tuple[object, ...]) -> tuple[object, ...]:
        """Check *arguments* (their number is right) and convert them to what the operation receives.

        Raises:
            WrongArguments: one is not of the kind that is wanted.
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
                part += f"; to give a result, annotate it: `{parameter.name}: Out`"
            raise WrongArguments(
                f"parameter {parameter.name} (number {position + 1}) wants {parameter.expected}, "
                f"got {shown(arguments[position])}{part}"
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
    """A parameter for people; of outputs mostly nothing is known but their name."""
    if not parameter.output:
        return f"{parameter.name}: {parameter.expected}" + (" (optional)" if parameter.optional else "")
    unknown = parameter.expected == _ANY_OUTPUT
    return f"-{parameter.name}" if unknown else f"-{parameter.name}: {parameter.expected}"


def signature_of(function: Callable[..., object], skip_first: bool) -> Signature:
    """Read the signature of an operation from its Python function.

    Raises:
        InvalidArtifact: it has parameters that agents cannot give (keyword-only or ``**``), or no ``self``.
    """
    listed = list(inspect.signature(function).parameters.values())
    if skip_first:
        if not listed:
            raise InvalidArtifact(f"{function.__qualname__}: its first parameter must be self")
        if listed[0].kind is not inspect.Parameter.VAR_POSITIONAL:
            del listed[0]
    kinds, unknown = _annotations(function)
    parameters, rest = [], None
    for each in listed:
        if each.kind in (each.KEYWORD_ONLY, each.VAR_KEYWORD):
            raise InvalidArtifact(
                f"{function.__qualname__}: agents cannot give the keyword parameter {each.name}"
            )
        annotation = kinds.get(each.name, object)
        if each.kind is each.VAR_POSITIONAL:
            rest = _parameter(each, annotation, takes_outputs=annotation is object)
        else:
            parameters.append(_parameter(each, annotation, takes_outputs=False))
    return Signature(tuple(parameters), rest, unknown)


def _annotations(function: Callable[..., object]) -> tuple[dict[str, Any], dict[str, str]]:
    """The annotations, with those written as text resolved; and those that cannot be, which accept anything."""
    while isinstance(function, partial):
        function = function.func
    if not inspect.isroutine(function):
        function = type(function).__call__
    try:
        return {name: _known(kind) for name, kind in typing.get_type_hints(function).items()}, {}
    except Exception:
        names = {**vars(typing), "Out": Out, "Atom": Atom, "Structure": Structure}
        names.update(getattr(function, "__globals__", {}))
        written = written_annotations(function)
        found = {name: _resolved(kind, names) for name, kind in written.items()}
        unknown = {
            name: written[name] for name, kind in found.items() if kind is _NOTHING and name != "return"
        }
        return {name: object if kind is _NOTHING else kind for name, kind in found.items()}, unknown


def written_annotations(function: Callable[..., object]) -> dict[str, Any]:
    """The annotations of a function as they are written; those that cannot be resolved are texts."""
    try:
        return dict(function.__annotations__)
    except NameError:
        # From Python 3.14 on they are resolved when they are asked for.
        library = import_module("annotationlib")
        found: dict[str, Any] = library.get_annotations(function, format=library.Format.STRING)
        return found


def _resolved(kind: Any, names: dict[str, Any]) -> Any:
    if not isinstance(kind, str):
        return _known(kind)
    try:
        return _known(eval(kind, names))  # it is the author's own code
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
