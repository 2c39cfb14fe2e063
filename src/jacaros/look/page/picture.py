"""A still picture of a run as SVG: the world, the path coloured by time, and docks, rooms and robots at the end.

It suits light and dark pages, needs no other files, and is identical for identical recordings.
"""

import html
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jacaros.look.page.scene import PersonView, SceneState
from jacaros.look.records.recording import Recording
from jacaros.robots.plane.pose import Pose
from jacaros.robots.world.data.ground_truth import RobotState

_STYLE = """
  .floor{fill:#fdfcf9;stroke:#dedbd2} .grid{stroke:#eceae2} .wall{stroke:#3c434b;fill:none} .box{fill:#e6e2d8}
  .room{fill:#77746a;font:500 13px system-ui,sans-serif}
  .name{fill:#23282e;font:600 12px system-ui,sans-serif}
  .area{fill:none;stroke:#d3d0c6;stroke-dasharray:4 4}
  .door{stroke:#b7791f;stroke-width:4} .open{stroke:#b7791f;stroke-width:2;stroke-dasharray:2 6}
  .dock{fill:#f2c14e} .bolt{fill:#7a5b0c} .dirt{fill:#8a6238}
  .person{fill:#8e6bb0} .walk{fill:none;stroke:#8e6bb0;stroke-width:1.5;stroke-dasharray:2 6}
  .robot{fill:#fff;stroke:#1f6f8b} .heading{fill:#1f6f8b}
  @media (prefers-color-scheme: dark) {
    .floor{fill:#1f242a;stroke:#313840} .grid{stroke:#272d34} .wall{stroke:#b9c0c8} .box{fill:#2d343c}
    .area{stroke:#3b434c} .room{fill:#8b95a0} .name{fill:#e7e9ec} .dock{fill:#d9a93a} .bolt{fill:#2b2108}
    .dirt{fill:#b98a58}
    .robot{fill:#1c2026;stroke:#6cc0d8} .heading{fill:#6cc0d8}
  }
"""
_MARGIN = 0.15
_PIECES = 160
_STEPS, _LONGEST = 240, 20.0
"""Number of places of a moving robot, about, and the seconds in which it passes them, at most."""
_RADIUS = 0.17
"""Radius in metres of a robot known only from a real graph."""
_PATH_COLOURS = ("#1f6f8b", "#b4572e", "#6b5aa8", "#3f7d3a", "#a83e6b", "#7a6a1e")


def write_picture(recording: Recording, path: str | Path, width: int = 640) -> None:
    """Write the picture of a run as an SVG file, *width* pixels wide.

    Raises:
        OSError: the file cannot be written.
    """
    Path(path).write_text(picture_svg(recording, width), encoding="utf-8", newline="\n")


def picture_svg(recording: Recording, width: int = 640, moving: bool = False) -> str:
    """Return the SVG text; if *moving*, robots drive along their paths again and again."""
    sheet, state = _Sheet(recording, width), SceneState(recording.drawing)
    for event in recording.events:
        state.event(*event)
    parts = [
        *_floor(sheet, recording.drawing),
        *(sheet.rectangle(room["area"], "area") for room in recording.drawing["rooms"]),
        *_docks(sheet, recording.drawing),
        *_walls(sheet, recording.drawing),
        *_dirt(sheet, recording.drawing, state),
        *_doors(sheet, recording.drawing, state),
        *_paths(sheet, recording),
        *_objects(sheet, recording.drawing, state),
        *_people(sheet, state.people(recording.duration)),
        *_room_names(sheet, recording),
        *_robots(sheet, recording, moving),
    ]
    title = html.escape(str(recording.drawing["name"]))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {sheet.height}" width="{width}" '
        f'height="{sheet.height}" role="img" aria-label="{title}">\n<title>{title}</title>\n'
        f"<style>{_STYLE}</style>\n" + "\n".join(parts) + "\n</svg>\n"
    )


@dataclass(frozen=True, repr=False)
class Picture:
    """A recording as a picture in a notebook, *width* pixels wide: put ``Picture(recording)`` at the end of a cell."""

    recording: Recording
    width: int = 640

    def _repr_svg_(self) -> str:
        return picture_svg(self.recording, self.width)


