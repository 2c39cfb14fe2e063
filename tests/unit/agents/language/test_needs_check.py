"""Needs that no run can meet are reported before it."""

import pytest

from jacaros.agents.checks.checker import wrong_needs
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import ByKind


def told(program: str) -> list[tuple[str, str | None]]:
    read, _ = load_program("test.asl", program)
    return [(each.message, each.help) for each in wrong_needs(ByKind(*read.plans))]


@pytest.mark.parametrize(
    ("needs", "message", "help"),
    [
        ("needs(lift(2))", "expected a resource", "write names"),
        ("needs(arm), policy(refusse)", "unknown policy `refusse`", "did you mean `refuse`?"),
    ],
)
def test_needs_that_can_never_be_met_are_reported(needs, message, help):
    for program in (f"@a[{needs}] +!g <- b.", f"+!f <- !g[{needs}]."):
        ((found, help),) = told(program)
        assert message in found
        assert help is not None
        assert help in help


def test_needs_that_can_be_met_are_not_reported():
    for needs in ("needs(arm,base)", 'needs("/r1/wheels")'):
        assert not told(f"@a[{needs}, policy(refuse)] +!g <- b.")
