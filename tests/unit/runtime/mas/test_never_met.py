"""At its end, a run reports events and waits that only a similar belief would meet."""

from pathlib import Path

import pytest

from jacaros.testing import run_project

CAME_BEFORE = (
    "`.wait({ +at(_) })` has not ended (a.asl:2): `at(_)` was added before; wait for the condition: "
    "`.wait(at(_))`"
)


def told(folder: Path, program: str) -> list[str]:
    path = folder / "a.asl"
    path.write_text(program, encoding="utf-8")
    errors = run_project(path, seconds=1).errors
    marks = ("has not happened", "has not ended")
    return [line.replace(f"{folder}/", "") for line in errors if any(mark in line for mark in marks)]


@pytest.mark.parametrize(
    ("program", "line"),
    [
        (
            "!go. +!go <- +mode(go).\n+mdoe(go) <- .print(a).",
            "`+mdoe(go)` has not happened (a.asl:2): the belief is `mode(go)`",
        ),
        (
            "!go. +!go <- +at(1, 2).\n+at(x, y) <- .print(a).",
            "`+at(x,y)` has not happened (a.asl:2): the belief is `at(1,2)`: a number, not an atom",
        ),
        ("at(1). !go.\n+!go <- .wait({+at(_)}).", CAME_BEFORE),
        (
            "battery(1). !go.\n+!go <- .wait(batery(_)).",
            "`.wait(batery(_))` has not ended (a.asl:2): no belief `batery`; did you mean `battery`?",
        ),
    ],
)
def test_a_similar_belief_is_named(tmp_path: Path, program: str, line: str) -> None:
    assert told(tmp_path, program) == [f"[a] warning: {line}"]


@pytest.mark.parametrize(
    "program",
    [
        "!go. +!go <- +mode(go). +mdoe(go). +mode(X) <- .print(X).",
        "!go. +!go <- +at(1, 2). +at(X). +at(X, Y) <- .print(X).",
        "!go. +!go <- +mode(go). +mode(stop) <- .print(a).",
        "door_open(1). +door_opened(X) <- .print(X).",
        "at(1). !go. +!go <- .wait(at(2)).",
        "!go. +!go <- .wait(done(_)).",
    ],
    ids=[
        "another plan takes it",
        "another plan takes that number of arguments",
        "another value",
        "another word",
        "a wait for another value",
        "a wait for what may come",
    ],
)
def test_what_may_still_come_is_not_reported(tmp_path: Path, program: str) -> None:
    assert told(tmp_path, program) == []
