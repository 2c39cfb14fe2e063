"""Dirt and furniture on the still picture: the remaining dirt at the end, and furniture in its colour."""

from jacaros.look.page.page import lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.robots.world import World

WORLD = """
name: dirty
size: [4, 4]
rooms:
  hall: {from: [-2, -2], to: [2, 2], dirt: {dust: 40, stains: {grams: 10, from: [0, 0], to: [1, 1]}}}
robots: [{}]
"""


def test_the_picture_shows_the_remaining_dirt() -> None:
    recorder = Recorder()
    recorder.world(World.load(WORLD).description.drawing())
    assert picture_svg(recorder.recording).count('class="dirt" opacity="0.30"') == 2
    left = {"robot": "turtlebot", "room": "hall"}
    recorder.event(1.0, "cleaned", {**left, "dirt": "dust", "grams": 20.0, "percent": 50})
    recorder.event(2.0, "cleaned", {**left, "dirt": "stains", "grams": 0.0, "percent": 0})
    picture = picture_svg(recorder.recording)
    assert picture.count('class="dirt"') == picture.count('class="dirt" opacity="0.15"') == 1
    (room,) = next(lines_of(recorder.recording)).world["rooms"]
    assert [dirt["kind"] for dirt in room["dirt"]] == ["dust", "stains"]


def test_the_picture_shows_furniture_in_its_colour() -> None:
    recorder = Recorder()
    box = "{from: [0, 0], to: [1, 1], kind: <table>, color: red}"
    recorder.world(World.load(f"walls:\n  - box: {box}\nrobots: [{{pose: {{x: -1}}}}]").description.drawing())
    picture = picture_svg(recorder.recording)
    assert '<g><title>&lt;table&gt;</title><rect class="box" style="fill:#c0392b"' in picture
    assert next(lines_of(recorder.recording)).world["furniture"][0]["color"] == "#c0392b"


def test_colours_of_a_recording_are_escaped_in_pictures() -> None:
    recorder = Recorder()
    furniture = [{"kind": "", "color": '"><script>', "area": [0, 0, 1, 1]}]
    recorder.world({"name": "", "bounds": [0, 0, 1, 1], "furniture": furniture})
    assert "<script>" not in picture_svg(recorder.recording)
