"""From a parameter's Python annotation to a check that converts plain values and describes what it expects."""

import collections.abc
import enum
import sys
import types
import typing
from collections.abc import Callable
from typing import Any

from jacaros.env.kernel import kinds
from jacaros.env.kernel.kinds import ANYTHING, Kind, Unsuitable, accept_part, alternatives, instance_of
from jacaros.env.values import Atom, Out, Structure, equal, text


def kind_of(annotation: Any) -> Kind:
    """Return the kind of values that a parameter with *annotation* accepts. An unknown annotation accepts any input."""
    annotation = _unwrapped(annotation)
    if _hashable(annotation) and annotation in _SIMPLE:
        return _SIMPLE[annotation]
    origin, members = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in (typing.Union, types.UnionType):
        return alternatives([kind_of(member) for member in members])
    if origin is typing.Literal:
        return _choice(members)
    if origin is Out:
        return _SIMPLE[Out]
    container = origin if origin is not None else annotation
    made = _CONTAINERS.get(container) if _hashable(container) else None
    if made is not None:
        return made(members)
    if _of_numpy(container, "ndarray"):
        return _array(container, members)
    if isinstance(container, type):
        return _kind_of_class(container)
    return ANYTHING


def _hashable(annotation: Any) -> bool:
    return isinstance(annotation, collections.abc.Hashable)


def _unwrapped(annotation: Any) -> Any:
    """Resolve new types, annotated types and aliases."""
    while True:
        if isinstance(annotation, typing.NewType):
            annotation = annotation.__supertype__
        elif typing.get_origin(annotation) is typing.Annotated:
            annotation = typing.get_args(annotation)[0]
        elif _is_alias(annotation):
            annotation = annotation.__value__
        elif _is_alias(typing.get_origin(annotation)):
            annotation = _alias_of(annotation)
        else:
            return annotation


def _is_alias(annotation: Any) -> bool:
    # By name: Python 3.11 has only the aliases of typing_extensions.
    return type(annotation).__name__ == "TypeAliasType"


def _alias_of(annotation: Any) -> Any:
    """Resolve an alias with parameters, such as numpy's ``NDArray[float64]``."""
    alias = typing.get_origin(annotation)
    given = dict(zip(alias.__type_params__, typing.get_args(annotation), strict=False))
    value = alias.__value__
    parameters = getattr(value, "__parameters__", ())
    return value[tuple(given.get(each, Any) for each in parameters)] if parameters else value


def _kind_of_class(kind: type) -> Kind:
    if issubclass(kind, enum.Enum):
        return _member(kind)
    fields = kinds.fields_of(kind)
    if fields is not None:
        return kinds.record(kind, fields, kind_of)
    if getattr(kind, "_is_protocol", False) and not getattr(kind, "_is_runtime_protocol", False):
        return ANYTHING
    return instance_of(kind, kind.__name__)


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


def _text(argument: object) -> object:
    """Accept a string. An atom becomes one, so that output does not depend on how the caller wrote it."""
    if not isinstance(argument, str):
        raise Unsuitable
    return str(argument) if type(argument) is not str else argument


def _choice(choices: tuple[object, ...]) -> Kind:
    def accept(argument: object) -> object:
        for choice in choices:
            if argument is choice or equal(argument, choice):
                return argument
        raise Unsuitable

    return Kind(" or ".join(text(choice, quoted=True) for choice in choices), accept)


def _member(kind: type[enum.Enum]) -> Kind:
    """Accept a member of an enumeration, by its name in any case, or by its value."""
    members = list(kind)
    by_name = {member.name.lower(): member for member in members}

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        found = by_name.get(argument.lower()) if isinstance(argument, str) else None
        if found is None:
            found = next((member for member in members if equal(argument, member.value)), None)
        if found is None:
            raise Unsuitable
        return found

    return Kind(f"one of {', '.join(by_name)}", accept)


def _list_like(make: Callable[[list[Any]], object]) -> Callable[[tuple[Any, ...]], Kind]:
    def kind(members: tuple[Any, ...]) -> Kind:
        each = kind_of(members[0]) if members else None

        def accept(argument: object) -> object:
            if not isinstance(argument, list):
                raise Unsuitable
            return make(
                argument
                if each is None
                else [accept_part(each, item, "element", n) for n, item in enumerate(argument, 1)]
            )

        return Kind("a list" if each is None or each is ANYTHING else f"a list, each {each.expected}", accept)

    return kind


