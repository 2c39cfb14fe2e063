"""Dirt on the still picture: as much as is left at the end."""

from jacaros.inspector.picture import picture_svg
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.replay import payload
from jacaros.sim import World

WORLD = """
name: dirty
size: [4, 4]
rooms:
  hall: {from: [-2, -2], to: [2, 2], dirt: {dust: 40, stains: {grams: 10, from: [0, 0], to: [1, 1]}}}
robots: [{}]
"""


def test_the_picture_shows_what_is_left_of_the_dirt() -> None:
    recorder = Recorder()
    recorder.world(World.load(WORLD).description.drawing())
    assert picture_svg(recorder.recording).count('class="dirt" opacity="0.30"') == 2
    left = {"robot": "turtlebot", "room": "hall"}
    recorder.event(1.0, "cleaned", {**left, "dirt": "dust", "grams": 20.0, "percent": 50})
    recorder.event(2.0, "cleaned", {**left, "dirt": "stains", "grams": 0.0, "percent": 0})
    picture = picture_svg(recorder.recording)
    assert picture.count('class="dirt"') == picture.count('class="dirt" opacity="0.15"') == 1
    (room,) = payload(recorder.recording)["world"]["rooms"]
    assert [dirt["kind"] for dirt in room["dirt"]] == ["dust", "stains"]
