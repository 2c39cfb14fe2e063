"""What the page of a long recording gets: extremes and causes stay, and beliefs come and go as in the run."""

from collections.abc import Sequence
from math import sin

import pytest

from jacaros.look.page import thinning
from jacaros.look.page.thinning import span_of, thinned
from jacaros.look.records.records import Record

SECONDS = 600
RECENT = "[source(percept)]"


def belief(t: float, op: str, text: str, cause: int = 7) -> Record:
    return t, "belief", {"agent": "ann", "op": op, "belief": text, "cause": cause}


def changes(count: int, cause: int = 7) -> list[Record]:
    """A number that swings, as a belief, a property and a scan, ten times a second."""
    found: list[Record] = []
    before = 0.0
    for n in range(count):
        t, value = n / 10, round(sin(n / 7) * n, 3)
        found += [belief(t, "-", f"height({before}){RECENT}")] if n else []
        found.append(belief(t, "+", f"height({value}){RECENT}", cause))
        found.append((t, "property", {"artifact": "a", "name": "h", "key": 1, "values": [value]}))
        found.append((t, "laser", {"robot": "r", "from": 0, "step": 1, "ranges": [0, abs(value), 9000]}))
        before = value
    return found


def held(records: Sequence[Record]) -> list[set[str]]:
    """What is believed after each moment; a removal must name what was believed."""
    now: set[str] = set()
    found = []
    for _, kind, data in records:
        if kind == "belief":
            if data["op"] == "-":
                now.remove(data["belief"])
            else:
                now.add(data["belief"])
            found.append({*now})
    return found


@pytest.fixture(autouse=True)
def _short(monkeypatch) -> None:
    monkeypatch.setattr(thinning, "WHOLE", 1000)
    monkeypatch.setattr(thinning, "SPANS", 60)


def numbers(records: Sequence[Record]) -> list[tuple[float, float]]:
    return [(t, data["values"][0]) for t, kind, data in records if kind == "property"]


def test_a_short_recording_stays_whole() -> None:
    events = changes(100)
    assert span_of(events) == 0
    assert thinned(events) is events


def test_the_extremes_of_each_span_and_the_last_value_stay() -> None:
    events = changes(SECONDS * 10)
    kept, span = list(thinned(events)), span_of(events)
    assert len(kept) < len(events) / 10
    assert [t for t, _, _ in kept] == sorted(t for t, _, _ in kept)
    for number in range(60):
        whole, less = (
            [value for t, value in numbers(each) if int(t / span) == number] for each in (events, kept)
        )
        assert (min(whole), max(whole), whole[-1]) == (min(less), max(less), less[-1])
    assert all(len(each) <= 1 for each in held(kept))


def test_what_led_to_something_stays() -> None:
    decided = [(30.5, "deliberation", {"id": 9, "agent": "ann", "trigger": "+height(_)", "parent": 42})]
    events = sorted([*changes(3000), *decided], key=lambda each: each[0])
    place = next(n for n, (t, kind, data) in enumerate(events) if t == 30.2 and data.get("op") == "+")
    events[place] = belief(30.2, "+", events[place][2]["belief"], cause=42)
    assert events[place] in list(thinned(events))


def test_beliefs_that_are_gone_for_a_while_and_several_at_a_time_stay() -> None:
    gap = [belief(400.0, "-", changes(3000)[-3][2]["belief"]), belief(410.0, "+", f"height(1){RECENT}")]
    many = [belief(420.0 + n, "+", f"place({n})") for n in range(5)]
    gone: Record = (431.0, "property", {"artifact": "a", "name": "h"})
    events = [*changes(3000), *gap, *many, belief(430.0, "-", "place(2)"), gone]
    kept = list(thinned(events))
    found = held(kept)
    assert kept[-1] is gone
    assert found[-1] == {f"height(1){RECENT}", *(f"place({n})" for n in (0, 1, 3, 4))}
    assert set() in found
