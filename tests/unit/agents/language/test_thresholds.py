"""The values that conditions compare beliefs with, traced through rules."""

import pytest

from jacaros.agents.checks.formulas import clauses
from jacaros.agents.checks.thresholds import Argument, thresholds
from jacaros.agents.language.loader import load_program


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("+!go : battery(B) & B < 20 <- act.", ["battery/0 < 20"]),
        ("+battery(B) : 20 > B <- act.", ["battery/0 < 20"]),
        ("+!go : not (battery(_, B) & B >= -5) <- act.", ["battery/1 >= -5"]),
        ("+!go <- ?battery(B); if (B < 20) { act }.", ["battery/0 < 20"]),
        ("low :- battery(B) & limit(L) & B < L.", ["battery/0 < limit/0"]),
        (
            "left(P) :- raw(P). left(P) :- battery(P, _). low :- left(P) & P < 9.",
            ["raw/0 < 9", "battery/0 < 9"],
        ),
        ("deep(X) :- deep(X). deep(X) :- p(X). +!go : deep(X) & X > 1 <- act.", ["p/0 > 1"]),
        ("+!go(X) : X > 1 <- act.", []),
        ("+!go : mode(M) & M == 1 <- act.", []),
        ("+!go : battery(B) & B * 2 > 1 <- act.", []),
    ],
)
def test_conditions_that_compare_beliefs(text: str, expected: list[str]) -> None:
    def shown(value: Argument | float) -> str:
        return f"{value.name}/{value.place}" if isinstance(value, Argument) else f"{value:g}"

    program, _ = load_program("robot.asl", text)
    found = thresholds(clauses(program))
    assert [f"{shown(each.belief)} {each.operator} {shown(each.value)}" for each in found] == expected


def test_many_recursive_rules_take_linear_time() -> None:
    rules = " ".join(f"p{n}(X) :- {' | '.join(f'p{m}(X)' for m in range(30))} | q(X)." for n in range(30))
    program, _ = load_program("robot.asl", f"{rules} +!go : p0(X) & X > 1 <- act.")
    assert [each.belief.name for each in thresholds(clauses(program))] == ["q"]
