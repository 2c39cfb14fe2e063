"""The rules of the language as they are written (``JACAROS_PLAIN=1``) and what is there for speed do the same."""

import os
import subprocess
import sys
from pathlib import Path
from random import Random

import pytest
from recording_host import printed

from jacaros.agents.mind.generated import conditions
from jacaros.agents.mind.generated.compiler import Compiler
from jacaros.agents.mind.rules.add_im import Interpreter
from jacaros.testing import run_project

sys.path.insert(0, str(Path(__file__).parents[4] / "tools"))

from running_programs import Writer

CASES = Path(__file__).parents[3] / "conformance"
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
def test_a_program_prints_the_same_plain_and_fast(program):
    fast = run_project(program, seconds=120, plain=False)
    plain = run_project(program, seconds=120, plain=True)

    assert plain.lines == fast.lines
    assert plain.errors == fast.errors
    assert plain.exit_code == fast.exit_code


@pytest.mark.parametrize("plain", ["0", "1"])
@pytest.mark.parametrize(
    ("loop", "shown"),
    [
        ("for (.member(M, [1, 2])) { A = M; .print(T) }", ["f(1,B)", "f(2,B)"]),
        ("while (k(N) & N < 2) { B = N; -+k(N+1); .print(T) }", ["f(A,0)", "f(A,1)"]),
        ("for (.member(B, [1, 2])) { .print(T) }", ["f(A,1)", "f(A,2)"]),
        ("for (r(A)) { .print(T) }", ["f(1,B)", "f(2,B)"]),
        ("for (r(A)) { B = A; .print(T) }", ["f(1,1)", "f(2,2)"]),
        ("G = r(B); for (G) { A = B; .print(T) }", ["f(1,1)", "f(2,2)"]),
    ],
)
def test_loops_unbind_variables_inside_terms(plain, loop, shown, monkeypatch):
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    assert printed(f"k(0). p(1). p(2). r(X) :- p(X). !s. +!s <- T = f(A, B); {loop}; .print(T).") == [
        *shown,
        "f(A,B)",
    ]


@pytest.mark.parametrize("plain", ["0", "1"])
@pytest.mark.parametrize(
    "condition", ["p(X)", "r(X)", "q(X)", "p(X)[source(self)]", "p(X) & true", "F", "r(X) & not X = 9"]
)
def test_a_loop_skips_beliefs_that_are_deleted_before_their_turn(plain, condition, monkeypatch):
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    assert printed(
        f"""
        p(1). p(2). p(3). p(4). p(5). q(1). q(2). q(3). q(4). q(5). q(X) :- X = 9. r(X) :- p(X).
        !s. +!s <- {"F = p(X); " * (condition == "F")} for ({condition}) {{ .print(X); -p(X+2); -q(X+2) }}.
        """
    ) == ["1", "2", "4", "5", *(["9"] if condition == "q(X)" else [])]


def test_an_intention_shows_the_same_variables_plain_and_fast(monkeypatch):
    program = (
        "!s. +!s <- .findall(H, .desire(H), L); .intention(_, _, [im(_, _, _, B)], current); .print(B, L)."
    )
    fast = printed(program)
    monkeypatch.setenv("JACAROS_PLAIN", "1")
    assert printed(program) == fast == ["[map('L',[s[source(self)]])][s[source(self)]]"]


def test_a_plain_run_does_not_import_the_fast_paths():
    script = (
        "import sys; from jacaros.testing import run_project; "
        f"print(run_project({str(PROGRAMS[0])!r}, seconds=120).exit_code, "
        "[name for name in sys.modules if name.startswith('jacaros.agents.mind.fast')])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=os.environ | {"JACAROS_PLAIN": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == "0 []"


def test_plain_and_fast_runs_make_the_same_cycles(tmp_path):
    program = tmp_path / "count.asl"
    program.write_text(
        "!s. !t. +!s <- !g(20); !k; !h; .print(done); .stopMAS. +!g(0). +!g(N) : N > 0 <- +b(N); !g(N-1). "
        "@k[atomic] +!k <- +c(1); !l; -+c(2). +!l <- +c(3); +b(30). +!t <- !g(30). "
        "+b(N) <- -b(N). +!h <- !i; .print(never). +!i <- .fail. -!h."
    )

    def cycles(engine, **options):
        minds = []
        run_project(
            program, when_started=lambda mas: minds.extend(host.mind for host in mas.directory), **options
        )
        assert isinstance(minds[0].engine, engine)
        return minds[0].counts.cycles

    assert cycles(Interpreter, plain=True) == cycles(Compiler, plain=False)


@pytest.mark.parametrize("plain", ["0", "1"])
def test_a_variable_with_annotations_finds_every_belief_that_has_them(monkeypatch, plain):
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    program = "p(1)[a]. q(2)[a,b]. p(3). !s. +!s <- .findall(X, X[a], L); .findall(Y, Y[b], M); .print(L, M)."
    assert printed(program) == ["[p(1),q(2)][q(2)]"]


def test_random_programs_do_the_same_plain_and_fast_and_with_searched_contexts(monkeypatch, tmp_path):
    differing = []
    for seed in range(12):
        for name, text in Writer(Random(seed)).files().items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        results = []
        for path in ("fast", "plain", "searched"):
            with monkeypatch.context() as patch:
                if path == "searched":
                    patch.setattr(conditions, "_MAX_LOOPS", 0)
                project = tmp_path / "random.jcm"
                result = run_project(project, seconds=30, until_idle=True, plain=path == "plain")
            results.append((result.lines, result.errors, result.exit_code))
        assert results[0][0], "a program that prints nothing"
        assert results[0][2] == 0, results[0][1]
        if results.count(results[0]) < len(results):
            differing.append(seed)
    assert differing == []
