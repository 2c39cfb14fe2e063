"""Find the topic, service, action, node or type that a name means."""

from dataclasses import dataclass
from enum import StrEnum

from jacaros.cli.graph.joining import Joined
from jacaros.cli.usage import usage_error
from jacaros.errors import UsageError
from jacaros.files.texts import did_you_mean
from jacaros.ros.backend import GraphContents
from jacaros.ros.errors import NameInvalid
from jacaros.ros.names import near_names


class Kind(StrEnum):
    """Kinds of entries of a graph."""

    TOPIC = "topic"
    SERVICE = "service"
    ACTION = "action"
    NODE = "node"
    TYPE = "type"


@dataclass(frozen=True, slots=True)
class Thing:
    """An entry of a graph.

    Attributes:
        name: absolute name; for a type, its full name.
        type_name: full name of the type; empty if the graph does not report it, and for nodes.
    """

    kind: Kind
    name: str
    type_name: str = ""


def all_things(contents: GraphContents) -> list[Thing]:
    """Return topics, actions, services and nodes, each sorted by name."""
    topics = [Thing(Kind.TOPIC, name, _first(info.types)) for name, info in sorted(contents.topics.items())]
    actions = [Thing(Kind.ACTION, name, type_name) for name, type_name in sorted(contents.actions.items())]
    services = [Thing(Kind.SERVICE, name, type_name) for name, type_name in sorted(contents.services.items())]
    return [*topics, *actions, *services, *(Thing(Kind.NODE, name) for name in contents.nodes)]


def find(joined: Joined, written: str) -> list[Thing]:
    """Return the entries named *written*: an absolute name, a name relative to the namespace, or a type.

    Raises:
        UsageError: the name is unknown; the error suggests similar ones.
    """
    types = _type_names(written)
    if types:
        return [Thing(Kind.TYPE, name, name) for name in types]
    try:
        name = joined.backend.resolve(written)
    except NameInvalid as wrong:
        raise UsageError(str(wrong)) from None
    things = all_things(joined.contents)
    found = [thing for thing in things if thing.name == name]
    if not found:
        raise usage_error(
            f"unknown name: `{name}`",
            did_you_mean(near_names(name, [t.name for t in things]), "`jacaros ros list` shows all names"),
        )
    return found


def find_mappable(joined: Joined, written: str) -> list[Thing]:
    """Return the entries named *written* that a mapping can contain: a node may have the same name as a topic.

    Raises:
        UsageError: the name is unknown, or names only a node or a type.
    """
    things = find(joined, written)
    mappable = [thing for thing in things if thing.kind not in (Kind.NODE, Kind.TYPE)]
    if not mappable:
        found = things[0]
        raise usage_error(
            f"`{found.name}` is a {found.kind}", "a mapping file contains topics, services and actions"
        )
    return mappable


def _type_names(written: str) -> list[str]:
    """Return the full names of the types that a name without a leading slash may mean."""
    parts = written.split("/")
    if written.startswith(("/", "~")) or not parts[-1][:1].isupper() or len(parts) not in (2, 3):
        return []
    if len(parts) == 3:
        return [written] if parts[1] in ("msg", "srv", "action") else []
    return [f"{parts[0]}/{kind}/{parts[1]}" for kind in ("msg", "srv", "action")]


def _first(types: tuple[str, ...]) -> str:
    return types[0] if types else ""
