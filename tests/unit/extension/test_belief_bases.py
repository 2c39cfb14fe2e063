"""Belief bases of a project, and those that Jason has names for."""

import sys
from pathlib import Path

import pytest
from extension_lab import write

from jacaros.testing import RunResult, run_project

HEAD = "from jacaros import *\n\n"
LOUD = """
class LoudBB(BeliefBase):
    def init(self, *words):
        self.words = words

    def add(self, belief):
        if belief.functor == "bad":
            return False
        self.agent.print("+", str(belief), *map(str, self.words))
        return super().add(belief)

    def remove(self, belief):
        if belief.functor == "fixed":
            return False
        self.agent.print("-", str(belief))
        return super().remove(belief)

    def stop(self):
        self.folder.joinpath("stopped").write_text(str(len(self)))
"""


def run(folder: Path, base: str, program: str, python: str = "") -> RunResult:
    """Run an agent ``bob`` with a belief base."""
    write(
        folder,
        sys_mas2j=f"MAS sys {{ agents: bob beliefBaseClass {base}; }}",
        bob_asl=program,
        my=HEAD + python,
    )
    return run_project(folder / "sys.mas2j", until_idle=True)


def said(folder: Path, base: str, program: str, python: str = "") -> list[str]:
    """Return the output of the agent; nothing may be logged."""
    result = run(folder, base, program, python)
    assert result.errors == []
    return result.of("bob")


def test_a_base_is_asked_about_changes_and_may_refuse_them(tmp_path: Path) -> None:
    program = """
    p(1). fixed(0).
    !go.
    +!go <- +q(a); +q(a); +q(a)[x]; -q(a)[x]; +q(b); -q(b); +bad(1); -fixed(0);
            .findall(X, q(X) | bad(X) | fixed(X), L); .print(L).
    +bad(_) <- .print(never).
    -fixed(_) <- .print(never).
    """
    assert said(tmp_path, "my.LoudBB(1, two)", program, LOUD) == [
        "+fixed(0)[source(self)]1two",
        "+p(1)[source(self)]1two",
        "+q(a)[source(self)]1two",
        "+q(a)[source(self),x]1two",
        "-q(a)[source(self),x]",
        "+q(b)[source(self)]1two",
        "-q(b)[source(self)]",
        "[0]",
    ]
    assert (tmp_path / "stopped").read_text() == "2"


def test_messages_and_percepts_go_through_the_base(tmp_path: Path) -> None:
    write(
        tmp_path,
        sys_jcm="mas sys { agent bob { ag-bb-class: my.LoudBB } agent ann }",
        bob_asl="+p(X)[source(S)] <- .print(event, X, S).",
        ann_asl="!go. +!go <- .send(bob, tell, p(7)); .send(bob, untell, p(7)).",
        my=HEAD + LOUD,
    )
    result = run_project(tmp_path / "sys.jcm", until_idle=True)
    assert result.errors == []
    assert sorted(result.of("bob")) == ["+p(7)[source(ann)]", "-p(7)[source(ann)]", "event7ann"]


def test_an_error_in_a_base_is_logged_and_the_belief_is_kept(tmp_path: Path) -> None:
    python = "class Bad(BeliefBase):\n    def add(self, belief):\n        return belief.nothing\n"
    result = run(tmp_path, "my.Bad", "!go. +!go <- +p(1); ?p(X); .print(X).", python)
    assert result.of("bob") == ["1"]
    assert (
        f"Bad.add: AttributeError: 'Literal' object has no attribute 'nothing' ({tmp_path}/my.py:5)"
        in result.errors[0]
    )


def test_beliefs_can_be_looked_up_when_asked_for(tmp_path: Path) -> None:
    python = """
SQUARES = {n: n * n for n in range(1, 6)}

class Squares(BeliefBase):
    def candidates(self, pattern):
        if pattern.functor == "square":
            known = pattern.arguments[0]
            for n in [known] if isinstance(known, int) else SQUARES:
                if n in SQUARES:
                    yield Literal("square", (n, SQUARES[n]))
"""
    program = """
    square(0, 0). other(1).
    even(N) :- square(N, S) & S mod 2 == 0.
    !go.
    +!go : square(3, X) & other(Y)
      <- .print(X); .findall(N, square(N, _), L); .print(L); .findall(N, even(N), M); .print(M);
         if (square(9, _)) { .print(no) } else { .print(none) };
         for (square(A, 4)) { .print(A) }.
    """
    assert said(tmp_path, "my.Squares", program, python) == ["9", "[0,1,2,3,4,5]", "[0,2,4]", "none", "2"]


