"""Objects and cliffs on the still picture and in the data of the replay page."""

import json
import re
from pathlib import Path

import msgspec
import pytest

import jacaros
from jacaros.look import Recording
from jacaros.look.page.page import lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.look.records.records import EVENTS
from jacaros.robots.world import GroundTruth, World

WORLD = """
size: [4, 4]
cliffs: [{from: [1, 1], to: [2, 2]}]
objects:
  - {name: cup, x: 1, y: 0, color: red}
  - {name: jug & lid, x: -1, y: 0}
robots: [{gripper: true}]
"""


def recorded() -> Recorder:
    recorder = Recorder()
    recorder.world(World.load(WORLD).description.drawing())
    return recorder


def test_the_picture_shows_objects_at_their_final_places() -> None:
    recorder = recorded()
    before = picture_svg(recorder.recording)
    assert "<title>cup</title>" in before
    assert "<title>jug &amp; lid</title>" in before
    assert "#c0392b" in before, "in its colour"
    recorder.event(1.0, "picked", {"robot": "turtlebot", "object": "cup", "x": 1, "y": 0})
    assert "<title>cup</title>" not in picture_svg(recorder.recording)
    recorder.event(2.0, "placed", {"robot": "turtlebot", "object": "cup", "x": 0, "y": 1})
    after = picture_svg(recorder.recording)
    assert "<title>cup</title>" in after
    assert after != before, "in another place"


def test_cliffs_are_in_the_picture_and_all_of_it_reaches_the_replay_page() -> None:
    recorder = recorded()
    assert "<title>cliff</title>" in picture_svg(recorder.recording)
    world = next(lines_of(recorder.recording)).world
    assert world["cliffs"] == [[1, 1, 2, 2]]
    assert world["objects"][0] == {"name": "cup", "place": [1, 0], "radius": 0.03, "color": "#c0392b"}


def test_a_robot_that_is_moved_by_hand_is_not_an_object_that_is_put_down() -> None:
    world = World.load(WORLD)
    world.place("turtlebot", 0.5, 0.5)
    recorder = recorded()
    for event in world.ground_truth.events:
        recorder.event(event.time, event.kind, {"robot": event.robot, **event.data})
    recording = recorder.recording
    assert [(kind, data["x"]) for _, kind, data in recording.events] == [("robot_placed", 0.5)]
    assert "<title>cup</title>" in picture_svg(recording)


def test_older_recordings_in_which_both_had_one_name_are_read(tmp_path: Path) -> None:
    moved = {"robot": "turtlebot", "x": 0.5, "y": 0.5, "yaw": 0.0}
    put_down = {"robot": "turtlebot", "object": "cup", "x": 0.0, "y": 1.0}
    header = {"kind": "world", "version": 1, "world": World.load(WORLD).description.drawing()}
    events = [
        {"kind": "event", "t": t, "event": "placed", "data": data} for t, data in ((1, moved), (2, put_down))
    ]
    path = tmp_path / "run.jsonl"
    path.write_text("".join(json.dumps(each) + "\n" for each in (header, *events)), encoding="utf-8")
    recording = Recording.read(path)
    assert [kind for _, kind, _ in recording.events] == ["robot_placed", "placed"]
    assert recording.warnings == []
    assert "<title>cup</title>" in picture_svg(recording)
    truth = tmp_path / "truth.jsonl"
    place = {"time": 1.0, "robot": "turtlebot", "x": 0.5, "y": 0.5, "yaw": 0.0}
    of_truth = {"kind": "event", "event": "placed", **place, "data": {"x": 0.5, "y": 0.5, "yaw": 0.0}}
    bare = {**of_truth, "event": "docked", "data": {}}
    lines = "".join(json.dumps(each) + "\n" for each in (header, of_truth, bare))
    truth.write_text(lines, encoding="utf-8")
    assert [event.kind for event in GroundTruth.read(truth).events] == ["robot_placed", "docked"]


def test_an_event_that_lacks_what_its_readers_need_is_skipped_with_a_warning(tmp_path: Path) -> None:
    header = {"kind": "world", "version": 1, "world": World.load(WORLD).description.drawing()}
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
        World.load(WORLD).robot("turtlebot").tell(kind, {"y": 1.0})
