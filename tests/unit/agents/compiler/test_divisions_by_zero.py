"""A written division by zero inside a term fails where the plan comes to it, and nothing before."""

import pytest

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
