"""Finding what a name means in a graph."""

import difflib
from dataclasses import dataclass
from enum import StrEnum

from jacaros.cli.graph.joining import Joined
from jacaros.errors import UsageError
from jacaros.ros.errors import NameInvalid
from jacaros.ros.graph import GraphContents


class Kind(StrEnum):
    """What a thing of the graph is."""

    TOPIC = "topic"
    SERVICE = "service"
    ACTION = "action"
    NODE = "node"
    TYPE = "type"


@dataclass(frozen=True, slots=True)
class Thing:
    """A thing of the graph.

    Attributes:
        name: absolute; of a type, its full form.
        type_name: in full form; empty when the graph does not tell, and for nodes.
    """

    kind: Kind
    name: str
    type_name: str = ""


def all_things(contents: GraphContents) -> list[Thing]:
    """Topics, actions, services and nodes, each sorted by name."""
    topics = [Thing(Kind.TOPIC, name, _first(info.types)) for name, info in sorted(contents.topics.items())]
    actions = [Thing(Kind.ACTION, name, type_name) for name, type_name in sorted(contents.actions.items())]
    services = [Thing(Kind.SERVICE, name, type_name) for name, type_name in sorted(contents.services.items())]
    return [*topics, *actions, *services, *(Thing(Kind.NODE, name) for name in contents.nodes)]


def find(joined: Joined, written: str) -> list[Thing]:
    """The things called *written*: an absolute name, one below the namespace, or a type.

    Raises:
        UsageError: there is none; the text names similar ones.
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
        raise UsageError(f"unknown name {name}{hint(name, [t.name for t in things])}")
    return found


def find_mappable(joined: Joined, written: str) -> list[Thing]:
    """What of the things called *written* a mapping can have: a node may be called like a topic.

    Raises:
        UsageError: there is nothing of that name, or only a node or a type.
    """
    things = find(joined, written)
    mappable = [thing for thing in things if thing.kind not in (Kind.NODE, Kind.TYPE)]
    if not mappable:
        found = things[0]
        raise UsageError(f"{found.name} is a {found.kind}; a mapping has topics, services and actions")
    return mappable


def hint(name: str, names: list[str]) -> str:
    """What may have been meant, as the end of a sentence."""
    near = near_names(name, names)
    if near:
        return f"; did you mean {' or '.join(near)}?"
    return "; `jacaros ros list` shows all names"


def near_names(name: str, names: list[str]) -> list[str]:
    """Up to three names like *name*: written like it, or with the same last part in another namespace."""
    last = name.rpartition("/")[2]
    same = [each for each in names if each.rpartition("/")[2] == last]
    return list(dict.fromkeys([*same, *difflib.get_close_matches(name, names, n=3, cutoff=0.7)]))[:3]


def _type_names(written: str) -> list[str]:
    """The types that a name without a slash in front may mean, in full form."""
    parts = written.split("/")
    if written.startswith(("/", "~")) or not parts[-1][:1].isupper() or len(parts) not in (2, 3):
        return []
    if len(parts) == 3:
        return [written] if parts[1] in ("msg", "srv", "action") else []
    return [f"{parts[0]}/{kind}/{parts[1]}" for kind in ("msg", "srv", "action")]


def _first(types: tuple[str, ...]) -> str:
    return types[0] if types else ""
