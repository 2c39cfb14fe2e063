"""Forks: all branches, the first branch, failure and dropping."""

from collections.abc import Callable

import pytest
from recording_host import printed


def test_bindings_made_before_a_fork_are_shared_and_those_of_branches_are_not() -> None:
    assert printed(
        """
        !s.
        +!s <- P = f(A); A = 1; (X = a; .print(P)) |&| (X = b; .wait(10); .print(P)); .print(X).
        """
    ) == ["f(1)", "f(1)", "b"]


def test_a_variable_that_is_free_at_the_fork_is_bound_by_each_branch_for_itself() -> None:
    assert printed("!s. +!s <- P = f(A); (A = 1; .print(P)) |&| (A = 2; .print(P)).") == ["f(1)", "f(2)"]


def test_a_failing_branch_with_a_handler_of_its_own_does_not_fail_the_plan() -> None:
    assert printed(
        """
        !s.
        +!s <- !a |&| !b; .print(joined).
        +!a <- .fail.
        -!a <- .print(handled).
        +!b <- .print(b).
        """
    ) == ["b", "handled", "joined"]


def test_when_all_branches_of_an_or_fail_the_plan_fails() -> None:
    assert printed("!s. +!s <- .fail ||| .fail; .print(bad). -!s[error(E)] <- .print(E).") == ["ia_failed"]


def test_a_fork_inside_a_loop_is_made_anew_each_time() -> None:
    assert printed("!s. +!s <- for (.range(I, 1, 2)) { .print(a, I) |&| .print(b, I) }; .print(end).") == [
        "a1",
        "b1",
        "a2",
        "b2",
        "end",
    ]


def test_a_loop_around_a_fork_continues_in_the_surviving_branch() -> None:
    assert printed(
        """
        !s.
        +!s <- for (.member(X, [1,2,3])) { (.print(a, X) ||| .wait(50)); .print(round(X)) }; .print(end).
        """
    ) == ["a1", "round(1)", "a2", "round(2)", "a3", "round(3)", "end"]


@pytest.mark.parametrize("plain", ["", "1"])
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("for (p(X)) { Y = X; .print(Y) }", ["1", "2"]),
        ("for (p(X)) { { .wait(9); Y = X } |&| { .print(b) }; .print(Y) }", ["b", "1", "b", "2"]),
        ("for (p(X)) { Y = X; { .print(Y) } |&| { .print(b) } }", ["1", "b", "2", "b"]),
        ("Z = f(Y); for (p(X)) { { Y = X; .print(Z) } ||| { .wait(50) } }", ["f(1)", "f(2)"]),
        ("while (n(N) & N > 0) { { Y = N; .print(Y) } |&| { .print(b) }; -+n(N - 1) }", ["b", "2", "b", "1"]),
    ],
)
def test_a_variable_that_a_round_binds_is_free_in_the_next_one(
    body: str, expected: list[str], plain: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    program = f"p(1). p(2). n(2). !s. +!s <- !t(Y). +!t(Y) <- {body}; .print(end, Y)."
    assert [line.split("<")[0] for line in printed(program)] == [*expected, "endY"]


def test_a_body_in_curly_brackets_is_a_step_and_a_branch() -> None:
    program = """
!go.
+!go
  <- { .wait(200); .print("first") } |&| { .wait(100); .print("second") };
     { .print("third"); { .print("fourth") } };
     X = { .print("never") };
     { .print("fifth") }.
"""
    assert printed(program) == ["second", "first", "third", "fourth", "fifth"]


def test_branches_share_the_answers_of_the_loop_around_them(
    calls_of: Callable[[Callable[[], object]], int],
) -> None:
    def work(rounds: int) -> int:
        program = f"!s. +!s <- for (.range(I, 1, {rounds})) {{ X = I |&| Y = I }}; .print(end)."
        return calls_of(lambda: printed(program))

    least = work(1)
    assert work(400) - least < 5 * (work(100) - least)


@pytest.mark.parametrize("operator", ["|&|", "|||"])
def test_a_goal_that_is_ended_while_it_is_forked_ends_once(operator: str) -> None:
    program = """
        !m. !k.
        +!m <- !a; .print(once).
        +!a <- !b OPERATOR !c OPERATOR { !d |&| !b }; .print(never).
        -!a <- .print(failed).
        +!b <- .wait(100); .print(never).
        +!c <- .wait(100); .print(never).
        +!d <- .wait(50); .print(never).
        +!k <- .wait(10); .END(a).
        """.replace("OPERATOR", operator)
    assert printed(program.replace("END", "succeed_goal")) == ["once"]
    assert printed(program.replace("END", "fail_goal")) == ["failed", "once"]
    assert printed(program.replace("+!a <-", "+!a <: done <-").replace(".END(a)", "+done")) == ["once"]
