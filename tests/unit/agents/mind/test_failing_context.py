"""Where the contexts of the plans for a lost goal fail: the first failing conjunct, with the values of its variables."""

from random import Random

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.rules.meta_events import observe_goals


def candidates(program: str, **arguments: object) -> list[str]:
    """The lines about plans that did not fit, without their beginning and the place of the plan."""
    return _candidates(_run(program, **arguments))


def _run(program: str, **arguments: object) -> RecordingHost:
    host = mind(program, **arguments)  # type: ignore[arg-type]
    host.run()
    return host


def _candidates(host: RecordingHost) -> list[str]:
    lines = [line.strip() for _, logged in host.logged for line in logged.splitlines()]
    return [line.removeprefix("does not fit: ") for line in lines if line.startswith("does not fit: ")]


def stop(program: str, **arguments: object) -> str:
    """Where the context of the only plan fails."""
    (line,) = candidates(program, **arguments)
    _, _, found = line.partition("), ")
    return found


def test_the_failing_conjunct_is_shown_with_the_values_of_its_variables():
    found = stop("battery(12). limit(20). !go.\n+!go : battery(B) & limit(L) & B > L.")
    assert found == "stops at `B > L` with B=12, L=20"
    assert stop("zone(hall). !go(kitchen).\n+!go(R) : zone(R).") == "stops at `zone(R)` with R=kitchen"
    program = "at(3). at(12). door(12). !go.\n+!go : at(X) & door(X) & X > 50."
    assert stop(program) == "stops at `X > 50` with X=12"
    found = stop("p(1). p(2). p(3). !go.\n+!go : p(X) & X > 5.")
    assert found == "stops at `X > 5` with X=1 (the first of 3 answers)"


def test_a_belief_that_the_agent_does_not_have_is_named_and_long_values_are_cut():
    assert stop("!go(a).\n+!go(R) : zone(R).") == "stops at `zone(R)` with R=a: no belief `zone`"
    assert stop("zone(a). !go(a).\n+!go(R) : zones(R).") == (
        "stops at `zones(R)` with R=a: no belief `zones`; did you mean `zone`?"
    )
    assert stop("redy. !go.\n+!go : ready.") == "stops at `ready`: no belief `ready`; did you mean `redy`?"
    assert stop("at(1,2). !go.\n+!go : at(P).") == "stops at `at(P)`: no belief `at/1`; there is `at/2`"
    assert (
        stop("~safe(a). !go.\n+!go : ~save(a).")
        == "stops at `~save(a)`: no belief `~save`; did you mean `~safe`?"
    )
    found = stop(f"p([{'abcdefghij,' * 20}a]). !go.\n+!go : p(L) & q(L).")
    assert found.startswith("stops at `q(L)` with L=[abcdefghij,")
    assert found.endswith("...: no belief `q`")
    assert len(found) < 100


def test_each_kind_of_conjunct_is_shown():
    assert stop("p(1). !go.\n+!go : p(X) & (X > 5 | q(_)).") == "stops at `X > 5 | q(_)` with X=1"
    assert stop("p(1). !go.\n+!go : p(X) & not p(X).") == "stops at `not p(X)` with X=1"
    program = "low(X) :- battery(X) & X < 20. battery(12). !go.\n+!go : low(X) & X < 10."
    assert stop(program) == "stops at `X < 10` with X=12"
    assert stop("p(2). !go.\n+!go : p(2) & N::p(1) & ready.") == "stops at `N::p(1)`"
    assert stop("low(X) :- X < 5. !go.\n+!go : low(7).") == "stops at `low(7)`"


def test_every_relevant_plan_has_its_own_conjunct_those_whose_trigger_fits_first():
    assert candidates("p. !go.\n+!go : p & q.\n+!go : r.") == [
        "+!go (tester.asl:2), stops at `q`",
        "+!go (tester.asl:3), stops at `r`",
    ]
    assert candidates("!go(2).\n+!go(1).\n+!go(X) : X > 5.") == [
        "+!go(X) (tester.asl:3), stops at `X > 5` with X=2",
        "+!go(1) (tester.asl:2)",
    ]
    assert stop("!go.\n+!go <- .fail.\n-!go : holiday.") == "stops at `holiday`"


def test_internal_actions_without_effects_are_called_again():
    program = "!go([1,2]).\n+!go(L) : .length(L, N) & .member(X, L) & X > N."
    assert stop(program) == "stops at `X > N` with X=1, N=2 (the first of 2 answers)"
    assert stop("p(1). p(2). !go.\n+!go : .count(p(_), N) & N > 5.") == "stops at `N > 5` with N=2"
    assert stop("p(1). p(2). !go.\n+!go : .count(p(_)) > 5.") == "stops at `.count(p(_)) > 5`"


def test_effects_of_a_context_are_not_repeated():
    assert [
        name for name, action in STANDARD.items() if action.pure and action.suspends | action.prints
    ] == []
    host = _run('!go.\n+!go : .print("looking") & ready.')
    assert host.printed == ["looking"]
    assert _candidates(host) == ["+!go (tester.asl:2), stops at `ready`"]
    found = stop("lucky :- .random(X) & X < 0. !go.\n+!go : lucky.")
    assert found == "not examined from `lucky` on, which may have effects"
    host = _run("p(a). !go.\n+!go : p(X) & .nth(9, [a], N) & q.")
    reports = [text for _, text in host.logged if "does not hold because" in text]
    assert len(reports) == 1


@pytest.mark.parametrize(
    "conjunct", [".random(X)", ".add_plan({+!a})", "math.random < 2", ".queue.add(Q, 1)"]
)
def test_calls_that_may_have_an_effect_are_not_repeated(conjunct):
    found = stop(f"p. !go.\n+!go : p & {conjunct} & ready.")
    assert found == f"not examined from `{conjunct}` on, which may have effects"


def test_searches_are_limited_and_random_numbers_are_not_used_up():
    program = "!go.\n+!go : p(X) & endless(0).\nendless(X) :- endless(X + 1). p(1)."
    host = _run(program)
    assert _candidates(host) == ["+!go : p(X) & endless(0) (tester.asl:2)"]
    found = stop("!go.\n+!go : .range(X, 1, 20000) & X > 50000.")
    assert found.startswith("stops at `X > 50000` with X=1 (the first of ")
    assert found.endswith(" answers); not searched to the end")
    host = mind("p(1). p(2). low(X) :- p(X) & X > 5.\n+!go : low(X).\n!go.")
    host.run()
    assert host.agent.beliefs.budget is None
    host = _run("!go.\n+!go : .random(X) & X < 0.")
    expected = Random(1)
    expected.random()
    assert host.random.random() == expected.random()


def test_nothing_is_searched_for_handled_failures(monkeypatch):
    monkeypatch.setattr("jacaros.agents.mind.rules.failure_reason.FailingContexts", None)
    host = _run(
        "!go.\n+!go : ready.\n-!go <- .print(saved).\n!outer.\n+!outer <- !go(1).\n+!go(X) : ready.\n-!outer."
    )
    assert host.printed == ["saved"]


def test_an_observer_gets_the_conjunct_of_a_lost_goal():
    host = mind("battery(12). !go.\n+!go : battery(B) & B > 20.")
    heard: list[str] = []
    observe_goals(host.agent, lambda state, goal, number, intention, why: heard.append(why) if why else None)
    host.run()
    (why,) = heard
    error, plan = why.splitlines()
    assert error == "no_applicable, no applicable plan for !go"
    assert plan == "does not fit: +!go (tester.asl:2), stops at `B > 20` with B=12"
