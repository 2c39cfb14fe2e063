"""A live view of a run in the terminal: a map of braille dots with the robots, batteries, goals and output.

It is drawn on standard error, at most ten times per second of real time and for at most a tenth of the time, so that it
does not slow a virtual run, which may simulate hundreds of seconds between two pictures. Without a terminal, nothing is
drawn.
"""

import math
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, TextIO, cast

from rich.console import Console, Group
from rich.live import Live
from rich.text import Text

from jacaros.look.page.scene import UNKNOWN, RobotView, SceneState
from jacaros.look.page.terminal_console import TerminalConsole
from jacaros.runtime.output import Output, Wrapped

FRAME_PERIOD = 0.1
"""Seconds of real time between two pictures."""
_ARROWS = "→↗↑↖←↙↓↘"
_COLOURS = ("cyan", "magenta", "green", "yellow", "blue", "red")
_PRINTS = 5
_DOOR = ("▒", "bold yellow")
_OPEN = ("pursued", "resumed", "suspended")
_INTENTIONS = 4
"""Maximum number of intentions shown for one agent."""


# ---- a map of braille dots: two by four dots per character cell

_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_EMPTY = 0x2800


class BrailleMap:
    """A part of the plane on character cells, as large as possible.

    Attributes:
        columns, rows: character cells in use.

    Args:
        bounds: left, bottom, right, top in metres.
        columns, rows: available character cells.
    """

    def __init__(self, bounds: Iterable[float], columns: int, rows: int) -> None:
        self._left, bottom, right, self._top = bounds
        width, height = max(0.1, right - self._left), max(0.1, self._top - bottom)
        # One dot stays free at each edge, so that the border is visible.
        self._scale = min((columns * 2 - 2) / width, (rows * 4 - 2) / height)
        self.columns = min(columns, int(width * self._scale) // 2 + 1)
        self.rows = min(rows, int(height * self._scale) // 4 + 1)
        self._cells: dict[tuple[int, int], int] = {}

    def dot_of(self, x: float, y: float) -> tuple[int, int]:
        """Return column and row of the dot for a point (metres); it may be outside."""
        return round((x - self._left) * self._scale), round((self._top - y) * self._scale)

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return column and row of the character cell for a point; it may be outside."""
        column, row = self.dot_of(x, y)
        return column // 2, row // 4

    def cells_between(self, ax: float, ay: float, bx: float, by: float) -> set[tuple[int, int]]:
        """Return the character cells of a straight line."""
        return {(column // 2, row // 4) for column, row in self._dots_between(ax, ay, bx, by)}

    def point(self, x: float, y: float) -> None:
        """Set the dot for a point."""
        self._set(*self.dot_of(x, y))

    def line(self, ax: float, ay: float, bx: float, by: float) -> None:
        """Set the dots of a straight line."""
        for column, row in self._dots_between(ax, ay, bx, by):
            self._set(column, row)

    def _dots_between(self, ax: float, ay: float, bx: float, by: float) -> Iterator[tuple[int, int]]:
        (first_column, first_row), (last_column, last_row) = self.dot_of(ax, ay), self.dot_of(bx, by)
        across, down = last_column - first_column, last_row - first_row
        steps = max(abs(across), abs(down), 1)
        for step in range(steps + 1):
            yield first_column + round(across * step / steps), first_row + round(down * step / steps)

    def _set(self, column: int, row: int) -> None:
        if 0 <= column < self.columns * 2 and 0 <= row < self.rows * 4:
            cell = (column // 2, row // 4)
            self._cells[cell] = self._cells.get(cell, 0) | _DOTS[row % 4][column % 2]

    def bits(self, column: int, row: int) -> int:
        """Return the dots of a character cell, 0 for none."""
        return self._cells.get((column, row), 0)


def character(bits: int) -> str:
    """Return the braille character with these dots; a blank for none."""
    return chr(_EMPTY | bits) if bits else " "


# ---- bars of the last minute

_MINUTE, _CELLS = 60.0, 20
"""Seconds that a bar shows, and its characters."""
_CHARACTERS = {"runs": "=", "pursued": "=", "resumed": "=", "waits": "-", "suspended": ".", "failed": "x"}
_LEGEND = "  = runs  - waits  . suspended  x failed"


class IntentionBars:
    """What each intention did in the last minute, the newest at the right end."""

    def __init__(self) -> None:
        self._changes: dict[tuple[str, object], deque[tuple[float, str]]] = {}
        self._lost: dict[tuple[str, object], tuple[float, str]] = {}
        self._limit = 100

    def take(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Take the record of a goal or an intention."""
        key = str(data.get("agent", "")), data.get("id" if kind == "intention" else "intention")
        state = str(data.get("state", ""))
        if state == "failed":
            self._lost[key] = (
                t,
                str(data.get("goal", "")),
            )  # of those that fail together, the lowest comes last
        if state in _CHARACTERS or state == "over":
            changes = self._changes.setdefault(key, deque(maxlen=200))
            changes.append((t, _CHARACTERS.get(state, " ")))
        if len(self._changes) > self._limit:
            self._forget(t)

    def bar(self, key: tuple[str, object], t: float) -> str:
        """Return the last minute of an intention."""
        cells, ends = [], [t - _MINUTE * (1 - (n + 1) / _CELLS) for n in range(_CELLS)]
        for end in ends:
            known = [each for each in self._changes.get(key, ()) if each[0] <= end]
            failed = any(sign == "x" and at > end - _MINUTE / _CELLS for at, sign in known)
            cells.append("x" if failed else known[-1][1].replace("x", " ") if known else " ")
        return "".join(cells)

    def lost(self, t: float) -> Iterator[tuple[tuple[str, object], str]]:
        """Yield the intentions that failed in the last minute, with their goals."""
        yield from ((key, goal) for key, (at, goal) in self._lost.items() if t - at <= _MINUTE)

    def _forget(self, t: float) -> None:
        """Forget failures of more than a minute ago, and intentions that ran last then: they have ended."""
        self._lost = {key: each for key, each in self._lost.items() if t - each[0] <= _MINUTE}
        self._changes = {
            key: each
            for key, each in self._changes.items()
            if each[-1][1] in "-." or t - each[-1][0] <= _MINUTE
        }
        self._limit = 2 * len(self._changes) + 100


# ---- the view


class Screen(Wrapped):
    """A terminal as a file for Rich.  Drawing never waits for it: a blocked terminal must not stop agents.

    Args:
        stream: standard error, or another stream.
    """

    def __init__(self, stream: TextIO) -> None:
        super().__init__(stream)
        self._output = Output(stream, "the terminal", raw=True)

    @property
    def lagging(self) -> bool:
        """Whether the terminal has not accepted the last picture yet."""
        return self._output.waiting

    def write(self, text: str) -> int:
        """Write *text*, or queue the part that the terminal does not accept now."""
        self._output.write(text)
        return len(text)

    def end(self) -> None:
        """Write the queue, as long as the terminal accepts it."""
        self._output.close()


class TerminalView:
    """Shows a run; receives records like a recorder, see `jacaros.look.page.watch.Watcher`.

    Args:
        console: where to draw; by default *stream*, without waiting for a reader.
        wall: returns seconds of real time.
        stream: terminal; standard error by default.
    """

    def __init__(
        self,
        console: Console | None = None,
        wall: Callable[[], float] = time.monotonic,
        stream: TextIO | None = None,
    ) -> None:
        self._screen = Screen(stream or sys.stderr) if console is None else None
        self._drawing: Mapping[str, Any] = {}
        self._state = SceneState({})
        self._console = console if console is not None else TerminalConsole(file=cast(TextIO, self._screen))
        self._wall = wall
        self._live: Live | None = None
        self._walls: BrailleMap | None = None
        self._trail: BrailleMap | None = None
        self._size = (0, 0)
        self._t = 0.0
        self._robots: Sequence[RobotView] = ()
        self._goals: dict[tuple[str, object], tuple[str, object]] = {}
        """Open goals by agent and id: the text shown, and the intention."""
        self._bars = IntentionBars()
        self._prints: deque[tuple[str, str]] = deque(maxlen=_PRINTS)
        self._drawn_at = wall()
        self._drawn_t = 0.0
        self._factor = 0.0
        self._cost = 0.0

    @property
    def takes_prints(self) -> bool:
        """Whether the output of agents must go through `text`, because stdout is the terminal drawn on."""
        return self._console.is_terminal and sys.stdout.isatty()

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Show the world; when it changes to another one, the path so far is lost."""
        self._drawing = drawing
        self._state = SceneState(drawing)
        self._size = (0, 0)

    def frame(self, t: float, robots: Sequence[RobotView]) -> None:
        """Show the robots at a time; most calls draw nothing."""
        self._t, self._robots = t, robots
        if self._trail is not None:
            for robot in robots:
                self._trail.point(robot.x, robot.y)
        passed = self._wall() - self._drawn_at
        if passed >= max(FRAME_PERIOD, min(0.5, 10.0 * self._cost)):
            self._measure_speed(passed)
            if self._screen is None or not self._screen.lagging:
                self._draw()
            self._cost = self._wall() - self._drawn_at

    def text(self, t: float, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        self._prints.append((agent, text))
        if self.takes_prints:
            # Above the picture, where it scrolls like any output.
            self._console.print(Text(f"[{agent}] {text}"), soft_wrap=True)

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Process an event; goals, doors and people are shown."""
        self._state.event(t, kind, data)
        if kind in ("goal", "intention"):
            self._bars.take(t, kind, data)
        if kind != "goal":
            return
        goal, state = str(data.get("goal", "")), str(data.get("state", ""))
        key = (str(data.get("agent", "")), data.get("id", goal))
        if state not in _OPEN:
            self._goals.pop(key, None)
            return
        if state == "pursued":
            self._goals.pop(key, None)
        self._goals[key] = (goal + (" (suspended)" if state == "suspended" else ""), data.get("intention"))

    def close(self) -> None:
        """Draw the final state and release the terminal; closing twice is harmless."""
        if self._live is not None:
            self._draw()
            self._live.stop()
            self._live = None
        if self._screen is not None:
            self._screen.end()

    def _measure_speed(self, passed: float) -> None:
        now = (self._t - self._drawn_t) / passed
        self._factor = now if self._factor == 0.0 else 0.7 * self._factor + 0.3 * now
        self._drawn_at, self._drawn_t = self._wall(), self._t

    def _draw(self) -> None:
        if not self._console.is_terminal:
            return
        if self._live is None:
            self._live = Live(
                console=self._console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False
            )
            self._live.start()
        self._live.update(self.picture(), refresh=True)

    def picture(self) -> Group:
        """Return the whole view."""
        head = Text(f"{self._drawing.get('name', '')}  ", style="bold")
        head.append(
            f"{_minutes(self._t)}  ×{self._factor:.0f}{_LEGEND if self._goals else ''}", style="not bold dim"
        )
        # Without a known world, goals and output are still useful.
        rows = [head, self.map()] if self._drawing else [head]
        rows += [self._gauge(robot, i) for i, robot in enumerate(self._robots)]
        rows += [Text(row, style="dim", no_wrap=True, overflow="ellipsis") for row in self._pursued()]
        for agent, text in self._prints:
            rows.append(Text.assemble((f"[{agent}] ", "cyan"), text, no_wrap=True, overflow="ellipsis"))
        return Group(*rows)

    def _pursued(self) -> list[str]:
        """Return a row for each intention of each agent, its bar first, because rows are cut at the terminal's edge."""
        agents: dict[str, dict[object, list[str]]] = {}
        for (agent, _), (goal, intention) in self._goals.items():
            stacks = agents.setdefault(agent, {})
            stack = stacks.pop(intention, [])
            stacks[intention] = [goal, *stack]  # the intention that ran last is the last one
        rows = []
        for agent, stacks in sorted(agents.items()):
            who = "pursuing" if len(agents) == 1 else f"{agent} pursues"
            for intention in [*reversed(stacks)][:_INTENTIONS]:
                bar = self._bars.bar((agent, intention), self._t)
                rows.append(f"{bar} {who} {' for '.join(stacks[intention])}")
            if len(stacks) > _INTENTIONS:
                rows.append(f"{'':{_CELLS}} {who} {len(stacks) - _INTENTIONS} more")
        for (agent, intention), goal in self._bars.lost(self._t):
            if intention not in agents.get(agent, {}):
                rows.append(f"{self._bars.bar((agent, intention), self._t)} {agent} failed {goal}")
        return rows

    def map(self) -> Text:
        """Return the map alone, with docks, closed doors and robots."""
        self._fit()
        assert self._walls is not None
        assert self._trail is not None
        marks = self._marks(self._walls)
        cells: list[tuple[str, str]] = []
        for row in range(self._walls.rows):
            for column in range(self._walls.columns):
                wall = self._walls.bits(column, row)
                bits = wall | self._trail.bits(column, row)
                plain = (character(bits), "white" if wall else "blue" if bits else "")
                cells.append(marks.get((column, row), plain))
            cells.append(("\n", ""))
        runs = groupby(cells[:-1], key=lambda cell: cell[1])
        return Text.assemble(
            *(("".join(char for char, _ in run), style) for style, run in runs), no_wrap=True
        )

    def _fit(self) -> None:
        """Recreate the maps when the terminal size changes; the path so far is lost."""
        size = (self._console.width, self._console.height)
        if self._size == size:
            return
        self._size = size
        robots = max(1, len(self._drawing["robots"]))
        rows = max(6, min(32, size[1] - 2 * robots - _PRINTS - 3))
        bounds, columns = self._drawing["bounds"], max(20, size[0] - 2)
        self._walls, self._trail = BrailleMap(bounds, columns, rows), BrailleMap(bounds, columns, rows)
        for wall in self._drawing["walls"]:
            self._walls.line(*wall)

    def _marks(self, shown: BrailleMap) -> dict[tuple[int, int], tuple[str, str]]:
        """Return the characters shown instead of dots: closed doors, docks, people, and robots over them."""
        marks = {}
        for door in self._drawing.get("doors", ()):
            if not self._state.open[door["name"]]:
                marks.update(dict.fromkeys(shown.cells_between(*door["segment"]), _DOOR))
        for dock in self._drawing["docks"]:
            marks[shown.cell_of(dock["pose"][0], dock["pose"][1])] = ("◎", "bold yellow")
        for person in self._state.people(self._t):
            marks[shown.cell_of(person.x, person.y)] = ("☻", "bold white")
        for index, robot in enumerate(self._robots):
            arrow = _ARROWS[round(robot.yaw / (math.pi / 4)) % 8]
            colour = "red" if robot.touching else _COLOURS[index % len(_COLOURS)]
            marks[shown.cell_of(robot.x, robot.y)] = (arrow, f"bold {colour}")
        return marks

    def _gauge(self, robot: RobotView, index: int) -> Text:
        full = round(max(0.0, robot.battery) / 5)
        colour = "green" if robot.battery > 50 else "yellow" if robot.battery > 20 else "red"
        text = Text(no_wrap=True, overflow="ellipsis")
        text.append(f"{robot.name} ", style=f"bold {_COLOURS[index % len(_COLOURS)]}")
        if robot.battery != UNKNOWN:
            text.append("█" * full, style=colour)
            text.append("░" * (20 - full), style="dim")
            text.append(f" {robot.battery:3.0f} %")
        text.append(" charging" if robot.charging else "", style="green")
        text.append(" touching" if robot.touching else "", style="red")
        text.append(f"  ({robot.x:.2f}, {robot.y:.2f})", style="dim")
        return text


def _minutes(t: float) -> str:
    return f"{int(t // 60)}:{t % 60:04.1f}"