class _Sheet:
    """Converts metres to pixels; y grows downwards in pixels."""

    def __init__(self, recording: Recording, width: int) -> None:
        left, bottom, right, top = recording.drawing["bounds"]
        for frame in recording.frames:
            for robot in frame.robots:
                left, right = min(left, robot.x - 0.3), max(right, robot.x + 0.3)
                bottom, top = min(bottom, robot.y - 0.3), max(top, robot.y + 0.3)
        self.left: float = left - _MARGIN
        self.top: float = top + _MARGIN
        self.scale: float = width / (right - left + 2 * _MARGIN)
        self.height = round((top - bottom + 2 * _MARGIN) * self.scale)

    def x(self, x: float) -> float:
        return round((x - self.left) * self.scale, 1)

    def y(self, y: float) -> float:
        return round((self.top - y) * self.scale, 1)

    def size(self, metres: float) -> float:
        return round(metres * self.scale, 1)

    def rectangle(self, box: Any, kind: str, more: str = "") -> str:
        ax, ay, bx, by = box
        return (
            f'<rect class="{kind}"{more} x="{self.x(ax)}" y="{self.y(by)}" '
            f'width="{self.size(bx - ax)}" height="{self.size(by - ay)}"/>'
        )


def _floor(sheet: _Sheet, world: dict[str, Any]) -> Iterator[str]:
    left, bottom, right, top = world["bounds"]
    yield sheet.rectangle(world["bounds"], "floor")
    lines = [
        f"M{sheet.x(x)} {sheet.y(bottom)}V{sheet.y(top)}"
        for x in range(math.ceil(left), math.floor(right) + 1)
    ]
    lines += [
        f"M{sheet.x(left)} {sheet.y(y)}H{sheet.x(right)}"
        for y in range(math.ceil(bottom), math.floor(top) + 1)
    ]
    yield f'<path class="grid" d="{"".join(lines)}"/>'


def _dirt(sheet: _Sheet, world: dict[str, Any], state: SceneState) -> Iterator[str]:
    """Draw the remaining dirt at the end; darker means more."""
    for room in world["rooms"]:
        for dirt in room.get("dirt", ()):
            grams = state.dirt[room["name"], dirt["kind"]]
            if grams > 0.0:
                yield sheet.rectangle(dirt["area"], "dirt", f' opacity="{0.3 * grams / dirt["grams"]:.2f}"')


def _docks(sheet: _Sheet, world: dict[str, Any]) -> Iterator[str]:
    for dock in world["docks"]:
        x, y, size = sheet.x(dock["pose"][0]), sheet.y(dock["pose"][1]), sheet.size(dock["radius"])
        yield f'<circle class="dock" opacity=".35" cx="{x}" cy="{y}" r="{size}"/>'
        yield f'<circle class="dock" cx="{x}" cy="{y}" r="{round(size * 0.62, 1)}"/>'
        bolt = "M.1-.42L-.24 .08L-.02 .08L-.1 .42L.24-.08L.02-.08Z"
        yield f'<path class="bolt" transform="translate({x} {y}) scale({size})" d="{bolt}"/>'


def _doors(sheet: _Sheet, world: dict[str, Any], state: SceneState) -> Iterator[str]:
    for door in world["doors"]:
        ax, ay, bx, by = door["segment"]
        line = f"M{sheet.x(ax)} {sheet.y(ay)}L{sheet.x(bx)} {sheet.y(by)}"
        yield f'<path class="{"open" if state.open[door["name"]] else "door"}" d="{line}"/>'


def _objects(sheet: _Sheet, world: dict[str, Any], state: SceneState) -> Iterator[str]:
    """Draw the objects on the floor at the end, without those that robots carry."""
    for each in world["objects"]:
        if each["name"] in state.places:
            x, y = state.places[each["name"]]
            fill, size = html.escape(each["color"] or "#5aa05a"), max(3.0, sheet.size(each["radius"]))
            dot = f'<circle style="fill:{fill}" cx="{sheet.x(x)}" cy="{sheet.y(y)}" r="{size}"/>'
            yield f"<g><title>{html.escape(each['name'])}</title>{dot}</g>"


