"""Follow paths through message types and messages."""

import keyword
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.artifacts.mapping.declared import ALL, HERE, Path, Step, WrongPath
from jacaros.files.texts import suggestion
from jacaros.ros.fields import FieldType

Fields = Callable[[str], Mapping[str, FieldType]]
"""Returns the fields of a message type, given in full form."""


def follow(path: Path, root: FieldType, fields: Fields) -> FieldType:
    """Return the type that a path leads to.

    Raises:
        WrongPath: a field does not exist.
        UnknownInterface: a type on the way is unknown.
    """
    here = root
    shown = ""
    for step in path.steps:
        if isinstance(step, str) and step.startswith("."):
            here = _field(path, step[1:], here, shown, fields)
            shown = f"{shown}.{step[1:]}".lstrip(".")
            continue
        if not here.array:
            raise WrongPath(
                f"`{path.text}`: {shown or 'the message'} is {here}, not an array", f"write {shown}"
            )
        if isinstance(step, int) and here.length and not -here.length <= step < here.length:
            at_most = "" if here.fixed else "at most "
            raise WrongPath(
                f"`{path.text}`: {shown} has {at_most}{here.length} elements",
                f"elements are {shown}[0] to {shown}[{here.length - 1}]",
            )
        here = here.element
        shown = f"{shown}[{step}]"
    return here


def _field(path: Path, name: str, here: FieldType, shown: str, fields: Fields) -> FieldType:
    where = shown or "the message"
    if here.array:
        raise WrongPath(
            f"`{path.text}`: {where} is an array, {here}",
            f"write {shown}[0].{name}, or {shown}[*].{name} for all",
        )
    if not here.is_message:
        raise WrongPath(f"`{path.text}`: {where} is {here} and has no fields", f"write {shown}")
    known = fields(here.base)
    if name not in known:
        listed = ", ".join(f"{field} ({kind})" for field, kind in known.items()) or "none"
        meant = suggestion(name, known)
        help = f"{meant} Its fields: {listed}" if meant else f"its fields: {listed}"
        raise WrongPath(f"`{path.text}`: {here.base} has no field `{name}`", help)
    return known[name]


Getter = Callable[[Any, int], Any]
"""Takes a message and the index of the current element; returns the value at a path."""


def getter(path: Path) -> Getter:
    """Return a function that follows a path, compiled to one expression: sensors send a thousand messages a second."""
    made: Getter = eval(f"lambda m, i: {_expression(path.steps, 'm', 0)}", {})
    return made


def _expression(steps: tuple[Step, ...], value: str, depth: int) -> str:
    for place, step in enumerate(steps):
        if step == ALL:
            each = f"e{depth}"
            return f"[{_expression(steps[place + 1 :], each, depth + 1)} for {each} in {value}]"
        if isinstance(step, str) and step != HERE:
            name = step[1:]
            value = f"getattr({value}, {name!r})" if keyword.iskeyword(name) else f"{value}.{name}"
        else:
            value = f"{value}[{step}]"
    return value
