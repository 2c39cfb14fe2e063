"""Options of ready-made artifacts: the arguments of ``makeArtifact`` after the robot's name.

An option is a structure ``name(value)`` such as ``rate(5)``, anywhere in the argument list; several can also be given
as a list or a map. The only plain text or atom among the arguments is the robot's name.
"""

from collections.abc import Callable, Iterable, Mapping

from jacaros.artifacts.env.values import Atom, Structure


class WrongOption(ValueError):
    """Raised for an argument of ``makeArtifact`` that the artifact cannot use."""


ReadOption = Callable[[object], object]
"""Convert the value of an option. Raises `ValueError` with what was expected."""


def read_arguments(
    arguments: Iterable[object], known: Mapping[str, ReadOption], artifact: str
) -> tuple[str, dict[str, object]]:
    """Split the arguments of ``makeArtifact`` into the robot's name (empty if there is none) and options.

    Args:
        arguments: as given by the agent or the Python program.
        known: options of the artifact, each with its reader.
        artifact: type name, for messages.

    Raises:
        WrongOption: an option is unknown, its reader refuses the value, or there is a second robot name.
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
        raise WrongOption(f"{artifact} expects one robot name, found {', '.join(map(repr, names))}")
    return names[0] if names else "", options


def _pairs(argument: object, artifact: str) -> Iterable[tuple[str, object]]:
    if argument is None:
        return ()
    if isinstance(argument, Structure) and len(argument.arguments) == 1:
        return ((argument.functor, argument.arguments[0]),)
    if isinstance(argument, list):
        return [pair for each in argument for pair in _pairs(each, artifact)]
    if isinstance(argument, Mapping):
        return [(str(name), value) for name, value in argument.items()]
    raise WrongOption(f"{artifact} expects a robot name and options such as rate(5), found {argument!r}")


def _read(name: str, value: object, known: Mapping[str, ReadOption], artifact: str) -> object:
    reader = known.get(name)
    if reader is None:
        raise WrongOption(f"{artifact} has no option `{name}`; its options: {', '.join(sorted(known))}")
    try:
        return reader(value)
    except ValueError as error:
        raise WrongOption(f"{artifact}: option {name}({value!r}): expected {error}") from None


def text(value: object) -> str:
    """Read a text or atom."""
    if not isinstance(value, str):
        raise ValueError("a text")
    return str(value)


def number(value: object) -> float:
    """Read a number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("a number")
    return float(value)


def positive(value: object) -> float:
    """Read a number above zero."""
    if (result := number(value)) <= 0.0:
        raise ValueError("a number above zero")
    return result


def not_negative(value: object) -> float:
    """Read a number that is not negative."""
    if (result := number(value)) < 0.0:
        raise ValueError("a number that is not negative")
    return result


def bands(value: object) -> float | tuple[float, ...]:
    """Read a number for all fields, or a list with one for each."""
    if isinstance(value, list | tuple):
        return tuple(not_negative(part) for part in value)
    return not_negative(value)


def yes_or_no(value: object) -> bool:
    """Read ``true`` or ``false``."""
    if not isinstance(value, bool):
        raise ValueError("true or false")
    return value


def watching(value: object) -> bool | float:
    """Read ``true``, ``false``, or a number of seconds."""
    return value if isinstance(value, bool) else positive(value)


def one_of(*choices: str) -> ReadOption:
    """Return a reader for one of some words."""

    def read(value: object) -> Atom:
        if value not in choices:
            raise ValueError(" or ".join(choices))
        return Atom(value)

    return read