def _people(sheet: _Sheet, people: Iterable[PersonView]) -> Iterator[str]:
    """Draw the people who are present at the end, with their paths."""
    for person in people:
        line = "L".join(f"{sheet.x(x)} {sheet.y(y)}" for x, y in person.path)
        stroke, fill = (
            f' style="{key}:{html.escape(person.color)}"' if person.color else ""
            for key in ("stroke", "fill")
        )
        x, y, size = sheet.x(person.x), sheet.y(person.y), sheet.size(person.radius)
        yield f'<path class="walk"{stroke} d="M{line}"/>'
        yield f'<circle class="person"{fill} opacity=".8" cx="{x}" cy="{y}" r="{size}"/>'
        name = html.escape(person.name)
        yield f'<text class="name" text-anchor="middle" x="{x}" y="{y - size - 4:.1f}">{name}</text>'


def _walls(sheet: _Sheet, world: dict[str, Any]) -> Iterator[str]:
    yield from (sheet.rectangle(box, "box") for box in world["boxes"])
    for each in world["furniture"]:
        fill = f' style="fill:{html.escape(each["color"])}" opacity=".6"' if each["color"] else ""
        yield f"<g><title>{html.escape(each['kind'])}</title>{sheet.rectangle(each['area'], 'box', fill)}</g>"
    for cliff in world["cliffs"]:
        edge = sheet.rectangle(cliff, "wall", ' stroke-dasharray="3 3"')
        yield f"<g><title>cliff</title>{edge}</g>"
    lines = "".join(
        f"M{sheet.x(ax)} {sheet.y(ay)}L{sheet.x(bx)} {sheet.y(by)}" for ax, ay, bx, by in world["walls"]
    )
    if lines:
        yield f'<path class="wall" stroke-width="4" stroke-linecap="round" d="{lines}"/>'


def _paths(sheet: _Sheet, recording: Recording) -> Iterator[str]:
    robots = recording.rows()
    count, length = len(robots), len(recording.frames)
    step = max(1, math.ceil(length / _PIECES))
    for first in range(0, length - 1, step):
        red, green, blue = colour_at(first / length)
        for number, rows in enumerate(robots):
            points = [(sheet.x(row.x), sheet.y(row.y)) for row in rows[first : first + step + 1]]
            if any(point != points[0] for point in points):
                colour = (
                    f"rgb({red},{green},{blue})" if count == 1 else _PATH_COLOURS[number % len(_PATH_COLOURS)]
                )
                yield (
                    f'<polyline fill="none" stroke="{colour}" stroke-width="3" stroke-linecap="round" '
                    f'stroke-linejoin="round" points="{" ".join(f"{x},{y}" for x, y in _thinned(points))}"/>'
                )


