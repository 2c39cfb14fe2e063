"""What a mind keeps for what is pending, and what is left when that ends; and messages whose content is not a goal."""

from typing import Any

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.rules.pending import asked_by, note_change
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.terms.values import NIL, Term, functor


@pytest.fixture(params=["0", "1"], ids=["fast", "plain"], autouse=True)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test runs with generated code, and by the rules alone."""
    monkeypatch.setenv("JACAROS_PLAIN", request.param)


def term(source: str) -> Term:
    return lower_value(parse_term(source))


# --- awaited conditions ------------------------------------------------------------------------------------


def awaiting(condition: str) -> RecordingHost:
    host = mind(f"q(1). !s. +!s <- .wait({condition}, 50); .print(over). -!s <- .print(failed).")
    host.run(seconds=0.01)
    return host


def is_looked_at(host: RecordingHost, name: str, *arguments: float) -> bool:
    """Return whether a change of a belief makes the mind test the awaited condition again."""
    waits = host.agent.waits
    waits.due.clear()
    note_change(host.agent, functor(name, len(arguments)), arguments)
    return bool(waits.due or waits.restless)


def test_a_wait_looks_only_at_what_it_asks_for_and_is_forgotten():
    host = awaiting("p(3) & r(_)")
    assert not is_looked_at(host, "p", 4.0)
    assert not is_looked_at(host, "p", 3.0, 3.0)
    assert is_looked_at(host, "p", 3.0)
    assert is_looked_at(host, "r", 8.0)
    host = awaiting("p(X) & not q(2) & q(1)")
    assert len(host.agent.waits.conditions) == 1
    host.run()
    assert host.printed == ["failed"]
    assert not host.agent.waits.conditions
    assert not host.agent.waits.asked
    for name in ("p", "q"):
        assert not is_looked_at(host, name, 1.0)
        assert not is_looked_at(host, name, 2.0)


@pytest.mark.parametrize(
    ("condition", "followed"),
    [
        ("p(X) & X > 1", True),
        ("p(X) & not q(X, 2)", True),
        ("p(X)[a(Y)]", True),
        (".count(p(_), N) & N > 2", True),
        ("p(f([1, X]))", True),
        ("math.random > 0.5", False),
        ("p(X) & X > math.random", False),
        ("p(math.random)", False),
        ("p(f([1, math.random]))", False),
        ("p(X)[a(math.random)]", False),
        ("r(X)", False),
        ("X", False),
        (".my_name(X)", False),
    ],
)
def test_a_condition_on_facts_is_followed_and_any_other_tested_in_every_cycle(condition, followed):
    agent = mind("r(X) :- p(X). p(1). !s. +!s.").agent
    assert (asked_by(term(condition), agent.beliefs, STANDARD) is not None) is followed


# --- plans that react and plans with conditions ------------------------------------------------------------


@pytest.mark.parametrize(
    "end", [".wait(1)", ".fail", ".drop_intention(s)", ".fail_goal(s)", ".succeed_goal(s)"]
)
def test_an_intention_that_ends_is_not_kept_for_the_events_of_its_sub_plans(end):
    host = mind(
        f"""
        !s. +!s <- +seen; .wait(2); {end}. {{
            +e(X) <- .print(X).
        }}
        !t. +!t <- .wait(50).
        @g[atomic] +!g <: done <- true.
        """
    )
    host.run(seconds=0.001)
    assert sum(map(len, host.agent.holders.values())) == 1
    host.run()
    assert sum(map(len, host.agent.holders.values())) == 0
    assert not host.agent.conditioned


def test_handlers_of_failures_run_once():
    host = mind("!s. +!s <- .signal({-!g(1)}); .print(s). -!g(X) <- .print(h, X); .fail.")
    host.run(fuel=50, seconds=1)
    assert host.printed == ["s", "h1"]
    host = mind("!s. +!s <- !a. { +!x <- true. } +!a <- .fail. -!s <- .print(h); .fail.")
    host.run(fuel=100, seconds=1)
    assert host.printed == ["h"]


# --- messages ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("content", ["3", '"text"', "X"])
@pytest.mark.parametrize("performative", ["achieve", "tell"])
def test_a_message_whose_content_is_not_a_literal_is_refused(content, performative):
    host = mind("!s. +!s. +!g(X) <- .print(X).")
    host.run()
    host.agent.receive(SpeechAct(performative, "other", "tester", term(content), "m1"))
    host.run()
    assert host.printed == []
    assert [level for level, _ in host.logged] == ["warning"]


def test_messages_to_achieve_lists_and_urgent_ones():
    host = mind("!s. +!s. +!g(X) <- .print(X).")
    host.run()
    host.agent.receive(SpeechAct("achieve", "other", "tester", term("[g(1), g(2)]"), "m1"))
    host.agent.receive(SpeechAct("achieve", "other", "tester", NIL, "m2", flat=True))
    host.run()
    assert (host.printed, host.logged) == (["1", "2"], [])
    host = mind("!s. +!s <- .wait(1). +!low <- .print(low). @h[urgency(1)] +!high <- .print(high).")
    host.run()
    for name in ("low", "high"):
        host.agent.receive(SpeechAct("achieve", "other", "tester", term(name), name))
    selections: Any = host.agent.selections
    selections.look_anew()
    host.run()
    assert host.printed == ["high", "low"]


def test_questions_are_forgotten_when_they_are_answered():
    host = mind("!s. +!s <- .send(friend, askOne, p(_), A); .print(A).")
    host.run()
    (question,) = host.sent
    host.agent.receive(SpeechAct("tell", "friend", "tester", term("p(1)"), "a1", question.id))
    host.run()
    assert host.printed == ["p(1)[source(friend)]"]
    assert not host.agent.waits.questions
    host = mind("!s. +!s <- .send(friend, askOne, p(_), A); .print(A); .wait(50); .print(end).")
    host.run(seconds=0.01)
    (question,) = host.sent
    for name in ("a1", "a2"):
        host.agent.receive(SpeechAct("tell", "friend", "tester", term("p(1)"), name, question.id))
        host.run(seconds=0.01)
    host.run()
    assert host.printed == ["p(1)[source(friend)]", "end"]


# --- failures ----------------------------------------------------------------------------------------------


def test_conditions_that_cannot_be_evaluated_fail():
    host = mind(
        "!s. +!s <- .wait(p(X) & 1 div X > 0). -!s[error(E)] <- .print(E). !t. +!t <- .wait(5); +p(0)."
    )
    host.run()
    assert len(host.printed) == 1
    assert not host.agent.waits.conditions
    assert not host.agent.alive
    host = mind(
        """
        !s. @p[while(ok(X) & 1 div X > 0)] +!s <- .wait(50); .print(never). -!s[error(E)] <- .print(E).
        ok(1). !t. +!t <- .wait(5); -+ok(0).
        """
    )
    host.run()
    assert host.printed == ["condition_lost"]
    assert [level for level, _ in host.logged] == ["error"]
    assert "cannot evaluate the condition" in host.logged[0][1]
