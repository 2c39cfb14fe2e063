"""Control statements that are written as internal actions."""

import pytest
from asl_lab import parse_plan

from jacaros.agents.language import nodes


def step(text: str) -> object:
    body = parse_plan(f"+!g <- {text}").body
    assert isinstance(body, nodes.Body)
    (only,) = body.steps
    return only


@pytest.mark.parametrize(
    ("action", "statement"),
    [
        (".if_then_else(p(X), { .print(X) })", "if (p(X)) { .print(X) }"),
        (".if_then_else(p, { a; b }, { })", "if (p) { a; b } else { }"),
        (".foreach(p(X) & X > 1, { +q(X); !g })", "for (p(X) & X > 1) { +q(X); !g }"),
        (".loop(not p, { !g })", "while (not p) { !g }"),
        (".fork(and, { a; b }, { !c })", "(a; b) |&| !c"),
        (".fork(or, { a }, { b }, { c })", "a ||| b ||| c"),
    ],
)
def test_they_mean_the_statements(action, statement):
    assert step(action) == step(statement)


@pytest.mark.parametrize(
    "action", [".foreach(p)", ".foreach(p, q)", ".fork(xor, { a }, { b })", ".fork(and, { a })"]
)
def test_other_forms_are_plain_internal_actions(action):
    assert isinstance(step(action), nodes.Constraint)