def _thinned(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Remove points equal to the previous one."""
    return [point for index, point in enumerate(points) if index == 0 or point != points[index - 1]]


def _room_names(sheet: _Sheet, recording: Recording) -> Iterator[str]:
    for room in recording.drawing["rooms"]:
        text = str(room["name"]).replace("_", " ")
        x, y = _place_for(sheet, recording, room["area"], 7.2 * len(text))
        yield f'<text class="room" x="{x}" y="{y}">{html.escape(text)}</text>'


def _place_for(sheet: _Sheet, recording: Recording, area: Any, width: float) -> tuple[float, float]:
    """Return the place in a room where a name of that width in pixels covers least furniture, docks and paths."""
    ax, ay, bx, by = area
    left, right = sheet.x(ax) + 12, sheet.x(bx) - 12 - width
    top, bottom = sheet.y(by) + 24, sheet.y(ay) - 12
    boxes = [(sheet.x(a), sheet.y(d), sheet.x(c), sheet.y(b)) for a, b, c, d in recording.drawing["boxes"]]
    boxes += [
        (sheet.x(x - r), sheet.y(y + r), sheet.x(x + r), sheet.y(y - r))
        for (x, y, _), r in ((dock["pose"], dock["radius"]) for dock in recording.drawing["docks"])
    ]
    points = [(sheet.x(row.x), sheet.y(row.y)) for frame in recording.frames[::3] for row in frame.robots]

    def covered(x: float, y: float) -> float:
        x_max, y_min, y_max = x + width + 4, y - 14, y + 6
        cost = sum(50.0 for a, b, c, d in boxes if a < x_max and c > x - 4 and b < y_max and d > y_min)
        return cost + sum(0.1 for px, py in points if x - 4 < px < x_max and y_min < py < y_max)

    places = [(x, y) for y in (top, bottom, (top + bottom) / 2) for x in (left, (left + right) / 2, right)]
    x, y = min(places, key=lambda place: covered(*place))
    return round(x, 1), round(y, 1)


def _robots(sheet: _Sheet, recording: Recording, moving: bool) -> Iterator[str]:
    described = recording.drawing["robots"]
    rows: Sequence[Pose | RobotState] = [Pose(*robot["pose"]) for robot in described if "pose" in robot]
    if recording.frames:
        rows = recording.frames[-1].robots
    for number, (robot, row) in enumerate(zip(described, rows, strict=False)):
        x, y, size = sheet.x(row.x), sheet.y(row.y), sheet.size(robot.get("radius", _RADIUS))
        turn = round(-math.degrees(row.yaw), 1)
        colour = _PATH_COLOURS[number % len(_PATH_COLOURS)]
        edge, inside = (
            (f' style="stroke:{colour}"', f' style="fill:{colour}"') if len(described) > 1 else ("", "")
        )
        motion, kind = "", ""
        if moving and recording.frames:
            motion, kind = _motion(sheet, recording, number, size), f' class="moving-{number}"'
        yield (
            f'{motion}<g{kind} transform="translate({x} {y}) rotate({turn}) scale({size})">'
            f'<circle class="robot" r="1" stroke-width=".12"{edge}/>'
            f'<path class="heading" d="M.72 0L-.38 .5L-.12 0L-.38-.5Z"{inside}/></g>'
        )
        if len(described) > 1:
            name = html.escape(str(robot["name"]))
            yield f'<text class="name" text-anchor="middle" x="{x}" y="{y - size - 8:.1f}">{name}</text>'


def _motion(sheet: _Sheet, recording: Recording, number: int, size: float) -> str:
    """Return the style sheet that moves a robot; those who want no motion see it where it was at the end."""
    rows, times = recording.rows()[number], [frame.t for frame in recording.frames]
    kept = sorted({*range(0, len(rows), max(1, len(rows) // _STEPS)), len(rows) - 1})
    span, turn, last = recording.duration or 1.0, 0.0, rows[0].yaw
    lines = []
    for index in kept:
        row = rows[index]
        turn += math.remainder(row.yaw - last, math.tau)  # the short way round
        last = row.yaw
        degrees = round(-math.degrees(rows[0].yaw + turn), 1)
        place = f"translate({sheet.x(row.x)}px,{sheet.y(row.y)}px) rotate({degrees}deg) scale({size})"
        lines.append(f"{100 * times[index] / span:.2f}%{{transform:{place}}}")
    lines.append(lines[-1].replace(lines[-1].partition("{")[0], "100%", 1))
    name = f"moving-{number}"
    return (
        f"<style>@keyframes {name}{{{''.join(lines)}}} @media (prefers-reduced-motion:no-preference){{"
        f".{name}{{animation:{name} {min(span, _LONGEST):.1f}s linear infinite}}}}</style>"
    )


STOPS = ((74, 98, 190), (38, 146, 158), (120, 172, 84), (226, 160, 48), (205, 84, 60))


def colour_at(part: float) -> tuple[int, int, int]:
    """Return red, green and blue (0 to 255) at *part* (0 to 1) of the path."""
    place = min(0.9999, max(0.0, part)) * (len(STOPS) - 1)
    index = int(place)
    rest = place - index
    red, green, blue = (
        round(a + (b - a) * rest) for a, b in zip(STOPS[index], STOPS[index + 1], strict=True)
    )
    return red, green, blue
