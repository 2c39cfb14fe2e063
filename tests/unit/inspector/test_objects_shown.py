"""Objects and cliffs on the still picture and in the data of the replay page."""

from jacaros.inspector.page import records
from jacaros.inspector.picture import picture_svg
from jacaros.inspector.recorder import Recorder
from jacaros.sim import World

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
    world = next(records(recorder.recording))["world"]
    assert world["cliffs"] == [[1, 1, 2, 2]]
    assert world["objects"][0] == {"name": "cup", "place": [1, 0], "radius": 0.03, "color": "#c0392b"}
