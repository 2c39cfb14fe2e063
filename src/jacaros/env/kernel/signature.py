"""The parameters of an operation: how many arguments it takes, of which kinds, and which are outputs."""

import inspect
import types
import typing
from collections.abc import Callable
from importlib import import_module
from typing import Any, NamedTuple

from jacaros.env.errors import InvalidArtifact
from jacaros.env.values import Atom, Out, Structure, text

Accept = Callable[[Any], object]
"""Takes an argument and gives what the operation receives; raises `Unsuitable`."""


class Unsuitable(Exception):
    """An argument is not of the kind that a parameter takes."""


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
        fewest: least number of arguments.
    """

    __slots__ = ("_accepts", "fewest", "parameters", "rest")

    def __init__(self, parameters: tuple[Parameter, ...], rest: Parameter | None) -> None:
        self.parameters, self.rest = parameters, rest
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
        except Unsuitable:
            position = len(bound)
            parameter = self._parameter(position)
            raise WrongArguments(
                f"parameter {parameter.name} (number {position + 1}) wants {parameter.expected}, "
                f"got {_shown(arguments[position])}"
            ) from None
        return tuple(bound)

    def _parameter(self, position: int) -> Parameter:
        if position < len(self.parameters):
            return self.parameters[position]
        assert self.rest is not None
        return self.rest

    def __str__(self) -> str:
        shown = [
            f"-{p.name}" if p.output else f"{p.name}: {p.expected}" + (" (optional)" if p.optional else "")
            for p in self.parameters
        ]
        return ", ".join([*shown, "..."] if self.rest else shown)


def signature_of(function: Callable[..., object], skip_first: bool) -> Signature:
    """Read the signature of an operation from its Python function.

    Raises:
        InvalidArtifact: it has parameters that agents cannot give (keyword-only or ``**``).
    """
    listed = list(inspect.signature(function).parameters.values())[1 if skip_first else 0 :]
    kinds = _annotations(function)
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
    return Signature(tuple(parameters), rest)


def _annotations(function: Callable[..., object]) -> dict[str, Any]:
    """The annotations, with those written as text resolved; what cannot be resolved accepts anything."""
    try:
        return {name: _known(kind) for name, kind in typing.get_type_hints(function).items()}
    except Exception:
        names = {**vars(typing), "Out": Out, "Atom": Atom, "Structure": Structure}
        return {name: _resolved(kind, names) for name, kind in written_annotations(function).items()}


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
    return _known(names.get(kind.rpartition(".")[2], object) if isinstance(kind, str) else kind)


def _known(kind: Any) -> Any:
    return object if kind is Any else kind


def _parameter(each: inspect.Parameter, annotation: Any, takes_outputs: bool) -> Parameter:
    expected = "any value" if annotation is object else _described(annotation)
    optional = each.default is not each.empty
    accept = _anything if takes_outputs else _acceptor(annotation)
    return Parameter(each.name, expected, annotation is Out, optional, accept)


def _described(annotation: Any) -> str:
    if annotation is Out:
        return "an unbound variable (it is an output)"
    if isinstance(annotation, types.UnionType) or typing.get_origin(annotation) is typing.Union:
        return " or ".join(_described(member) for member in typing.get_args(annotation))
    return _DESCRIPTIONS.get(annotation) or _plain_name(annotation)


def _plain_name(annotation: Any) -> str:
    if isinstance(annotation, type) and not typing.get_args(annotation):
        return annotation.__name__
    return str(annotation).replace("typing.", "")


_DESCRIPTIONS: dict[Any, str] = {
    int: "an integer",
    float: "a number",
    str: "a text",
    bool: "true or false",
    list: "a list",
    dict: "a map",
    Atom: "an atom",
    Structure: "a structure",
    type(None): "nothing",
    object: "any value",
}


def _shown(argument: object) -> str:
    return "an unbound variable" if isinstance(argument, Out) else text(argument, quoted=True)


def _acceptor(annotation: Any) -> Accept:
    simple = _ACCEPTORS.get(annotation)
    if simple is not None:
        return simple
    origin = typing.get_origin(annotation)
    if isinstance(annotation, types.UnionType) or origin is typing.Union:
        return _any_of(tuple(_acceptor(member) for member in typing.get_args(annotation)))
    if origin is typing.Literal:
        return _one_of(typing.get_args(annotation))
    if origin in (list, dict):
        return _container(origin, typing.get_args(annotation))
    if isinstance(annotation, type) and not _is_mere_protocol(annotation):
        return _instance_of(annotation)
    return _input


def _anything(argument: object) -> object:
    return argument


def _input(argument: object) -> object:
    if isinstance(argument, Out):
        raise Unsuitable
    return argument


def _integer(argument: object) -> object:
    if type(argument) is int:
        return argument
    if isinstance(argument, float) and argument.is_integer():
        return int(argument)
    raise Unsuitable


def _real(argument: object) -> object:
    if type(argument) is float:
        return argument
    if type(argument) is int:
        try:
            return float(argument)
        except OverflowError:
            raise Unsuitable from None
    raise Unsuitable


def _is_mere_protocol(kind: type) -> bool:
    return bool(getattr(kind, "_is_protocol", False) and not getattr(kind, "_is_runtime_protocol", False))


def _instance_of(kind: type) -> Accept:
    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        raise Unsuitable

    return accept


def _any_of(acceptors: tuple[Accept, ...]) -> Accept:
    """The first member that takes the argument as it is wins over one that would convert it."""

    def accept(argument: object) -> object:
        converted: list[object] = []
        for each in acceptors:
            try:
                result = each(argument)
            except Unsuitable:
                continue
            if result is argument:
                return argument
            converted.append(result)
        if not converted:
            raise Unsuitable
        return converted[0]

    return accept


def _one_of(choices: tuple[object, ...]) -> Accept:
    def accept(argument: object) -> object:
        if argument in choices:
            return argument
        raise Unsuitable

    return accept


def _container(kind: type, members: tuple[Any, ...]) -> Accept:
    accept_members = [_acceptor(member) for member in members]

    def accept_list(argument: object) -> object:
        if not isinstance(argument, list):
            raise Unsuitable
        return [accept_members[0](item) for item in argument]

    def accept_dict(argument: object) -> object:
        if not isinstance(argument, dict):
            raise Unsuitable
        return {accept_members[0](key): accept_members[1](item) for key, item in argument.items()}

    return accept_list if kind is list else accept_dict


_ACCEPTORS: dict[Any, Accept] = {
    object: _input,
    Any: _input,
    int: _integer,
    float: _real,
    type(None): _instance_of(type(None)),
}
