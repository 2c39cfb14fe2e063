"""The effects of the options of an agent."""

from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project


def run(folder: Path, options: str, program: str, more: str = "") -> RunResult:
    """Run an agent with these options."""
    (folder / "m.mas2j").write_text(f"MAS m {{ agents: a [{options}]; {more} }}", encoding="utf-8")
    (folder / "a.asl").write_text(program, encoding="utf-8")
    (folder / "b.asl").write_text(
        "!go. +!go <- for (.range(I, 1, 5)) { .send(a, tell, n(I)) }.", encoding="utf-8"
    )
    return run_project(folder / "m.mas2j", until_idle=True)


LATE = """!go. +!go <- ++b(1); ++b(2); .wait(5); .add_plan("+b(X) <- .print(b(X))."); .print(added)."""


@pytest.mark.parametrize(
    ("option", "lines"),
    [("requeue", ["added", "b(1)", "b(2)"]), ("discard", ["added"]), ("retrieve", ["added"])],
)
def test_events_without_plan_can_wait_for_one(tmp_path: Path, option: str, lines: list[str]) -> None:
    assert run(tmp_path, f"events={option}", LATE).of("a") == lines


FOCUS = "!go. +!go <- +b; .print(go). +b <- .print(first); .print(second)."


@pytest.mark.parametrize(
    ("option", "lines"),
    [("sameFocus", ["first", "second", "go"]), ("newFocus", ["go", "first", "second"])],
)
def test_belief_events_can_have_intentions_of_their_own(tmp_path: Path, option: str, lines: list[str]):
    assert run(tmp_path, f"intBels={option}", FOCUS).of("a") == lines


def test_messages_can_be_read_less_often(tmp_path: Path) -> None:
    program = (
        """!count(1). +!count(40). +!count(N) <- !count(N + 1). +n(X) <- ?n(X); .count(n(_), C); .print(C)."""
    )
    assert run(tmp_path, "nrcbp=10", program, "b;").of("a") == ["1", "2", "3", "4", "5"]


def test_events_can_be_given_urgency_from_outside(tmp_path: Path) -> None:
    program = """
        !go. +!go <- ++low(1); ++low(2); ++bump; ++low(3); .print(gone).
        +low(I) <- .print(low, I).  +bump <- .print(bump); .print(end).
        +!stop.
    """
    assert run(tmp_path, 'urgency="bump=10, stop=20"', program).of("a") == [
        *("low1", "bump", "end", "low2", "gone", "low3"),
    ]


@pytest.mark.parametrize(
    ("option", "told"),
    [("0", []), ("1", ["info: some", "debug: fine"]), ("2", ["info: some", "debug: fine"])],
)
def test_verbose_logs_more_or_less(tmp_path: Path, option: str, told: list[str]) -> None:
    program = "!go. +!go <- .log(info, some); .log(fine, fine); .print(printed)."
    result = run(tmp_path, f"verbose={option}", program)
    assert result.of("a") == ["printed"]
    assert result.errors == [f"[a] {text}" for text in told]


def test_beliefs_and_goals_come_from_the_project(tmp_path: Path) -> None:
    result = run(tmp_path, 'beliefs="p(1), q(x)", goals="go(2)"', "+!go(N) : p(M) & q(Q) <- .print(N, M, Q).")
    assert result.of("a") == ["21x"]
