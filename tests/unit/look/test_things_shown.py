"""Dirt, furniture, doors, people, objects and cliffs in the terminal, on the still picture and on the replay page."""

import io
import json
import re
from pathlib import Path
from typing import Any

import msgspec
import pytest
from rich.console import Console

import jacaros
from jacaros.look import Recording
from jacaros.look.page.page import lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import SceneState
from jacaros.look.page.terminal_view import TerminalView
from jacaros.look.records.records import EVENTS
from jacaros.robots.world import World
from jacaros.robots.world.data.ground_truth import JsonRecord

DIRT = """
name: dirty
size: [4, 4]
rooms:
  hall: {from: [-2, -2], to: [2, 2], dirt: {dust: 40, stains: {grams: 10, from: [0, 0], to: [1, 1]}}}
robots: [{}]
"""
DOORS = """
name: doors
size: [4, 4]
doors:
  - {name: a, segment: [[-1, 1], [1, 1]]}
  - {name: b, segment: [[-1, -1], [1, -1]], open: true}
robots: [{}]
"""
PEOPLE = """
name: people
size: [6, 6]
robots: [{pose: {x: 2}}]
people:
  - {name: ann, path: [[-2, 2], [2, 2], [2, 1]], color: red, loop: true, pause: 1}
"""
OBJECTS = """
size: [4, 4]
cliffs: [{from: [1, 1], to: [2, 2]}]
objects:
  - {name: cup, x: 1, y: 0, color: red}
  - {name: jug & lid, x: -1, y: 0}
robots: [{gripper: true}]
"""


def drawing(world: str) -> dict[str, Any]:
    return World.load(world).description.drawing()


class Shown(Recorder):
    """A recording of a world, its picture, and the data of its page."""

    def __init__(self, world: str) -> None:
        super().__init__()
        self.world(drawing(world))

    @property
    def picture(self) -> str:
        return picture_svg(self.recording)

    @property
    def data(self) -> dict[str, Any]:
        return next(lines_of(self.recording)).world


def in_the_terminal(world: str) -> TerminalView:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=80, height=30), lambda: 0.0)
    view.world(drawing(world))
    return view


def test_the_picture_shows_the_remaining_dirt() -> None:
    shown = Shown(DIRT)
    assert shown.picture.count('class="dirt" opacity="0.30"') == 2
    left = {"robot": "turtlebot", "room": "hall"}
    shown.event(1.0, "cleaned", {**left, "dirt": "dust", "grams": 20.0, "percent": 50})
    shown.event(2.0, "cleaned", {**left, "dirt": "stains", "grams": 0.0, "percent": 0})
    assert shown.picture.count('class="dirt"') == shown.picture.count('class="dirt" opacity="0.15"') == 1
    (room,) = shown.data["rooms"]
    assert [dirt["kind"] for dirt in room["dirt"]] == ["dust", "stains"]


def test_the_picture_shows_furniture_in_its_colour() -> None:
    box = "{from: [0, 0], to: [1, 1], kind: <table>, color: red}"
    shown = Shown(f"walls:\n  - box: {box}\nrobots: [{{pose: {{x: -1}}}}]")
    picture = shown.picture
    assert '<g><title>&lt;table&gt;</title><rect class="box" style="fill:#c0392b"' in picture
    assert shown.data["furniture"][0]["color"] == "#c0392b"


def test_colours_of_a_recording_are_escaped_in_pictures() -> None:
    recorder = Recorder()
    furniture = [{"kind": "", "color": '"><script>', "area": [0, 0, 1, 1]}]
    recorder.world({"name": "", "bounds": [0, 0, 1, 1], "furniture": furniture})
    assert "<script>" not in picture_svg(recorder.recording)


def test_closed_doors_are_in_the_terminal() -> None:
    view = in_the_terminal(DOORS)

    def rows() -> list[int]:
        return [number for number, row in enumerate(view.map().plain.splitlines()) if "▒" in row]

    (upper,) = rows()
    view.event(1.0, "door_opened", {"door": "a"})
    assert rows() == []
    view.event(2.0, "door_closed", {"door": "b"})
    (lower,) = rows()
    assert upper < lower


def test_the_picture_shows_the_doors_as_they_are_at_the_end() -> None:
    shown = Shown(DOORS)
    assert shown.picture.count('class="door"') == 1
    shown.event(1.0, "door_opened", {"door": "a", "robot": ""})
    assert shown.picture.count('class="door"') == 0
    assert shown.picture.count('class="open"') == 2
    shown.event(2.0, "door_closed", {"door": "a", "robot": ""})
    shown.event(2.0, "door_closed", {"door": "b", "robot": ""})
    assert shown.picture.count('class="door"') == 2
    assert [door["name"] for door in shown.data["doors"]] == ["a", "b"]


