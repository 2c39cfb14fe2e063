"""Forks: all branches, the first branch, failure and dropping."""

import pytest
from recording_host import printed, programs

PROGRAMS = """
bindings made before a fork are shared and those of branches are not => f(1) | f(1) | b
    !s.
    +!s <- P = f(A); A = 1; (X = a; .print(P)) |&| (X = b; .wait(10); .print(P)); .print(X).
a variable that is free at the fork is bound by each branch for itself => f(1) | f(2)
    !s. +!s <- P = f(A); (A = 1; .print(P)) |&| (A = 2; .print(P)).
a failing branch with a handler of its own does not fail the plan => b | handled | joined
    !s.
    +!s <- !a |&| !b; .print(joined).
    +!a <- .fail.
    -!a <- .print(handled).
    +!b <- .print(b).
when all branches of an or fail the plan fails => ia_failed
    !s. +!s <- .fail ||| .fail; .print(bad). -!s[error(E)] <- .print(E).
a fork inside a loop is made anew each time => a1 | b1 | a2 | b2 | end
    !s. +!s <- for (.range(I, 1, 2)) { .print(a, I) |&| .print(b, I) }; .print(end).
a loop around a fork continues in the surviving branch => a1 | round(1) | a2 | round(2) | a3 | round(3) | end
    !s.
    +!s <- for (.member(X, [1,2,3])) { (.print(a, X) ||| .wait(50)); .print(round(X)) }; .print(end).
a body in curly brackets is a step and a branch => second | first | third | fourth | fifth
    !go.
    +!go
      <- { .wait(200); .print("first") } |&| { .wait(100); .print("second") };
         { .print("third"); { .print("fourth") } };
         X = { .print("never") };
         { .print("fifth") }.
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


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
def test_a_variable_that_a_round_binds_is_free_in_the_next_one(body, expected, plain, monkeypatch):
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    program = f"p(1). p(2). n(2). !s. +!s <- !t(Y). +!t(Y) <- {body}; .print(end, Y)."
    assert [line.split("<")[0] for line in printed(program)] == [*expected, "endY"]


def test_branches_share_the_answers_of_the_loop_around_them(calls_of):
    def work(rounds: int) -> int:
        program = f"!s. +!s <- for (.range(I, 1, {rounds})) {{ X = I |&| Y = I }}; .print(end)."
        return calls_of(lambda: printed(program))

    least = work(1)
    assert work(400) - least < 5 * (work(100) - least)


@pytest.mark.parametrize("operator", ["|&|", "|||"])
def test_a_goal_that_is_ended_while_it_is_forked_ends_once(operator):
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
