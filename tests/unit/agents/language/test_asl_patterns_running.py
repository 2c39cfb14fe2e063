"""What agents with goal patterns do, where the conformance cases say nothing."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions


class ListConsole:
    """Keeps what the agents print."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.logs: list[str] = []

    def print(self, agent: str, text: str) -> None:
        self.lines.append(text)

    def log(self, text: str, level: str = "info") -> None:
        self.logs.append(text)


@pytest.fixture
def printed(tmp_path: Path):
    def run(text: str) -> list[str]:
        path = tmp_path / "agent.asl"
        path.write_text(text, encoding="utf-8")
        console = ListConsole()
        assert launch(path, RunOptions(fast=True), console, own_process=False) == 0
        return console.lines

    return run


def test_an_exclusive_goal_fails_when_all_its_plans_have_been_tried(printed):
    assert printed(
        """
        { begin ebdg(got(_)) }
        +!got(X) <- .print(first(X)); .fail.
        +!got(X) : false <- .print(never).
        +!got(X) <- .print(second(X)); .fail.
        { end }
        !start.
        +!start <- !got(tea); .print(bad).
        -!start[error(E)] <- .count(p__tried(_,_),N); .print(E," ",N); .stopMAS.
        """
    ) == ["first(tea)", "second(tea)", "no_applicable 0"]


def test_an_exclusive_goal_continues_with_the_next_plan(printed):
    assert printed(
        """
        { begin ebdg(got(_)) }
        +!got(X) <- .print(first); .fail.
        +!got(X) <- .print(second); +got(X).
        { end }
        !start.
        +!start <- !got(tea); .count(p__tried(_,_),N); .print(N); .stopMAS.
        """
    ) == ["first", "second", "0"]


def test_single_minded_commitment_fails_when_the_goal_is_impossible(printed):
    assert printed(
        """
        { begin smc(clean, broken) }
        +!clean <- .print(try); .wait(100); .fail.
        { end }
        !start. !breaker.
        +!start <- !clean; .print(bad).
        -!start[error(E)] <- .print(failed(E)); .stopMAS.
        +!breaker <- .wait(250); .print(breaking); +broken.
        """
    ) == ["try", "try", "try", "breaking", "failed(impossible)"]


def test_relativised_commitment_ends_without_its_motivation(printed):
    assert printed(
        """
        wanted.
        { begin rc(clean, wanted) }
        +!clean <- .print(try); .wait(100); .fail.
        { end }
        !start. !loser.
        +!start <- !clean; .print(over); .stopMAS.
        +!loser <- .wait(150); .print(unwanted); -wanted.
        """
    ) == ["try", "try", "unwanted", "over"]


def test_open_minded_commitment_is_also_achieved(printed):
    assert printed(
        """
        wanted.
        { begin omc(at(_), broken, wanted) }
        +!at(X) <- .print(try(X)); .wait(100); +at(X).
        { end }
        !start.
        +!start <- !at(a); .print(over); !!other; .wait(50); -wanted.
        +!other <- !at(b); .print(ended); .stopMAS.
        """
    ) == ["try(a)", "over", "try(b)", "ended"]


def test_sequenced_goals_queue_up_and_a_failing_one_makes_room(printed):
    assert printed(
        """
        { begin sga("+order(X)", "true", serve(X)) }
        { end }
        !start.
        +!start <- ++order(1); ++order(2); ++order(3); .print(placed); .wait(900); ++order(4); .wait(300); .stopMAS.
        +!serve(2) <- .print(fails); .fail.
        +!serve(X) <- .print(begin(X)); .wait(160); .print(end(X)).
        """
    ) == ["begin(1)", "placed", "end(1)", "fails", "begin(3)", "end(3)", "begin(4)", "end(4)"]