def _tuple(members: tuple[Any, ...]) -> Kind:
    """Accept a list of this length as a tuple of these members; ``tuple[T, ...]`` accepts any length."""
    if not members or members[-1] is Ellipsis:
        return _list_like(tuple)(members[:1])
    kinds = [kind_of(member) for member in members]

    def accept(argument: object) -> object:
        if not isinstance(argument, list):
            raise Unsuitable
        if len(argument) != len(kinds):
            raise Unsuitable(f"it has {len(argument)} elements")
        pairs = zip(kinds, argument, strict=True)
        return tuple(accept_part(kind, item, "element", n) for n, (kind, item) in enumerate(pairs, 1))

    return Kind(f"a list of {len(kinds)} ({', '.join(kind.expected for kind in kinds)})", accept)


def _set_of(make: Callable[[list[Any]], object]) -> Callable[[list[Any]], object]:
    def accept(items: list[Any]) -> object:
        try:
            return make(items)
        except TypeError:
            raise Unsuitable("lists and maps cannot be members of a set") from None

    return accept


def _mapping(members: tuple[Any, ...]) -> Kind:
    keys, values = (kind_of(member) for member in members) if members else (None, None)

    def accept(argument: object) -> object:
        if not isinstance(argument, dict):
            raise Unsuitable
        if keys is None or values is None:
            return argument
        return {
            accept_part(keys, key, "key"): accept_part(values, item, "the value of", key)
            for key, item in argument.items()
        }

    if keys is None or values is None:
        return Kind("a map", accept)
    return Kind(f"a map from {keys.expected} to {values.expected}", accept)


def _of_numpy(kind: Any, name: str) -> bool:
    """Return whether it is a class of numpy, which the author of the annotation has imported."""
    numpy = sys.modules.get("numpy")
    wanted = getattr(numpy, name, None)
    return isinstance(wanted, type) and isinstance(kind, type) and issubclass(kind, wanted)


def _array(container: Any, members: tuple[Any, ...]) -> Kind:
    numpy = sys.modules["numpy"]
    kinds = (kind for member in members for kind in typing.get_args(member))
    wanted = next((kind for kind in kinds if _of_numpy(kind, "generic")), None)

    def accept(argument: object) -> object:
        if isinstance(argument, container):
            return argument
        if not isinstance(argument, list):
            raise Unsuitable
        try:
            made = numpy.array(argument)
        except (ValueError, TypeError):
            raise Unsuitable from None
        if made.dtype.kind not in "biuf":
            raise Unsuitable
        if wanted is None:
            return made
        converted = made.astype(wanted)
        if not _of_numpy(wanted, "floating") and not numpy.array_equal(made, converted):
            raise Unsuitable
        return converted

    whole = wanted is not None and _of_numpy(wanted, "integer")
    return Kind(f"a list of {'integers' if whole else 'numbers'} (or of such lists of equal length)", accept)


def _takes_none(argument: object) -> object:
    if argument is None:
        return argument
    raise Unsuitable


_SIMPLE: dict[Any, Kind] = {
    object: ANYTHING,
    Any: ANYTHING,
    int: Kind("an integer", _integer),
    float: Kind("a number", _real),
    str: Kind("a text", _text),
    type(None): Kind("nothing", _takes_none),
    None: Kind("nothing", _takes_none),
    bool: instance_of(bool, "true or false"),
    Atom: instance_of(Atom, "an atom"),
    Structure: instance_of(Structure, "a structure"),
    Out: instance_of(Out, "an unbound variable (it is an output)"),
}

_LIST = _list_like(lambda items: items)
_CONTAINERS: dict[Any, Callable[[tuple[Any, ...]], Kind]] = {
    list: _LIST,
    tuple: _tuple,
    set: _list_like(_set_of(set)),
    frozenset: _list_like(_set_of(frozenset)),
    dict: _mapping,
    collections.abc.Mapping: _mapping,
    collections.abc.MutableMapping: _mapping,
    collections.abc.Sequence: _LIST,
    collections.abc.MutableSequence: _LIST,
    collections.abc.Collection: _LIST,
    collections.abc.Iterable: _LIST,
    collections.abc.Set: _list_like(_set_of(set)),
}
