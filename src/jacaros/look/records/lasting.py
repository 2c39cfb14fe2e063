"""What lasts of a run when older records are dropped: the newest record about each subject."""

from collections.abc import Callable, Iterator
from typing import Any, Generic, NamedTuple, TypeVar

from jacaros.look.records.records import Data

T = TypeVar("T")


class _Rule(NamedTuple):
    """How a record changes the state: the fields that identify its subject, and whether the subject ends."""

    about: tuple[str, ...]
    over: Callable[[Data], bool] = lambda _: False
    first: bool = False
    """Whether the first record matters as well as the last."""
    replaces: str = ""
    """The kind of record that it replaces, if another one."""


_GOAL_ENDS = ("achieved", "failed", "recovered", "dropped", "replaced")
_RULES: dict[str, _Rule] = {
    "WorldLine": _Rule(()),
    "Frame": _Rule(()),
    "run": _Rule(()),
    "source": _Rule(("file",)),
    "ended": _Rule(()),
    "agent": _Rule(("agent",), lambda data: data.get("state") == "ended"),
    "program": _Rule(("agent",)),
    "belief": _Rule(("agent", "belief"), lambda data: data.get("op") == "-"),
    "goal": _Rule(("agent", "id"), lambda data: data.get("state") in _GOAL_ENDS, first=True),
    "intention": _Rule(("agent", "id"), lambda data: data.get("state") == "over"),
    "message": _Rule(("id",), lambda data: data.get("state") == "read"),
    "artifact": _Rule(("artifact",), lambda data: data.get("state") == "disposed"),
    "focus": _Rule(("agent", "artifact"), lambda data: not data.get("on")),
    "property": _Rule(("artifact", "name"), lambda data: data.get("values") is None),
    "operation": _Rule(("id",), lambda data: data.get("state") != "began"),
    "resource": _Rule(("resource",), lambda data: data.get("holder") is None),
    "member": _Rule(("member",), lambda data: data.get("state") == "left"),
    "path": _Rule(("robot",), lambda data: not data.get("points")),
    "laser": _Rule(("robot",)),
    "believed": _Rule(("robot",)),
    "graph": _Rule(()),
    "debug": _Rule(()),
    "fault": _Rule(("fault",), lambda data: data.get("state") not in ("begins", "acts")),
    "door_opened": _Rule(("door",)),
    "door_closed": _Rule(("door",), replaces="door_opened"),
    "person_comes": _Rule(("person",)),
    "person_goes": _Rule(("person",)),
    "person_walks": _Rule(("person",)),
    "person_stands": _Rule(("person",), replaces="person_walks"),
    "obstacle_placed": _Rule(("obstacle",)),
    "obstacle_removed": _Rule(("obstacle",), lambda _: True, replaces="obstacle_placed"),
}
"""By kind. Those of a recording's lines are named by their classes."""
_OF_AGENT = tuple(kind for kind, rule in _RULES.items() if rule.about[:1] == ("agent",))


class Lasting(Generic[T]):
    """The last record about each subject, of those that it was given in their order."""

    def __init__(self) -> None:
        self._kept: dict[tuple[Any, ...], list[T]] = {}

    def take(self, kind: str, data: Data, item: T) -> None:
        """Take a record, which stands for itself as *item*."""
        rule = _RULES.get(kind)
        if rule is None:
            return
        key = rule.replaces or kind, *(data.get(name) for name in rule.about)
        before = self._kept.pop(key, [])
        if not rule.over(data):
            self._kept[key] = [*before[:1], item] if rule.first else [item]
        elif kind == "agent":
            for each in [each for each in self._kept if each[1:2] == key[1:2] and each[0] in _OF_AGENT]:
                del self._kept[each]

    def __iter__(self) -> Iterator[T]:
        """Iterate over the records, those about one subject together."""
        return (item for items in self._kept.values() for item in items)
