"""The records for one page: bounded, newest-only where that is enough, and complete again after the page was too slow."""

import json
from typing import Any

import pytest

from jacaros.look.page.live import delivery as delivering
from jacaros.look.page.live.commands import Commands
from jacaros.look.page.live.delivery import LONGEST, QUEUED, Backlog, Delivery, LiveRecord, json_text
from jacaros.look.page.live.live_view import LiveView
from jacaros.look.page.scene import RobotView
from jacaros.look.records.records import EventLine, Frame, WorldLine


def event(number: int, name: str, /, **data: object) -> LiveRecord:
    """A record of an event."""
    return LiveRecord(number, EventLine(float(number), name, data))


def received(delivery: Delivery) -> list[Any]:
    """Return all waiting records and notes, in order."""
    found: list[Any] = []
    while (message := delivery.take()) is not None:
        content = json.loads(message)
        found += content if isinstance(content, list) else [content]
    return found


def names(records: list[Any]) -> list[str]:
    """Events and kinds of records."""
    return [each.get("event", each["kind"]) for each in records]


def robot(x: float) -> RobotView:
    """A robot somewhere."""
    return RobotView("r1", x, 0.0, 0.0, 50.0)


def shown() -> tuple[LiveView, Delivery]:
    """A view, and the records of a page connected from the beginning."""
    view = LiveView("lab", Commands())
    delivery = view.begin()
    assert names(received(delivery)) == ["hello"]
    return view, delivery


def test_only_the_newest_frame_and_scan_of_a_robot_are_delivered() -> None:
    view, delivery = shown()
    for index in range(100):
        view.frame(index * 0.1, [robot(float(index))])
        view.event(index * 0.1, "laser", {"robot": "r1", "ranges": [index]})
        view.event(index * 0.1, "laser", {"robot": "r2", "ranges": [index + 1]})
    view.text(10.0, "bob", "hello")
    records = received(delivery)
    assert names(records) == ["text", "frame", "laser", "laser"]
    assert records[1]["robots"][0][0] == 99.0
    assert [each["data"]["ranges"] for each in records[2:]] == [[99], [100]]
    assert delivery.complete


def test_a_late_page_receives_earlier_records() -> None:
    view, _ = shown()
    view.world({"name": "lab"})
    for index in range(5):
        view.frame(float(index), [robot(float(index))])
        view.text(float(index), "bob", f"at {index}")
    late = received(view.begin())
    assert names(late) == ["hello", "world", *["frame", "text"] * 5]
    assert [each["robots"][0][0] for each in late if each["kind"] == "frame"] == [0, 1, 2, 3, 4]


def test_frames_without_motion_are_delivered_but_not_stored() -> None:
    view, delivery = shown()
    for index in range(50):
        view.frame(float(index), [robot(0.0)])
    view.frame(50.0, [robot(1.0)])
    assert [each["t"] for each in received(delivery)] == [50.0]
    late = received(view.begin())
    assert [each["t"] for each in late if each["kind"] == "frame"] == [0.0, 49.0, 50.0]


def test_a_slow_page_receives_the_number_of_missed_records_and_restarts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(delivering, "AGAIN", 0.0)
    view, delivery = shown()
    view.event(0.0, "belief", {"agent": "bob", "op": "+", "belief": "first"})
    for index in range(QUEUED + 50):
        view.text(1.0 + index, "bob", str(index))
    records = received(delivery)
    assert records[0] == {"kind": "missed", "records": QUEUED + 51}
    assert records[1]["kind"] == "hello"
    assert records[2]["data"]["belief"] == "first"
    assert records[-1]["text"] == str(QUEUED + 49)
    view.text(99999.0, "bob", "more")
    assert [each["text"] for each in received(delivery)] == ["more"]


def test_a_slow_page_does_not_restart_all_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(delivering, "real_time", lambda: now)
    view, delivery = shown()
    for _ in range(QUEUED + 1):
        view.text(1.0, "bob", "x")
    assert names(received(delivery))[:2] == ["missed", "hello"]
    for _ in range(QUEUED + 1):
        view.text(2.0, "bob", "y")
    assert received(delivery) == []
    assert not delivery.complete
    now += delivering.AGAIN
    view.text(3.0, "bob", "z")
    assert names(received(delivery))[:2] == ["missed", "hello"]


def test_records_are_bounded_and_the_state_is_kept() -> None:
    past = Backlog(events=10, frames=3)
    past.take(LiveRecord(0, WorldLine(world={"name": "lab"})))
    past.take(event(1, "source", file="bob.asl", text="a."))
    past.take(event(2, "belief", agent="bob", op="+", belief="kept"))
    past.take(event(3, "belief", agent="bob", op="+", belief="gone"))
    past.take(event(4, "belief", agent="bob", op="-", belief="gone"))
    past.take(event(5, "goal", agent="bob", id=1, state="pursued"))
    past.take(event(6, "goal", agent="bob", id=1, state="suspended"))
    past.take(event(7, "goal", agent="bob", id=2, state="pursued"))
    past.take(event(8, "goal", agent="bob", id=2, state="achieved"))
    past.take(event(9, "artifact", artifact="/main/a", state="made"))
    past.take(event(10, "property", artifact="/main/a", name="n", values=[1]))
    past.take(event(11, "property", artifact="/main/a", name="n", values=[2]))
    past.take(event(12, "operation", id=5, state="began"))
    past.take(event(13, "door_opened", door="gate"))
    past.take(event(14, "door_closed", door="gate"))
    past.take(event(15, "source", file="bob.asl", text="b."))
    for number in range(16, 116):
        past.take(event(number, "deliberation", id=number))
        past.take(LiveRecord(1000 + number, Frame(float(number), [])))
    state = [each.number for each in past.records()]
    assert state[:9] == [0, 2, 5, 6, 9, 11, 12, 14, 15]
    assert state[9:] == [1112, *range(106, 116), 1113, 1114, 1115]


@pytest.mark.parametrize(
    ("data", "written"),
    [
        ({"a": float("nan"), "b": [float("inf"), 1.5]}, '{"a":null,"b":[null,1.5]}'),
        ({"a": "\ud800 \u2028 é"}, '{"a":"\\ud800 \\u2028 \\u00e9"}'),
        ({"a": str}, '{"a":"<class \'str\'>"}'),
        ({"a": (1, 2)}, '{"a":[1,2]}'),
    ],
)
def test_records_are_json_that_browsers_read(data: Any, written: str) -> None:
    assert json_text(data) == written


def test_a_very_long_text_is_cut() -> None:
    written = json_text({"kind": "text", "text": "x" * 10_000_000, "short": "y"})
    assert len(written) < LONGEST
    assert json.loads(written)["short"] == "y"
    assert json.loads(written)["text"].endswith("x …")


def test_a_page_that_is_too_slow_again_receives_nothing_old_meanwhile(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 100.0
    monkeypatch.setattr(delivering, "real_time", lambda: now)
    view, delivery = shown()
    for index in range(QUEUED + 1):
        view.text(1.0, "bob", str(index))
    notes = [delivery.take(), delivery.take()]
    assert names([json.loads(str(note)) for note in notes]) == ["missed", "hello"]
    for index in range(QUEUED + 1):  # the records from the beginning still wait
        view.text(2.0, "bob", str(index))
    assert received(delivery) == []
    now += delivering.AGAIN
    again = received(delivery)
    assert names(again)[:2] == ["missed", "hello"]
    assert again[0]["records"] > QUEUED + 1
