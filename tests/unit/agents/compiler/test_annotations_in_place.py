"""Annotations that are asked for: what is written out in place finds the same as the general search, in the same order."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_host import printed, programs

BELIEFS = """
p(1)[a(1), b(2), source(bob)].
p(2)[source(bob), source(carl), a(f(3))].
p(3)[a(1), a(2), k, "text", 7].
p(4)[source(bob)[source(carl)], a(x)[deep]].
r(X)[a(X), z] :- .member(X, [6, 7]).
"""
RULES = """
p(X) :- X = 5.
p(8)[a(V)].
p(9)[c, a(1), a(X)] :- X = 4 | X = 5.
"""
PATTERNS = [
    "p(X)[source(S)]", "p(X)[a(Y)]", "p(2)[source(S)]", "p(X)[a(1)]", "p(X)[k]", "p(X)[Y]", "p(X)[a(Y), source(S)]",
    "p(X)[source(S), a(f(Y))]", "p(X)[source(bob)]", "p(X)[b(Y), a(X)]", "p(X)[source(S), source(R)]", "p(X)[a(Y)|T]",
    "p(1)[b(2), a(Y)]", "p(X)[nothing(Y)]", "p(X)[a(X)]", "r(X)[a(Y)]", "r(6)[z]", "r(X)[z, a(X)]", "p(X)[7]",
    "p(X)[source(S)[source(R)]]", "p(X)[a(_)]", "p(9)[a(_)]", "q(X)[a(Y)]",
]  # fmt: skip
ANSWER = "t(X, Y, S, R, T)"


@pytest.mark.parametrize("rules", ["", RULES], ids=["facts", "rules"])
@pytest.mark.parametrize("pattern", PATTERNS)
def test_the_same_answers_as_a_formula_that_is_known_only_at_run_time(pattern, rules):
    program = f"""{BELIEFS}{rules}
    !start.
    +!start <-
      .findall({ANSWER}, {pattern}, Written);
      Formula = ({pattern});
      .findall({ANSWER}, Formula, Known);
      .print(Written); .print(Known).
    """
    written, known = printed(program)
    assert written == known


def test_a_variable_that_has_a_value_narrows_the_search():
    assert printed(
        BELIEFS
        + "!start. +!start : p(X)[a(2)] & p(X)[a(Y)] & Y < 2 & p(2)[source(S)] & S \\== bob <- .print(X, Y, S)."
    ) == ["31carl"]


PROGRAMS = """
bindings are undone between two matches => carl
    m[source(bob), source(carl)]. !g(Z). +!g(Z) : m[source(Z)] & Z == carl <- .print(Z). +!g(Z) <- .print(none).
only the first match counts in a trigger => secondbob
    // One unifier for each plan: when its context fails, the next plan has its turn.
    !start.
    +!start <- +p(1)[source(bob), source(carl)].
    +p(X)[source(S)] : S == carl <- .print(first, S).
    +p(X)[source(S)] <- .print(second, S).
several annotations of a trigger are found together => both2 | 1self | plain
    !start.
    +!start <- +p(1)[a(1), a(2), b(2)]; !g[x(1)]; !g[y].
    +p(X)[b(B), a(B)] <- .print(both, B).
    +!g[x(A), source(S)] <- .print(A, S).
    +!g[source(self)] <- .print(plain).
the reason of a failure is an annotation of its event => 7
    !g. +!g <- .fail(why(7)). -!g[why(X), error(_)] <- .print(X).
annotations of new beliefs are sorted as those of formulae
=> [a(2),source(bob),z] | [a,b,source(self)] | [a(1),a(2),source(self)] | [a(3),c,source,source(self)]
    !start(2).
    +!start(N) <-
      +p[z, a(N), source(bob)]; +p(1)[c, source, a(N + 1)]; +p(2)[a(N), a(1)]; +p(3)[b, a];
      for (p[|T]) { .print(T) }; for (p(_)[|T]) { .print(T) }.
beliefs may change while a loop goes through those with an annotation => 1 | 2 | 3
    p(1)[a(1)]. p(2)[a(2)]. p(3)[a(3)]. !s. +!s <- for (p(X)[a(Y)]) { -p(X); +p(X + 10)[a(Y)]; .print(X) }.
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


NAMES = st.sampled_from(["a(1)", "a(2)", "b(1)", "b(c)", "k", "source(bob)", "source(carl)", "a(f(1))"])
ASKED = st.sampled_from(["a(Y)", "b(Y)", "k", "source(Y)", "a(1)", "b(Z)", "a(f(Z))", "source(bob)", "X2"])


@settings(max_examples=60)
@given(
    st.lists(st.lists(NAMES, min_size=1, max_size=4), min_size=1, max_size=3),
    st.lists(ASKED, min_size=1, max_size=3, unique=True),
)
def test_whatever_is_asked_the_answers_are_those_of_the_general_search(beliefs, asked):
    facts = " ".join(f"p({i})[{', '.join(annotations)}]." for i, annotations in enumerate(beliefs))
    question = f"p(X)[{', '.join(asked)}]"
    program = f"""{facts}
    !start.
    +!start <-
      .findall(t(X, Y, Z, X2), {question}, A); F = ({question}); .findall(t(X, Y, Z, X2), F, B);
      .print(A); .print(B).
    """
    written, known = printed(program)
    assert written == known
