"""Operators of bodies, contexts and rules, and the table of plans."""

import os
import subprocess
import sys

import pytest
from recording_host import printed

from jacaros.agents.mind.generated import compiler
from jacaros.testing import run_project

WITH_MORE_OPERATORS = """
import importlib.util, sys

name = "jacaros.agents.terms.operators"
spec = importlib.util.find_spec(name)
module = sys.modules[name] = importlib.util.module_from_spec(spec)
source = open(spec.origin).read()
begin = "OPERATORS: Final = ("
assert begin in source
source = source.replace(begin, begin + '''
    Operator("xor", ARITHMETIC, 5, exclusive_or),
    Operator("><", RELATION, 4, operator.ne, "{0} != {1}"),
''')
source = source.replace("def power", '''
def exclusive_or(left, right):
    return float(int(left) ^ int(right))

def power''')
exec(compile(source, spec.origin, "exec"), module.__dict__)
"""
LAYOUT = """
from jacaros.agents.language.formatting import format_program
print(format_program("more.asl", sys.argv[1]))
"""
RUN = """
from jacaros.testing import run_project
print(*run_project(sys.argv[1], seconds=10).of("more"), sep="\\n")
"""


def answer(script: str, argument: str, **variables: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", WITH_MORE_OPERATORS + script, argument],
        capture_output=True,
        text=True,
        env={**os.environ, **variables},
        check=True,
    )
    return done.stdout.splitlines()


@pytest.fixture(params=["", "1"], ids=["fast", "plain"])
def run(tmp_path, request):
    def answers(plans: str) -> list[str]:
        program = tmp_path / "more.asl"
        program.write_text(f"!start. {plans}")
        return answer(RUN, str(program), JACAROS_PLAIN=request.param)

    return answers


def test_an_added_operator_is_computed_in_bodies_contexts_and_rules(run):
    assert run("+!start <- X = 6; Y = X xor 3 * 1; .print(Y); .stopMAS.") == ["5"]
    assert run("+!start : X = 6 & 5 == X xor 3 & 1 >< 2 <- .print(yes); .stopMAS.") == ["yes"]
    assert run("r(X, X xor 1). q(Y) :- r(2, Y) & not Y >< 3. +!start : q(Y) <- .print(Y); .stopMAS.") == ["3"]


def test_an_added_operator_is_computed_in_formulas_known_at_run_time(run):
    plans = '+!start <- .term2string(T, "f(6 xor X)"); T = f(A); X = 3; .term2string(C, "2 >< 6 xor 3");'
    assert run(plans + " ?C; .print(A); .stopMAS.") == ["(6 xor X)"]


def test_an_added_operator_is_printed_and_laid_out(run):
    assert run("+!start <- .print(f(X xor 1, a >< Y)); .stopMAS.") == ["f((X xor 1),(a >< Y))"]
    assert answer(LAYOUT, "+!start : 1><2 <- X=6  xor 3.")[:2] == ["+!start : 1 >< 2 <- X = 6 xor 3.", ""]


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
