"""The records for a page that connects late: the last part of the run, and the state at its beginning."""

from collections import deque
from collections.abc import Callable
from heapq import merge
from typing import Any, NamedTuple

from jacaros.inspector.live.records import LiveRecord
from jacaros.mas.history.records import Data, Happened, World

EVENTS, FRAMES = 20_000, 3_000
"""Maximum number of records kept, without those of the state."""


class _Rule(NamedTuple):
    """How an event changes the state: the fields that identify its subject, and whether the subject ends."""

    about: tuple[str, ...]
    over: Callable[[Data], bool] = lambda _: False
    first: bool = False
    """Whether the first record matters as well as the last."""


_GOAL_ENDS = ("achieved", "failed", "recovered", "dropped", "replaced")
_RULES: dict[str, _Rule] = {
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
    "path": _Rule(("robot",), lambda data: not data.get("points")),
    "laser": _Rule(("robot",)),
    "believed": _Rule(("robot",)),
    "graph": _Rule(()),
    "debug": _Rule(()),
    "fault": _Rule(("fault",), lambda data: data.get("state") != "begins"),
    "door_opened": _Rule(("door",)),
    "door_closed": _Rule(("door",)),
    "person_comes": _Rule(("person",)),
    "person_goes": _Rule(("person",)),
    "person_walks": _Rule(("person",)),
    "person_stands": _Rule(("person",)),
    "obstacle_placed": _Rule(("obstacle",)),
}
_AS = {"door_closed": "door_opened", "person_stands": "person_walks"}
"""Events that replace another event."""


class State:
    """The current state: the last record about each subject."""

    def __init__(self) -> None:
        self._last: dict[tuple[Any, ...], list[LiveRecord]] = {}

    def take(self, record: LiveRecord) -> None:
        """Update the state with a record."""
        match record.data:
            case Happened(event=event, data=about) if (rule := _RULES.get(event)) is not None:
                key = (_AS.get(event, event), *(about.get(name) for name in rule.about))
                before = self._last.get(key, [])
                self._put(key, [] if rule.over(about) else [*before[:1], record] if rule.first else [record])
            case World() | None:
                self._put((type(record.data),), [record])

    def _put(self, key: tuple[Any, ...], records: list[LiveRecord]) -> None:
        self._last.pop(key, None)
        if records:
            self._last[key] = records

    def records(self) -> list[LiveRecord]:
        """Return the records of the state in time order."""
        return sorted(
            {each.number: each for row in self._last.values() for each in row}.values(), key=_number
        )


def _number(record: LiveRecord) -> int:
    return record.number


class Past:
    """A bounded number of records, and the state before them.

    Args:
        events: maximum number of records kept; older ones survive only in the state.
        frames: maximum number of frames kept.
    """

    def __init__(self, events: int = EVENTS, frames: int = FRAMES) -> None:
        self._before = State()
        self._events: deque[LiveRecord] = deque()
        self._frames: deque[LiveRecord] = deque()
        self._newest: dict[str, LiveRecord] = {}
        self._limits = events, frames

    def take(self, record: LiveRecord) -> None:
        """Add a record."""
        if record.data is None:
            self._add(self._frames, record, self._limits[1])
        elif record.newest is not None:
            self._newest[record.newest] = record
        else:
            self._add(self._events, record, self._limits[0])

    def _add(self, kept: deque[LiveRecord], record: LiveRecord, limit: int) -> None:
        kept.append(record)
        if len(kept) > limit:
            self._before.take(kept.popleft())

    def records(self) -> list[LiveRecord]:
        """Return the state, followed by all kept records, in time order."""
        newest = sorted(self._newest.values(), key=_number)
        return [*self._before.records(), *merge(self._events, self._frames, newest, key=_number)]
