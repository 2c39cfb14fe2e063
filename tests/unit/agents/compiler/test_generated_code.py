"""Generated code in tracebacks, profilers and debuggers."""

import cProfile
import pstats
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from jacaros.agents.language.loader import load_program
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated import function
from jacaros.agents.mind.generated.compiler import executed
from jacaros.agents.mind.generated.selection import write_select
from jacaros.agents.mind.state.plan import Plan, label_of
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.unifier import Trail
from jacaros.agents.terms.values import BY_SELF, atom, functor
from jacaros.testing import run_project


class Bare:
    """As little of an agent as a select function needs."""

    def __init__(self) -> None:
        self.trail = Trail()
        self.context = self


def broken(ctx: object, *arguments: object) -> None:
    del ctx, arguments
    raise ZeroDivisionError("on purpose")


def selected(program: str, actions: dict[str, InternalAction] | None = None) -> list[object]:
    tree, _ = load_program("robot.asl", program)
    plans = [Plan(node, label_of(node, i)) for i, node in enumerate(tree.plans)]
    kind = trigger("+", "!", functor("g", 1))
    select = executed(write_select(kind, plans, actions or {}))
    frame = select(Bare(), (kind, 3.0), BY_SELF)
    assert frame is not None
    return frame


def test_a_traceback_shows_file_and_line_of_the_agent_program():
    actions = {".bad": InternalAction(".bad", broken)}
    frame = selected("\n\n+!g(X) <-\n  .bad(X).", actions)
    step = frame[0]
    try:
        step(Bare(), frame)  # type: ignore[operator]
    except ZeroDivisionError as fault:
        places = [(entry.filename, entry.lineno) for entry in traceback.extract_tb(fault.__traceback__)]
    assert ("robot.asl", 4) in places


def test_frames_can_be_read_and_goal_kinds_are_one_object():
    frame = selected("+!g(X) : Y = X + 1 <- .stop(Y, X).", {".stop": InternalAction(".stop", broken)})
    plan = frame[4]
    assert isinstance(plan, Plan)
    assert {name: frame[slot] for name, slot in plan.slots.items()} == {"X": 3.0, "Y": 4.0}
    assert plan.label is atom("p__0")
    assert trigger("+", "!", functor("g", 1)) is trigger("+", "!", functor("g", 1))
    assert trigger("+", "!", functor("g", 1)).on_fail is trigger("-", "!", functor("g", 1))


PROGRAM = """\
!count(3).
+!count(0)
  <- .stopMAS.
+!count(N)
   : N > 0
  <- +left(N);
     !down(N).
+!down(N)
  <- !count(N - 1).
+!never
  <- .print("not reached").
"""


def run_with(folder: Path, begin: Callable[[], None], end: Callable[[], None]) -> str:
    """Run the program under an observer; return its file."""
    file = folder / "robot.asl"
    file.write_text(PROGRAM, encoding="utf-8")
    begin()
    try:
        result = run_project(file)
    finally:
        end()
    assert (result.exit_code, result.errors) == (0, [])
    return str(file)


def test_a_profiler_sees_the_lines_of_the_agent_program(tmp_path):
    profile = cProfile.Profile()
    file = run_with(tmp_path, profile.enable, profile.disable)
    calls = {
        (place[1], place[2].rstrip("0123456789_")): figures[1]
        for place, figures in pstats.Stats(profile).stats.items()  # type: ignore[attr-defined]
        if place[0] == file
    }
    assert calls[6, "step"] == 3
    assert calls[9, "step"] == 3
    assert calls[8, "select"] == 3
    assert not any(line >= 10 for line, _ in calls)


def test_coverage_sees_the_lines_that_have_run(tmp_path):
    """By trace functions, as coverage tools do."""
    seen: set[tuple[str, int]] = set()

    def look(frame: FrameType, event: str, argument: object) -> Any:
        del argument
        if event == "line":
            seen.add((frame.f_code.co_filename, frame.f_lineno))
        return look

    before = sys.gettrace()
    file = run_with(tmp_path, lambda: sys.settrace(look), lambda: sys.settrace(before))
    lines = {line for name, line in seen if name == file}
    assert {3, 5, 6, 7, 9} <= lines
    assert not lines & {10, 11}


def test_steps_of_an_included_plan_carry_their_own_file(tmp_path):
    (tmp_path / "first.asl").write_text(
        '{ include("second.asl") }\n\n+!g(X) : X > 5 <- .print(X).\n', encoding="utf-8"
    )
    (tmp_path / "second.asl").write_text("\n\n\n+!g(1)\n  <- .bad.\n", encoding="utf-8")

    def include(name: str, including: str) -> tuple[str, str]:
        del including
        return name, (tmp_path / name).read_text(encoding="utf-8")

    text = (tmp_path / "first.asl").read_text(encoding="utf-8")
    tree, _ = load_program("first.asl", text, include)
    plans = [Plan(node, label_of(node, i)) for i, node in enumerate(tree.plans)]
    kind = trigger("+", "!", functor("g", 1))
    actions = {".bad": InternalAction(".bad", broken), ".print": InternalAction(".print", broken)}
    select = executed(write_select(kind, plans, actions))
    places = []
    for argument in (1.0, 6.0):
        frame = select(Bare(), (kind, argument), BY_SELF)
        assert frame is not None
        places.append((frame[0].__code__.co_filename, frame[0].__code__.co_firstlineno))
    assert places == [("second.asl", 5), ("first.asl", 3)]


TEXT = """def first(x):
    if x:
        for y in range(3):
            try:
                x = [z * 2 for z in [y]]
            except ValueError: raise
        return inner(lambda: 1 / (x[0] - 4))
    return None
def inner(call):
    return call()
"""
ORIGINS = [0, 900, 900, 7, 7, 100_000, 7, 12, 900, 3, 3, 3]


def test_a_traceback_shows_the_lines_of_the_program():
    names = {}
    exec(function.compile_text(TEXT, ORIGINS, "program.asl"), names)
    with pytest.raises(ZeroDivisionError) as raised:
        names["first"](True)
    places = [(f.filename, f.lineno, f.name) for f in traceback.extract_tb(raised.value.__traceback__)[1:]]
    assert places == [
        ("program.asl", 12, "first"),
        ("program.asl", 3, "inner"),
        ("program.asl", 12, "<lambda>"),
    ]
    assert names["first"].__code__.co_firstlineno == 900