COUNT = """
!go.
+!go : count(N) <- -+count(N + 1); +other(N); .print(N).
+!go <- +count(1); .print(first).
"""


def test_beliefs_are_kept_between_two_runs(tmp_path: Path) -> None:
    base = 'jason.bb.TextPersistentBB(count, "note/2")'
    assert [said(tmp_path, base, COUNT) for _ in range(3)] == [["first"], ["1"], ["2"]]
    assert (tmp_path / "bob.bb").read_text() == "count(3)[source(self)].\n"
    assert list(tmp_path.glob(".bob.bb*")) == []


def test_all_beliefs_are_kept_in_the_file_that_is_named(tmp_path: Path) -> None:
    said(
        tmp_path,
        'jason.bb.TextPersistentBB("memory/all.bb")',
        'p(1, "a b", [x|[y]])[about(me)]. ~q. !go. +!go <- +p(2).',
    )
    kept = (tmp_path / "memory" / "all.bb").read_text().splitlines()
    assert sorted(kept) == [
        'p(1,"a b",[x,y])[about(me),source(self)].',
        "p(2)[source(self)].",
        "~q[source(self)].",
    ]
    again = "!go. +!go : p(1, S, [A, B])[about(M)] & ~q <- .print(S, A, B, M). +p(_) <- .print(event)."
    assert said(tmp_path, 'jason.bb.TextPersistentBB("memory/all.bb")', again) == ["a bxyme"]


@pytest.mark.skipif(sys.platform == "win32", reason="files of Windows have no such modes")
def test_the_file_may_be_read_by_those_who_could_read_it_before(tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.touch()
    said(tmp_path, "jason.bb.TextPersistentBB", COUNT)
    kept = tmp_path / "bob.bb"
    assert kept.stat().st_mode == other.stat().st_mode
    kept.chmod(0o640)
    said(tmp_path, "jason.bb.TextPersistentBB", COUNT)
    assert kept.stat().st_mode & 0o777 == 0o640


def test_a_broken_file_is_reported_and_not_changed(tmp_path: Path) -> None:
    (tmp_path / "bob.bb").write_text("count(3\n")
    result = run(tmp_path, "jason.bb.TextPersistentBB", COUNT)
    assert result.exit_code == 1
    assert f"cannot read {tmp_path}/bob.bb: {tmp_path}/bob.bb:1:8" in result.errors[0]
    assert (tmp_path / "bob.bb").read_text() == "count(3\n"


def test_a_key_holds_one_belief(tmp_path: Path) -> None:
    program = """
    student(1, ann).
    !go.
    +!go <- +student(2, bob); +student(1, sue); .findall(s(K, N), student(K, N), L); .print(L);
            -student(1, sue); +student(1, joe); ?student(1, X); .print(X); .count(student(_, _), C); .print(C).
    -student(_, _) : student(1, sue) <- .print(never).
    """
    for argument in ('"student(key,_)"', "student(key,_)"):
        assert said(tmp_path, f"jason.bb.IndexedBB({argument})", program) == [
            "[s(1,sue),s(2,bob)]",
            "joe",
            "2",
        ]


def test_bases_can_be_chained(tmp_path: Path) -> None:
    base = (
        'jason.bb.ChainBB("my.LoudBB(x)", "jason.bb.TextPersistentBB(count)", "jason.bb.IndexedBB(k(key,_))")'
    )
    program = "!go. +!go <- +count(1); +k(1, a); +k(1, b); -count(1); +count(2); .findall(X, k(1, X), L); .print(L)."
    assert said(tmp_path, base, program, LOUD) == [
        "+count(1)[source(self)]x",
        "+k(1,a)[source(self)]x",
        "+k(1,b)[source(self)]x",
        "-count(1)[source(self)]",
        "+count(2)[source(self)]x",
        "[b]",
    ]
    assert (tmp_path / "bob.bb").read_text() == "count(2)[source(self)].\n"
