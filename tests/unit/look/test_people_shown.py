"""People in the terminal and on the still picture, extrapolated from their last event."""

import io
from typing import Any

from rich.console import Console

from jacaros.look.page.page import lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import SceneState
from jacaros.look.page.terminal_view import TerminalView
from jacaros.robots.world import World
from jacaros.robots.world.data.ground_truth import JsonRecord

WORLD = """
name: people
size: [6, 6]
robots: [{pose: {x: 2}}]
people:
  - {name: ann, path: [[-2, 2], [2, 2], [2, 1]], color: red, loop: true, pause: 1}
"""


def test_a_person_is_shown_at_its_position() -> None:
    world = World.load(WORLD)
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
    recorder = Recorder()
    recorder.world(World.load(WORLD).description.drawing())
    assert picture_svg(recorder.recording).count('class="person" style="fill:#c0392b"') == 1
    assert picture_svg(recorder.recording).count('class="walk"') == 1
    bob: dict[str, Any] = {"name": "<bob>", "radius": 0.3, "color": "", "path": [[0, 0]], "loop": False}
    recorder.event(1.0, "person_comes", {"person": "<bob>", "x": 0, "y": 0, "robot": "", **bob})
    recorder.event(2.0, "person_goes", {"person": "ann", "x": 0, "y": 0, "robot": ""})
    picture = picture_svg(recorder.recording)
    assert picture.count('class="person"') == 1
    assert ">&lt;bob&gt;</text>" in picture
    assert [person["name"] for person in next(lines_of(recorder.recording)).world["people"]] == ["ann"]


def test_people_are_in_the_terminal() -> None:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=80, height=30), lambda: 0.0)
    view.world(World.load(WORLD).description.drawing())

    def column() -> int:
        return max(row.find("☻") for row in view.map().plain.splitlines())

    before = column()
    view.event(0.0, "person_walks", {"person": "ann", "x": -2.0, "y": 2.0, "vx": 1.0, "vy": 0.0})
    view.frame(2.0, [])
    assert column() > before >= 0
