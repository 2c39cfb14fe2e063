"""Definitions of types as people and mapping files need them: every path, its type and its unit."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.mapping.message_units import unit_of
from jacaros.ros.fields import DURATION, TIME, FieldType
from jacaros.ros.names import feedback_type, goal_type, request_type, response_type, result_type

Fields = Callable[[str], Mapping[str, FieldType]]
"""Gives the fields of a message type in full form."""


@dataclass(frozen=True, slots=True)
class Leaf:
    """A value in a message that is no message itself.

    Attributes:
        path: from the root, as mapping files write it; of the elements of an array, those of the first.
        type: of the value.
        unit: empty where there is none, or it is not known.
        owner: type of the message that has it as a field.
    """

    path: str
    type: FieldType
    unit: str = ""
    owner: str = ""

    @property
    def name(self) -> str:
        """The last field of the path."""
        return self.path.rpartition(".")[2]


def leaves(fields: Fields, type_name: str, path: str = "", unit: str = "") -> Iterator[Leaf]:
    """All values of a message type, in the order of its definition; raises `UnknownInterface`."""
    for name, kind in fields(type_name).items():
        here = f"{path}.{name}" if path else name
        own = unit_of(type_name, name) or unit
        if not kind.is_message:
            yield Leaf(here, kind, own, type_name)
        elif is_time(kind):
            yield Leaf(here, kind, "s")
        else:
            yield from leaves(fields, kind.base, f"{here}[0]" if kind.array else here, own)


def messages(fields: Fields, type_name: str) -> Iterator[str]:
    """The type itself and the types of the messages in it, times left out; raises `UnknownInterface`."""
    yield type_name
    for kind in fields(type_name).values():
        if kind.is_message and not is_time(kind):
            yield from messages(fields, kind.base)


def is_time(kind: FieldType) -> bool:
    """Whether a field is a time or duration: agents and mappings see seconds."""
    return kind.base in (TIME, DURATION)


def parts(type_name: str) -> dict[str, str]:
    """The message types of an interface by what they are: of a message itself, of a service request and response."""
    kind = type_name.split("/")[1]
    if kind == "srv":
        return {"request": request_type(type_name), "response": response_type(type_name)}
    if kind == "action":
        return {
            "goal": goal_type(type_name),
            "result": result_type(type_name),
            "feedback": feedback_type(type_name),
        }
    return {"message": type_name}


def value_at(message: Any, path: str) -> Any:
    """What stands at a path of `leaves`; None below an empty array."""
    for step in path.split("."):
        name, bracket, _ = step.partition("[")
        message = getattr(message, name)
        if bracket:
            if not len(message):
                return None
            message = message[0]
    return message