def test_a_person_is_shown_at_its_position() -> None:
    world = World.load(PEOPLE)
    seen = SceneState(world.description.drawing())

    def take(record: JsonRecord) -> None:
        if record["kind"] == "event":
            seen.event(record["time"], record["event"], record["data"])

    world.ground_truth.listen(take)
    for _ in range(50):
        world.run(0.5)
        (view,), ann = seen.people(world.time), world.people["ann"]
        assert abs(view.x - ann.x) + abs(view.y - ann.y) < 0.001
    assert view.path[-1] == view.path[0], "a loop is closed"
    world.remove_person("ann")
    assert seen.people(world.time) == []


def test_the_picture_shows_people_with_their_paths() -> None:
    shown = Shown(PEOPLE)
    assert shown.picture.count('class="person" style="fill:#c0392b"') == 1
    assert shown.picture.count('class="walk"') == 1
    bob: dict[str, Any] = {"name": "<bob>", "radius": 0.3, "color": "", "path": [[0, 0]], "loop": False}
    shown.event(1.0, "person_comes", {"person": "<bob>", "x": 0, "y": 0, "robot": "", **bob})
    shown.event(2.0, "person_goes", {"person": "ann", "x": 0, "y": 0, "robot": ""})
    picture = shown.picture
    assert picture.count('class="person"') == 1
    assert ">&lt;bob&gt;</text>" in picture
    assert [person["name"] for person in shown.data["people"]] == ["ann"]


def test_people_are_in_the_terminal() -> None:
    view = in_the_terminal(PEOPLE)

    def column() -> int:
        return max(row.find("☻") for row in view.map().plain.splitlines())

    before = column()
    view.event(0.0, "person_walks", {"person": "ann", "x": -2.0, "y": 2.0, "vx": 1.0, "vy": 0.0})
    view.frame(2.0, [])
    assert column() > before >= 0


def test_the_picture_shows_objects_at_their_final_places() -> None:
    shown = Shown(OBJECTS)
    before = shown.picture
    assert "<title>cup</title>" in before
    assert "<title>jug &amp; lid</title>" in before
    assert "#c0392b" in before, "in its colour"
    shown.event(1.0, "picked", {"robot": "turtlebot", "object": "cup", "x": 1, "y": 0})
    assert "<title>cup</title>" not in shown.picture
    shown.event(2.0, "placed", {"robot": "turtlebot", "object": "cup", "x": 0, "y": 1})
    after = shown.picture
    assert "<title>cup</title>" in after
    assert after != before, "in another place"


def test_cliffs_are_in_the_picture_and_all_of_it_reaches_the_replay_page() -> None:
    shown = Shown(OBJECTS)
    assert "<title>cliff</title>" in shown.picture
    world = shown.data
    assert world["cliffs"] == [[1, 1, 2, 2]]
    assert world["objects"][0] == {"name": "cup", "place": [1, 0], "radius": 0.03, "color": "#c0392b"}


def test_a_robot_that_is_moved_by_hand_is_not_an_object_that_is_put_down() -> None:
    world = World.load(OBJECTS)
    world.place("turtlebot", 0.5, 0.5)
    shown = Shown(OBJECTS)
    for event in world.ground_truth.events:
        shown.event(event.time, event.kind, {"robot": event.robot, **event.data})
    assert [(kind, data["x"]) for _, kind, data in shown.recording.events] == [("robot_placed", 0.5)]
    assert "<title>cup</title>" in shown.picture


def test_an_event_that_lacks_what_its_readers_need_is_skipped_with_a_warning(tmp_path: Path) -> None:
    header = {"kind": "world", "version": 2, "world": drawing(OBJECTS)}
    event = {"kind": "event", "t": 2.5, "event": "picked", "data": {"robot": "turtlebot"}}
    (tmp_path / "run.jsonl").write_text(f"{json.dumps(header)}\n{json.dumps(event)}\n", encoding="utf-8")
    recording = Recording.read(tmp_path / "run.jsonl")
    assert recording.events == []
    assert recording.warnings == [
        "malformed events are skipped: `picked` at 2.5 s: Object missing required field `object`"
    ]


def test_the_page_has_words_only_for_what_an_event_of_the_world_has() -> None:
    script = Path(jacaros.__file__).parent / "look" / "page" / "static" / "happenings.js"
    words = script.read_text(encoding="utf-8").partition("const WORDS = {")[2].partition("\n};")[0]
    parts = re.split(r"(?:^|,)\s+(\w+): \((?:d?)\) =>", words)
    uses = {
        name: set(re.findall(r"\bd\.(\w+)", text))
        for name, text in zip(parts[1::2], parts[2::2], strict=True)
    }
    assert {"placed", "robot_placed", "docked", "fault"} <= uses.keys()
    optional = {"fault": {"why"}}
    for name, used in uses.items():
        known = {each.encode_name for each in msgspec.structs.fields(EVENTS[name])}
        assert used - optional.get(name, set()) <= known, name


@pytest.mark.parametrize("kind", ["picked", "robot_placed"])
def test_an_event_without_its_data_is_not_recorded(kind: str) -> None:
    with pytest.raises(AssertionError):
        World.load(OBJECTS).robot("turtlebot").tell(kind, {"y": 1.0})
