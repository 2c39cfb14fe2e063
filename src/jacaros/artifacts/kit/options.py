"""Options of ready-made artifacts: the arguments of ``makeArtifact`` after the robot name.

An option is a structure ``name(value)`` such as ``rate(5)``, at any place of the argument list; several may
also come as a list or a map.  The one plain text or atom among the arguments is the robot's name.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from jacaros.env.values import Atom, Structure


class WrongOption(ValueError):
    """An argument of ``makeArtifact`` that the artifact cannot use; the text says which it knows."""


Reader = Callable[[object], object]
"""Turns the value of an option into what the artifact wants; raises `ValueError` saying what it expected."""


@dataclass(frozen=True, slots=True)
class Arguments:
    """What an artifact was made with: the robot's name, empty for the only robot, and its options."""

    robot: str
    options: Mapping[str, object]


def read_arguments(arguments: Iterable[object], known: Mapping[str, Reader], artifact: str) -> Arguments:
    """Sort the arguments of ``makeArtifact`` into robot name and options.

    Args:
        arguments: as the agent or the Python program gave them.
        known: options of the artifact, each with its reader.
        artifact: type name, for messages.

    Raises:
        WrongOption: unknown option, value that its reader refuses, or a second robot name.
    """
    names: list[str] = []
    options: dict[str, object] = {}
    for argument in arguments:
        if isinstance(argument, str):
            names.append(str(argument))
            continue
        for name, value in _pairs(argument, artifact):
            options[name] = _read(name, value, known, artifact)
    if len(names) > 1:
        raise WrongOption(f"{artifact} takes one robot name, not {', '.join(map(repr, names))}")
    return Arguments(names[0] if names else "", options)


def _pairs(argument: object, artifact: str) -> Iterable[tuple[str, object]]:
    if argument is None:
        return ()
    if isinstance(argument, Structure) and len(argument.arguments) == 1:
        return ((argument.functor, argument.arguments[0]),)
    if isinstance(argument, list):
        return [pair for each in argument for pair in _pairs(each, artifact)]
    if isinstance(argument, Mapping):
        return [(str(name), value) for name, value in argument.items()]
    raise WrongOption(f"{artifact} takes a robot name and options like rate(5), not {argument!r}")


def _read(name: str, value: object, known: Mapping[str, Reader], artifact: str) -> object:
    reader = known.get(name)
    if reader is None:
        raise WrongOption(f"{artifact} has no option {name!r}; it knows {', '.join(sorted(known))}")
    try:
        return reader(value)
    except ValueError as error:
        raise WrongOption(f"{artifact}: option {name}({value!r}) wants {error}") from None


def text(value: object) -> str:
    """Any text or atom."""
    if not isinstance(value, str):
        raise ValueError("a text")
    return str(value)


def number(value: object) -> float:
    """Any number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("a number")
    return float(value)


def positive(value: object) -> float:
    """A number above zero."""
    if (result := number(value)) <= 0.0:
        raise ValueError("a number above zero")
    return result


def not_negative(value: object) -> float:
    """A number that is zero or more."""
    if (result := number(value)) < 0.0:
        raise ValueError("a number not below zero")
    return result


def bands(value: object) -> float | tuple[float, ...]:
    """A number for all fields, or a list with one for each."""
    if isinstance(value, list | tuple):
        return tuple(not_negative(part) for part in value)
    return not_negative(value)


def yes_or_no(value: object) -> bool:
    """``true`` or ``false``."""
    if not isinstance(value, bool):
        raise ValueError("true or false")
    return value


def watching(value: object) -> bool | float:
    """``true``, ``false``, or a number of seconds."""
    return value if isinstance(value, bool) else positive(value)


def one_of(*choices: str) -> Reader:
    """One of some words."""

    def read(value: object) -> Atom:
        if value not in choices:
            raise ValueError(" or ".join(choices))
        return Atom(value)

    return read
