"""Operations without a value, and the table of plans."""

import pytest
from recording_host import printed

from jacaros.agents.mind.generated import compiler
from jacaros.testing import run_project

HANDLER = '+!start : true <- !g; .print(end); .stopMAS. -!g[error(E), error_msg(M)] <- .print(E, " ", M).'
FAULT = "arithmetic_error integer division by zero"


@pytest.mark.parametrize(
    ("plans", "told"),
    [
        ("+!g : X = f(3 div 0) <- .print(X).", "no_applicable no applicable plan for !g"),
        ("+!g : X = [3 div 0] <- .print(X). +!g <- .print(second).", "second"),
        ("+!g : r(X) <- .print(X). r(X) :- X = f(3 div 0).", "no_applicable no applicable plan for !g"),
        ("+!g <- X = f(3 div 0); .print(X).", FAULT),
        ("+!g <- !h(f(3 div 0)). +!h(X) <- .print(X).", FAULT),
        ("+!g <- +b[w(3 div 0)]; .print(b).", FAULT),
        ("+!g <- for (X = [3 div 0]) { .print(X) }.", FAULT),
    ],
)
def test_only_that_step_or_context_fails(plans, told, tmp_path):
    program = tmp_path / "division.asl"
    program.write_text(f"!start. {HANDLER}\n{plans}")

    result = run_project(program, seconds=10)

    assert result.of("division") == [told, "end"]
    assert not any(" dropped: " in line or " skipped: " in line for line in result.errors)


PLANS = """
+!do(a, X) : X > 10 <- .print(a_large, X).
+!do(V, 3) <- .print(three, V).
+!do(b, X) <- .print(b, X).
+!do("s", X) <- .print(string, X).
+!do(1, X) <- .print(number, X).
+!do(f(Y), X) <- .print(f, Y, X).
+!do([], X) <- .print(empty, X).
+!do([H | T], X) <- .print(list, H, X).
+!do(a, X) <- .print(a, X).
+!do(~a, X) <- .print(not_a, X).
+!do(other::a, X) <- .print(other_a, X).
+!do(c[mark], X) <- .print(marked, X).
@any +!do(W, X) <- .print(any, W, X).
+!do(a, X) <- .print(never).
"""
GOALS = {
    "do(a, 11)": "a_large11",
    "do(a, 3)": "threea",
    "do(a, 1)": "a1",
    "do(b, 3)": "threeb",
    "do(b, 4)": "b4",
    'do("s", 1)': "string1",
    'do("t", 1)': "anyt1",
    "do(1, 1)": "number1",
    "do(2 - 1, 1)": "number1",
    "do(f(7), 1)": "f71",
    "do(f(7, 8), 1)": "anyf(7,8)1",
    "do([], 1)": "empty1",
    "do([x, y], 1)": "listx1",
    "do(~a, 1)": "not_a1",
    "do(other::a, 1)": "other_a1",
    "do(zzz, 1)": "anyzzz1",
    "do(a[note], 1)": "a1",
    "do(c[mark], 1)": "marked1",
    "do(c, 1)": "anyc1",
}


@pytest.mark.parametrize("limit", [1, 6, 1000])
@pytest.mark.parametrize("goal", GOALS)
def test_the_first_applicable_plan_is_the_same_with_and_without_a_table(goal, limit, monkeypatch):
    monkeypatch.setattr(compiler, "_WORTH_A_TABLE", limit)
    assert printed(f"!start. +!start <- !{goal}. {PLANS}") == [GOALS[goal]]


@pytest.mark.parametrize("limit", [1, 1000])
def test_an_argument_without_value_takes_that_of_the_first_plan(limit, monkeypatch):
    monkeypatch.setattr(compiler, "_WORTH_A_TABLE", limit)
    program = f"!start. +!start <- !do(Z, 1); .print(Z); W = Y + 1; Y = 0; !do(W, 2). {PLANS}"
    assert printed(program) == ["b1", "b", "number2"]
