"""Questions change nothing, by construction: whatever is not declared pure is refused, wherever it is called from."""

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.rules.context import LARGEST, Impure, reading
from jacaros.agents.mind.state.budget import SearchLimit
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.runtime.mas.embedding.running_agent import question

PROGRAM = """
{ register_function("my.sum", 2, "sum") }
{ register_function("my.dice", 1, "dice") }
p(1). p(2). ~q(3)[source(bob)].
low(X) :- p(X) & X < 2.
sum(X, Y, X + Y).
dice(X, R) :- .random(R) & X > 0.
summed(X) :- X = my.sum(1, 2) + 1.
thrown(X) :- X = my.dice(1).
rewrites(X) :- p(X) & .abolish(p(_)).
asks(F) :- F.
endless(X) :- endless(X + 1).
!wait.
+!wait : low(1) <- .wait({+never}).
"""
IMPURE = sorted(name for name, action in STANDARD.items() if not action.pure and not action.prints)


def asked() -> RecordingHost:
    host = mind(PROGRAM)
    host.run()
    return host


def answers(agent: Circumstance, formula: str, steps: int = 10_000) -> list[str]:
    """The answers of a formula in a read-only view, each with the values of its variables."""
    with reading(agent, steps) as view:
        term, names = question(formula)
        return [", ".join(f"{n}={text(resolve(v))}" for n, v in names.items()) for _ in view.answers(term)]


def state(agent: Circumstance) -> object:
    """All that a question could change."""
    return (
        [text(each) for each in agent.beliefs.literals()],
        [text(plan.label) for plan in agent.library.plans],
        list(agent.alive),
        list(agent.events),
        agent.architecture.random.getstate(),
        len(agent.trail),
        agent.beliefs.budget,
    )


@pytest.mark.parametrize(
    ("formula", "found"),
    [
        ("p(X)", ["X=1", "X=2"]),
        ("low(X)", ["X=1"]),
        ("not p(3) & p(X) & X > 1", ["X=2"]),
        ("~q(X)[source(S)]", ["X=3, S=bob"]),
        ("summed(X)", ["X=4"]),
        (".findall(X, p(X), L)", ["X=X, L=[1,2]"]),
        (".count(p(Y), N)", ["Y=Y, N=2"]),
        ("asks(p(2))", [""]),
        (".eval(X, p(3))", ["X=false"]),
        (".intend(wait)", [""]),
        (".relevant_plans({+!wait}, L) & .length(L, N) & L = M", None),
    ],
)
def test_a_question_is_answered(formula, found):
    agent = asked().agent
    before = state(agent)
    assert answers(agent, formula) == found or (found is None and answers(agent, formula))
    assert state(agent) == before


@pytest.mark.parametrize("name", IMPURE)
@pytest.mark.parametrize(
    "form", ["{}", "asks({})", "not {}", "F = {} & F", ".findall(1, {}, L)", ".eval(R, {})"]
)
def test_every_internal_action_that_is_not_declared_pure_is_refused(name, form):
    host = asked()
    action = STANDARD[name]
    arguments = ", ".join(["{+!z <- .print(no)}", '"x"', "x"][: action.minimum])
    before = state(host.agent)
    with pytest.raises(Impure, match=f"`{name}` may have effects"):
        answers(host.agent, form.format(f"{name}({arguments})" if arguments else name))
    assert state(host.agent) == before


@pytest.mark.parametrize(
    "formula", ["rewrites(X)", "thrown(X)", "X = math.random", "N = .count(rewrites(Y))"]
)
def test_an_effect_that_a_rule_or_function_hides_is_refused(formula):
    agent = asked().agent
    before = state(agent)
    with pytest.raises(Impure):
        answers(agent, formula)
    assert state(agent) == before


def test_questions_print_nothing_and_do_not_exhaust_the_memory():
    host = asked()
    logged = len(host.logged)
    assert answers(host.agent, '.print("no") & .nth(9, [a], X)') == []
    assert host.printed == []
    assert len(host.logged) == logged
    doubling = " & ".join(f".concat(X{i}, X{i}, X{i + 1})" for i in range(60))
    for first in ('"abcdefgh"', "[1, 2, 3]"):
        with pytest.raises(SearchLimit, match=f"more than {LARGEST} elements"):
            answers(asked().agent, f"X0 = {first} & {doubling}")


@pytest.mark.parametrize(
    "formula", ["endless(0)", ".range(X, 1, 1000000) & X < 0", "p(X) & p(Y) & endless(Y)"]
)
def test_a_search_ends_after_its_steps(formula):
    agent = asked().agent
    with pytest.raises(SearchLimit):
        answers(agent, formula, 500)
    assert agent.beliefs.budget is None
