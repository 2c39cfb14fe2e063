"""Variables of plans: where they get their values, and when they give them back."""

import pytest
from recording_host import mind, printed, programs

from jacaros.agents.mind.rules import query

PROGRAMS = """
a failed goal unbinds its variables for the handler and the caller => unbound | free free_too
    !s.
    +!s <- !g(X, f(Y)); X = free; Y = free_too; .print(X, " ", Y).
    +!g(A, f(B)) <- A = 1; B = 2; .fail.
    -!g(A, f(B)) <- if (A == 1 | B == 2) { .print(bound) } else { .print(unbound) }.
a variable bound on one branch only is free on the other => one | free | one
    !s.
    +!s <- for (.member(X, [1,2,1])) { if (X == 1) { Y = one }; if (Y = other) { .print(free) } else { .print(Y) } }.
variables inside a negation or a collection stay free => 356[1,2]7
    !g. p(1). p(2).
    +!g <- ?(not q(Z)); Z = 3; .findall(X, p(X), [1,2]); X = 5; ?(true & .findall(Y, p(Y), L)); Y = 6; .count(p(W), 2);
      W = 7; .print(Z, X, Y, L, W).
a negated variable stands for negated literals only => p(3) | [p(1)[source(self)]] | p(5) | no
    !g. ~p(1). p(2).
    +!g <- Y = ~p(3); ~Z = Y; .print(Z); .findall(W, ~W, L); .print(L);
      if (~V = p(3)) { .print(bad) }; !h(~p(5)); !h(p(5)).
    +!h(~X) <- .print(X).
    -!h(_) <- .print(no).
bindings of an event wait outlive the search for its plan => 1 | k
    !g. !k.
    +!g <- .wait({+b(X)}); .print(X).
    +!k <- .wait(5); +b(1); .print(k).
    +b(X) : X > 5 <- .print(no).
    +b(X) : X > 4 <- .print(no).
the first free variable is unbound between the rounds of a loop
=> 1 | 2 | X<no-value> | X<no-value> | 0 | 1 | Y<no-value> | Y<no-value>
    !t. c(0).
    +!t <- !h(X); .print(X); !k(Y); .print(Y).
    +!h(X) <- for (.range(I,1,2)) { .print(I); X = I }; .print(X).
    +!k(X) <- while (c(N) & N < 2) { -+c(N+1); X = N; .print(X) }; .print(X).
annotations of a rule head have the values of the answer => [1,2] | 1[k(1),source(self)]
    !g. p(1). p(2). hd(X)[k(X)] :- p(X). +!g <- .findall(K,hd(_)[k(K)],L); .print(L); ?hd(Y)[|R]; .print(Y, R).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_bindings_made_before_a_goal_outlive_its_failure():
    assert (
        printed(
            """
        !s.
        +!s <- P = pair(A, B); A = 1; !g(P); .print(P); B = 3; .print(P).
        +!g(pair(_, Y)) <- Y = 2; .fail.
        -!g(_).
        """
        )[1]
        == "pair(1,3)"
    )
    assert (
        printed("!g. +!g <- ++b(X); .print(a); .print(c); X = 7; .print(X). +b(Y) <- Y = 3; .print(b(Y)).")[
            -1
        ]
        == "7"
    )
    lines = printed("!g. a::p(1). b::p(3). p(4). +!g <- for (N::p(X)) { .print(N, X) }.")
    assert sorted(lines) == ["a1", "b3", "default4"]


def test_bindings_of_loops_and_failed_bodies_end_with_them():
    assert printed("!g. +!g <- for (.member(Z,[W,[3]])) { .print(Z,W); W = f(b) }.")[1] == "[3]W<no-value>"
    assert printed("!g. p(1). +!g <- for (p(Z)) { Y = Z }; if (p(2)) { Y = 3 }; .print(Y).") == [
        "Y<no-value>"
    ]
    assert printed("!g. p(1). +!g <- if (p(2)) { Y = 2 } else { for (p(Z)) { Y = Z } }; .print(Y).") == [
        "Y<no-value>"
    ]
    assert printed("!g. +!g <- for (.member(X,[1,2])) { if (X == 1) { Y = one }; .print(Y) }.") == [
        "one",
        "Y<no-value>",
    ]
    assert printed(
        """
        !s.
        +!s <- P = pair(A, B); for (.member(X, [1,2])) { A = X; .print(P) }; A = 9; B = 8; .print(P).
        """
    )[0::2] == ["pair(1,B)", "pair(9,8)"]
    assert printed("!g. +!g <- B = {.fail}; B. -!g[error(E)] <- .print(E).") == ["ia_failed"]
    assert printed("!g. s(1). +!g <- B = {for (s(X)) {.print(X)}}; B; .print(X).") == ["1", "X<no-value>"]


@pytest.mark.parametrize(
    "bounds", ["1, 4", "4, 1", "4, 1, -2", "1.9, 4.9", "1, 3, 0", "1, a", "U, 3", "X, 3"]
)
def test_range_answers_alike_whether_its_variable_is_new_or_known_to_be_free(bounds):
    """A variable that the search meets for the first time is given its values without unification."""
    new = mind(f"!s. +!s <- .findall(X, .range(X, {bounds}), L); .print(L).")
    known = mind(f"!s. +!s <- P = f(X); .findall(X, .range(X, {bounds}), L); .print(L).")
    for host in (new, known):
        host.run()
    assert new.printed == known.printed
    assert new.logged == known.logged


def test_a_round_of_a_loop_over_numbers_takes_few_calls(calls_of):
    def work(rounds: int) -> int:
        return calls_of(lambda: printed(f"!s. +!s <- for (.range(I, 1, {rounds})) {{ Y = I }}; .print(end)."))

    assert (work(300) - work(100)) / 200 < 5


@pytest.mark.parametrize(
    "term",
    [
        "p(1, [b])",
        "a",
        "~q(2)",
        "n::r(3)",
        "n::~s",
        "p(4)[x, y]",
        "_",
        "[1]",
        "[]",
        "5",
        '"s"',
        "{+!g(1) : c <- d}",
    ],
)
@pytest.mark.parametrize("parts", ["[F, A, N]", "[S, F, A, N]", "[_, F, A, _]", "[F, F, N]"])
def test_deconstruction_treats_new_and_bound_variables_alike(term, parts):
    def shown(test: str) -> list[str]:
        return printed(f"!go. +!go <- T = {term}; {test}; .print(F, A, N). -!go <- .print(no).")

    assert shown(f"T =.. {parts}") == shown(f"L = {parts}; T =.. L")
    if "S" in parts:
        assert shown(f"T =.. {parts}") == shown(f"T =.. L; L = {parts}")


@pytest.mark.parametrize(
    "parts",
    [
        "[p, [1, Y], [x]]",
        "[n, p, [], []]",
        "[default, ~p, [1], []]",
        "[default, p, Y, Y]",
        "[Y, [], []]",
        "[p, []]",
        "[p, [X], []]",
    ],
)
def test_construction_treats_new_and_unbound_variables_alike(parts):
    def shown(before: str) -> list[str]:
        return printed(f"!go. +!go <- {before} X =.. {parts}; Y = 2; .print(X). -!go <- .print(no).")

    assert shown("") == shown("L = [X];")


def test_terms_and_texts_are_taken_apart_with_their_present_values(monkeypatch):
    assert printed(
        """
        !go. +!go <- !g(1); !g(2).
        +!g(X)
          <- .term2string(T, "f(X,a,[1])"); .print(T);
             .term2string(U, "h(_,_)"); U = h(X, V); V = 5; .print(U);
             .term2string(C, "c([1,b],\\"s\\")"); .print(C);
             .term2string(S, "1 + 2"); .print(S).
        """
    ) == [*("f(1,a,[1])", "h(1,5)", 'c([1,b],"s")', "3"), *("f(2,a,[1])", "h(2,5)", 'c([1,b],"s")', "3")]
    monkeypatch.setattr(query, "unify", None)
    program = (
        "!go(p(1, a)). +!go(T) <- T =.. [F, A, N]; M =.. [q, A, [F]]; M =.. [_, G, _, O]; .print(G, A, N, O)."
    )
    assert printed(program) == ["q[1,a][][p]"]
