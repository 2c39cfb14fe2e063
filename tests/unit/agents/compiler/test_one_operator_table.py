"""A line more in the operator table is all that lexer, parser, printers, layout, generated code and rules need."""

import os
import subprocess
import sys

import pytest

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
