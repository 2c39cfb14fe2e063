"""The loop for plain agents (`execute_plainly`) and the one for all others (`execute`) do the same."""

import sys
from pathlib import Path
from random import Random

import pytest

from jacaros.bdi.fast.generated import conditions
from jacaros.bdi.rules import cycle
from jacaros.testing import run_project

sys.path.insert(0, str(Path(__file__).parents[3] / "tools"))

from running_programs import Writer

CASES = Path(__file__).parents[2] / "conformance"
PROGRAMS = sorted(
    path
    for area in (
        "body_statements",
        "concurrency",
        "failure",
        "intentions",
        "patterns",
        "plan_selection",
        "programs",
    )
    for pattern in ("*.asl", "*/*.mas2j")
    for path in (CASES / area).glob(pattern)
)


def test_there_are_programs():
    assert len(PROGRAMS) > 50


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_program_prints_the_same_in_both_loops(program, monkeypatch):
    plainly = run_project(program, seconds=120)
    monkeypatch.setattr(cycle, "is_plain", lambda agent: False)
    in_general = run_project(program, seconds=120)

    assert in_general.lines == plainly.lines
    assert in_general.errors == plainly.errors
    assert in_general.exit_code == plainly.exit_code


def test_both_loops_make_the_same_cycles(monkeypatch, tmp_path):
    program = tmp_path / "count.asl"
    program.write_text(
        "!s. +!s <- !g(20); !h; .print(done); .stopMAS. +!g(0). +!g(N) : N > 0 <- +b(N); !g(N-1). "
        "+b(N) <- -b(N). +!h <- !i; .print(never). +!i <- .fail. -!h."
    )

    def cycles():
        minds = []
        run_project(program, when_started=lambda mas: minds.extend(host.mind for host in mas.directory))
        return minds[0].cycles

    plainly = cycles()
    monkeypatch.setattr(cycle, "is_plain", lambda agent: False)
    assert cycles() == plainly


def test_random_programs_do_the_same_in_both_loops_and_with_searched_contexts(monkeypatch, tmp_path):
    differing = []
    for seed in range(12):
        for name, text in Writer(Random(seed)).files().items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        results = []
        for path in ("plain", "general", "searched"):
            with monkeypatch.context() as patch:
                if path == "general":
                    patch.setattr(cycle, "is_plain", lambda agent: False)
                elif path == "searched":
                    patch.setattr(conditions, "_MAX_LOOPS", 0)
                result = run_project(tmp_path / "random.jcm", seconds=30, until_idle=True)
            results.append((result.lines, result.errors, result.exit_code))
        if results.count(results[0]) < len(results):
            differing.append(seed)
    assert differing == []
