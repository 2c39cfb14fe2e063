"""Doors in the terminal and on the still picture: there while they are closed."""

import io

from rich.console import Console

from jacaros.look.page.page import lines_of
from jacaros.look.page.picture import picture_svg
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.terminal_view import TerminalView
from jacaros.robots.world import World

WORLD = """
name: doors
size: [4, 4]
doors:
  - {name: a, segment: [[-1, 1], [1, 1]]}
  - {name: b, segment: [[-1, -1], [1, -1]], open: true}
robots: [{}]
"""


def test_closed_doors_are_in_the_terminal() -> None:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=80, height=30), lambda: 0.0)
    view.world(World.load(WORLD).description.drawing())

    def rows() -> list[int]:
        return [number for number, row in enumerate(view.map().plain.splitlines()) if "▒" in row]

    (upper,) = rows()
    view.event(1.0, "door_opened", {"door": "a"})
    assert rows() == []
    view.event(2.0, "door_closed", {"door": "b"})
    (lower,) = rows()
    assert upper < lower


def test_the_picture_shows_the_doors_as_they_are_at_the_end() -> None:
    recorder = Recorder()
    recorder.world(World.load(WORLD).description.drawing())
    assert picture_svg(recorder.recording).count('class="door"') == 1
    recorder.event(1.0, "door_opened", {"door": "a", "robot": ""})
    assert picture_svg(recorder.recording).count('class="door"') == 0
    assert picture_svg(recorder.recording).count('class="open"') == 2
    recorder.event(2.0, "door_closed", {"door": "a", "robot": ""})
    recorder.event(2.0, "door_closed", {"door": "b", "robot": ""})
    assert picture_svg(recorder.recording).count('class="door"') == 2
    assert [door["name"] for door in next(lines_of(recorder.recording)).world["doors"]] == ["a", "b"]
