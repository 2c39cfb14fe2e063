"""Calls of internal actions as formulas, and their answers as text."""

from collections.abc import Iterator
from typing import Any

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_formula
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.mind.actions.internal_action import STANDARD, ActionError, WrongArguments
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import arguments_of

SHOWN = ("W", "X", "Y", "Z")
"""The variables whose values are shown, in this order."""


def calls(cases: str) -> pytest.MarkDecorator:
    """Parametrize a test with lines ``formula => answer | answer``; ``//`` begins a comment."""
    lines = [
        line.strip() for line in cases.splitlines() if line.strip() and not line.strip().startswith("//")
    ]
    found = [line.rpartition(" => ") for line in lines]
    assert all(arrow for _, arrow, _ in found)
    params = [pytest.param(formula, wanted, id=formula) for formula, _, wanted in found]
    return pytest.mark.parametrize(("formula", "wanted"), params)


def answers(formula: str, host: RecordingHost | None = None) -> str:
    """The values of the variables `SHOWN` in each answer of calls joined by ``&``, made in turn.

    ``yes`` stands for an answer without such variables, ``no`` for no answer, ``wrong: ...`` for arguments that are
    refused, and ``error: ...`` for an error.
    """
    agent = (host or mind("b(2). b(7). b(5). c(9).")).agent
    node, names = parse_formula(formula), Variables()
    steps = nodes.operands(node) if isinstance(node, nodes.And) else [node]
    written = [each.name for each in nodes.variables_in(node)]
    shown = [name for name in SHOWN if name in written]
    found = []
    try:
        for _ in _run(agent.context, [lower(step, names.__getitem__) for step in steps]):
            found.append(" ".join(text(names[name]) for name in shown) or "yes")
    except WrongArguments as fault:
        return f"wrong: {fault}"
    except ActionError as fault:
        return f"error: {fault}"
    return " | ".join(found) or "no"


def _run(context: Any, steps: list[Any]) -> Iterator[None]:
    if not steps:
        yield
        return
    values = [resolve(argument) for argument in arguments_of(steps[0])]
    action = STANDARD[(steps[0] if not values else steps[0][0]).name]
    assert action.takes(len(values)), action.name
    mark = len(context.trail)
    result = action.function(context, *values)
    for _ in result if action.backtracks else [True] * (result is not False):
        yield from _run(context, steps[1:])
        undo(context.trail, mark)
