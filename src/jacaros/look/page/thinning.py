"""Thin the numbers of a long recording for its page.

Twelve hours of a robot are a million poses, scans and distances, which take a browser a minute to read, and of which it
draws the extremes of each pixel. So the page gets the extremes of each of `SPANS` parts of the run, and every change that
led to something. Goals, intentions, operations and causes stay whole.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from typing import Any

from jacaros.look.records.records import Data, Record

WHOLE = 200_000
"""Maximum number of events of a recording that is not thinned: a page opens with them in about 3 s."""
SPANS = 1_500
"""Parts of the run: about the number of pixels of a curve."""

_FLAT = re.compile(r"(\w+)\(([^()\[\]\"]+)\)(\[.*)?")
_CAUSES = {"cause": "parent", "deliberation": "parent", "operation": "cause", "message": "cause"}
"""The field of records that names what led to them."""
_Numbered = tuple[int, Record]
"""A record with its place in the recording."""


def span_of(events: Sequence[Record]) -> float:
    """Return the seconds of which a page gets the extremes; 0 if it gets everything."""
    return max(t for t, _, _ in events) / SPANS if len(events) > WHOLE else 0.0


def thinned(events: Sequence[Record]) -> Iterable[Record]:
    """Return the records that a page needs, in their order."""
    span = span_of(events)
    return events if not span else _Thinning(span, events).run()


@dataclass
class _Change:
    """A new value of a subject; *removal* is the record that takes the old one, for a belief."""

    place: int
    record: Record
    removal: _Numbered | None = None


@dataclass
class _Subject:
    """A belief, a property or the scans of a robot in one span.

    Attributes:
        extremes: the changes with the lowest and the highest value of each number, as (value, change).
        kept: changes that led to something.
        last: the newest change; it is the value.
        shown: belief that the page has, as text.
        removal: record of a removed belief, until it is known whether another value replaces it.
        is_many: whether it had several values at one time; then nothing is thinned.
    """

    span: int = -1
    extremes: dict[tuple[int, bool], tuple[float, _Change]] = field(default_factory=dict)
    kept: list[_Change] = field(default_factory=list)
    last: _Change | None = None
    shown: str = ""
    removal: _Numbered | None = None
    is_many: bool = False

    def take(self, change: _Change, values: Sequence[float], matters: bool) -> None:
        """Take a change, which stays if it *matters*."""
        self.last = change
        if matters:
            self.kept.append(change)
        for index, value in enumerate(values):
            for is_high in (False, True):
                best = self.extremes.get((index, is_high))
                if best is None or (value > best[0] if is_high else value < best[0]):
                    self.extremes[index, is_high] = value, change

    def flush(self) -> Iterator[_Numbered]:
        """Yield what the page gets of this span, and begin the next one."""
        changes = [*self.kept, *(change for _, change in self.extremes.values())]
        found = {each.place: each for each in (*changes, *([self.last] if changes and self.last else ()))}
        for place, change in sorted(found.items()):
            t, event, data = change.record
            if change.removal is not None:
                removed = change.removal[1][2]
                yield change.removal[0], (t, event, {**removed, "belief": self.shown})
            self.shown = str(data.get("belief"))
            yield place, change.record
        self.extremes, self.kept = {}, []


class _Thinning:
    def __init__(self, span: float, events: Sequence[Record]) -> None:
        self._span, self._events = span, events
        self._causes = {data.get(_CAUSES[event]) for _, event, data in events if event in _CAUSES} - {None, 0}
        self._subjects: dict[tuple[Any, ...], _Subject] = {}
        self._held: dict[tuple[str, str], _Subject] = {}
        """The subjects of beliefs by agent and text."""
        self._found: list[_Numbered] = []

    def run(self) -> list[Record]:
        for place, record in enumerate(self._events):
            _, event, data = record
            if event == "belief" and data["op"] == "-":
                self._remove(place, record)
            elif (numbers := _numbers(event, data)) is not None:
                self._change(place, record, *numbers)
            else:
                self._found.append((place, record))
        for subject in self._subjects.values():
            self._found += [*subject.flush(), *([subject.removal] if subject.removal else ())]
        return [record for _, record in sorted(self._found, key=itemgetter(0))]

    def _remove(self, place: int, record: Record) -> None:
        subject = self._held.pop((record[2]["agent"], record[2]["belief"]), None)
        if subject is None or subject.is_many:
            self._found.append((place, record))
        else:
            subject.removal = place, record

    def _change(self, place: int, record: Record, about: tuple[Any, ...], values: Sequence[float]) -> None:
        t, event, data = record
        subject = self._subjects.setdefault(about, _Subject())
        removal, subject.removal = subject.removal, None
        matters = data.get("cause") in self._causes
        if event == "belief":
            self._held[data["agent"], data["belief"]] = subject
            subject.is_many = subject.is_many or (removal is None and subject.last is not None)
            if removal is not None and removal[1][0] != t:  # it was gone for a while
                self._found += [*subject.flush(), removal]
                removal = None
            matters = matters or removal is None
        if int(t / self._span) != subject.span or subject.is_many:
            self._found += subject.flush()
            subject.span = int(t / self._span)
        if subject.is_many:
            self._found.append((place, record))
        else:
            subject.take(_Change(place, record, removal), values, matters)


def _numbers(event: str, data: Data) -> tuple[tuple[Any, ...], Sequence[float]] | None:
    """Return what a record gives numbers to, and the numbers; None for one that stays."""
    if event == "laser":
        return (event, data["robot"]), [min((each for each in data["ranges"] if each), default=0.0)]
    if event == "property":
        values = data.get("values") or ()
        is_flat = bool(values) and all(type(each) in (int, float) for each in values)
        return ((event, data["artifact"], data["name"], data.get("key")), values) if is_flat else None
    found = _FLAT.fullmatch(data["belief"]) if event == "belief" else None
    if found is None:
        return None
    try:
        return (event, data["agent"], found[1], found[3]), [*map(float, found[2].split(","))]
    except ValueError:
        return None
