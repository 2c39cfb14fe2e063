"""An internal action is known by its declaration alone: a new one needs no change of parser, checker, compiler and mind."""

import pytest
from recording_host import mind

from jacaros.agents.checks.flow import flows_of
from jacaros.agents.language.loader import load_program
from jacaros.agents.mind.actions import internal_action
from jacaros.agents.mind.actions.internal_action import STANDARD, InternalAction
from jacaros.agents.terms.values import Term


def total(found: list[Term]) -> Term:
    return float(sum(found))


@pytest.fixture(autouse=True)
def _total(monkeypatch: pytest.MonkeyPatch) -> None:
    action = InternalAction(".total", total, arity=3, condition=1, collects=True, pure=True)
    monkeypatch.setitem(internal_action._declared, ".total", action)


def printed(program: str) -> list[str]:
    host = mind(program)
    host.run()
    return host.printed


def test_every_way_to_ask_collects():
    assert printed("p(1). p(2). !g.\n+!g : .total(X, p(X), 3) & .total(X, p(X), T) <- .print(T).") == ["3"]
    assert printed("t(T) :- .total(X, p(X), T). p(1). p(2). !g.\n+!g : t(T) <- .print(T).") == ["3"]
    assert printed("p(1). p(2). !g.\n+!g <- .total(X * 2, p(X) & X > 1, T); .print(T).") == ["4"]
    assert printed(
        "p(1). p(2). !g.\n+!g <- Q = p(X); .total(X, Q, T); .eval(B, .total(Y, p(Y), 3)); .print(T, B)."
    ) == ["3true"]


def test_waits_failures_and_the_check_see_the_condition():
    host = mind("p(1). !g.\n+!g <- .wait(.total(X, p(X), 3)); .print(done).")
    host.run()
    assert host.agent.waits.conditions
    assert not host.agent.waits.restless
    host = mind("p(1). !g.\n+!g : .total(X, p(X), T) & T > 5.")
    host.run()
    assert any("stops at `T > 5` with T=1" in logged for _, logged in host.logged)
    program, _ = load_program("robot.asl", "+!g <- .total(X, zone(X), T); .print(T).", actions=STANDARD)
    assert {reader.key[0] for reader in flows_of([program], STANDARD)[0].readers} == {"zone"}
