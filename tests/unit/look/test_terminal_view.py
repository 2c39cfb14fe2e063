"""The terminal view: its pictures, their rate, and its output without a terminal."""

import io
import os
import sys
import threading
from typing import Any

import pytest
from rich.console import Console

from jacaros.look.page.scene import RobotView
from jacaros.look.page.terminal_view import BrailleMap, IntentionBars, TerminalView, character
from jacaros.robots.world import World


class Wall:
    """A wall clock that stands still unless it is moved."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


RUNS = f"{'=':>20}"


def view_of(world: str = "house", terminal: bool = True) -> tuple[TerminalView, Wall, Any, Console]:
    out = io.StringIO()
    console = Console(file=out, force_terminal=terminal, width=80, height=36)
    wall = Wall()
    view = TerminalView(console, wall)
    view.world(World.load(world).description.drawing())
    return view, wall, out, console


def robot(x: float = 0.0, y: float = 0.0, yaw: float = 0.0, **more: Any) -> RobotView:
    return RobotView("turtlebot", x, y, yaw, 61.0, **more)


def rendered(view: TerminalView) -> str:
    console = Console(record=True, width=80, height=36, file=io.StringIO())
    console.print(view.picture())
    return console.export_text()


def test_a_braille_map_sets_the_dots_of_a_line() -> None:
    shown = BrailleMap((0.0, 0.0, 3.0, 3.0), 2, 1)
    shown.line(0.0, 3.0, 3.0, 3.0)
    assert character(shown.bits(0, 0)) == "⠉"


def test_dots_outside_the_map_are_skipped() -> None:
    shown = BrailleMap((0.0, 0.0, 1.0, 1.0), 4, 2)
    shown.line(-9.0, -9.0, 9.0, 9.0)
    shown.point(50.0, 50.0)
    cells = {(column, row) for column in range(shown.columns) for row in range(shown.rows)}
    assert {cell for cell in shown._cells if shown._cells[cell]} <= cells


def test_the_view_shows_walls_robot_battery_goals_and_prints() -> None:
    view, _, _, _ = view_of()
    view.event(0.0, "goal", {"agent": "cleaner", "goal": "patrol", "state": "suspended"})
    view.event(0.0, "goal", {"agent": "cleaner", "goal": "recharge", "state": "pursued"})
    view.event(0.0, "goal", {"agent": "cleaner", "goal": "recharge", "state": "achieved"})
    view.text(0.0, "cleaner", "mop the [floor]")
    view.frame(83.4, [robot(yaw=1.57, charging=True)])
    text = rendered(view)
    assert "house  1:23.4" in text
    assert "⡇" in text
    assert "↑" in text
    assert "◎" in text
    assert "████████████░░░░░░░░  61 % charging" in text
    assert "pursuing patrol (suspended)" in text
    assert "recharge" not in text
    assert "[cleaner] mop the [floor]" in text


@pytest.mark.parametrize(("yaw", "arrow"), [(0.0, "→"), (0.8, "↗"), (3.14, "←"), (-3.14, "←"), (-1.6, "↓")])
def test_the_arrow_has_the_robots_heading(yaw: float, arrow: str) -> None:
    view, _, _, _ = view_of()
    view.frame(0.0, [robot(yaw=yaw)])
    assert arrow in rendered(view)


def test_a_fast_run_is_drawn_at_most_ten_times_per_second_of_real_time() -> None:
    view, wall, out, _ = view_of()
    pictures = 0
    for step in range(1000):
        before = len(out.getvalue())
        wall.now += 0.001
        view.frame(step * 0.1, [robot(x=step * 0.002)])
        pictures += len(out.getvalue()) > before
    assert 9 <= pictures <= 10
    view.close()


def test_the_speed_of_the_run_is_shown() -> None:
    view, wall, _, _ = view_of()
    wall.now += 1.0
    view.frame(200.0, [robot()])
    assert "×200" in rendered(view)
    view.close()


def test_without_a_terminal_nothing_is_drawn() -> None:
    view, wall, out, _ = view_of(terminal=False)
    wall.now += 1.0
    view.frame(10.0, [robot(x=1.0)])
    view.close()
    assert (out.getvalue(), view.takes_prints) == ("", False)


def test_without_a_world_goals_and_output_are_shown() -> None:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=80), Wall())
    view.event(0.0, "goal", {"agent": "a", "goal": "!go", "state": "pursued"})
    view.text(0.0, "a", "on the way")
    view.frame(1.0, [])
    view.close()
    assert rendered(view).splitlines()[1:] == [f"{RUNS} pursuing !go", "[a] on the way"]


def test_each_intention_has_a_row_with_its_current_step_first() -> None:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=40), Wall())

    def tell(agent: str, number: int, goal: str, intention: int, state: str = "pursued") -> None:
        told = {"agent": agent, "goal": goal, "state": state, "id": number, "intention": intention}
        view.event(0.0, "goal", told)

    tell("b", 1, "!keep_charged", 3)
    tell("a", 2, "!patrol([north,east,south,west],100)", 1)
    tell("a", 3, "!watch_over(storehouse,by_night)", 2)
    tell("a", 4, "!visit(north)", 1)
    tell("a", 4, "!visit(north)", 1, "suspended")
    tell("a", 5, "!visit(east)", 1)
    tell("a", 5, "!visit(east)", 1, "achieved")
    for number in range(6, 10):
        tell("b", number, f"!wait({number})", number)
    view.frame(1.0, [])
    view.close()
    assert rendered(view).splitlines()[1:] == [
        f"{RUNS} a pursues !visit(north) (suspended) for !patrol([north,eas…",
        f"{RUNS} a pursues !watch_over(storehouse,by_night)",
        f"{RUNS} b pursues !wait(9)",
        f"{RUNS} b pursues !wait(8)",
        f"{RUNS} b pursues !wait(7)",
        f"{RUNS} b pursues !wait(6)",
        f"{'':20} b pursues 1 more",
    ]


def test_a_bar_shows_the_last_minute_of_an_intention() -> None:
    view = TerminalView(Console(file=io.StringIO(), force_terminal=True, width=40), Wall())

    def tell(t: float, kind: str, state: str, number: int, **more: str) -> None:
        view.event(t, kind, {"agent": "a", "id": number, "intention": number, "state": state, **more})

    for number in (1, 2):
        tell(0.0, "goal", "pursued", number, goal=f"!go({number})")
        tell(12.0, "intention", "waits", number)
    tell(42.0, "intention", "suspended", 1)
    tell(45.0, "goal", "failed", 2, goal="!go(2)", why="blocked")
    tell(45.0, "intention", "over", 2)
    view.frame(60.0, [])
    assert rendered(view).splitlines()[1:] == [
        "===----------....... pursuing !go(1)",
        "===-----------x      a failed !go(2)",
    ]
    view.frame(106.0, [])
    assert rendered(view).splitlines()[1:] == [f"{'.' * 20} pursuing !go(1)"]


def test_ended_intentions_are_forgotten() -> None:
    bars = IntentionBars()
    for number in range(5000):
        bars.take(number, "goal", {"agent": "a", "intention": number, "state": "pursued"})
    assert len(bars._changes) < 300


def test_each_robot_has_a_gauge() -> None:
    view, _, _, _ = view_of("two_robots")
    view.frame(
        0.0, [RobotView("robot_0", -1, -1, 0, 20), RobotView("robot_1", 1, 1, 3.14, 80, touching=True)]
    )
    text = rendered(view)
    assert "robot_0 ████░" in text
    assert "80 % touching" in text


def test_closing_leaves_the_last_picture_and_is_idempotent() -> None:
    view, wall, out, _ = view_of()
    wall.now += 1.0
    view.frame(1.0, [robot()])
    view.close()
    view.close()
    assert out.getvalue().count("turtlebot") >= 2


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_a_blocked_terminal_does_not_stop_agents(monkeypatch: pytest.MonkeyPatch) -> None:
    reader, terminal = os.openpty()
    wall = Wall()
    with open(terminal, "w", encoding="utf-8") as stream:
        monkeypatch.setattr(sys, "stderr", stream)
        view = TerminalView(wall=wall)

        def run() -> None:
            view.world(World.load("house").description.drawing())
            for number in range(200):  # far more than a terminal holds
                wall.now += 1.0
                view.frame(float(number), [robot(x=0.01 * number)])
                view.text(float(number), "guard", "a line " * 40)

        agents = threading.Thread(target=run, daemon=True)
        agents.start()
        agents.join(20.0)
        stopped = agents.is_alive()
        os.close(reader)
    assert not stopped
