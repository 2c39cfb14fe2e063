"""A feature pays rent: an example, a lesson, a how-to or a recorded program uses it, and plans that do not use it
pay nothing."""

import re
from pathlib import Path

import pytest

from jacaros.agents.language.directives import PATTERNS
from jacaros.robots.streams import OPERATORS
from jacaros.testing import AgentHarness

ROOT = Path(__file__).parents[2]
PLACES = ("examples", "experiment", "docs/tutorial", "docs/how-to", "tests/conformance")
ANNOTATIONS = (
    *("within", "hard_deadline", "retry", "every", "while", "cleanup", "needs", "policy", "urgency"),
    *("atomic", "all_unifs"),
)
"""What goals and plans can be annotated with."""
USED = "\n".join(
    file.read_text(encoding="utf-8", errors="replace")
    for place in PLACES
    for file in sorted((ROOT / place).rglob("*"))
    if file.suffix in (".asl", ".md", ".jcm", ".mas2j", ".json", ".yaml", ".py")
)


@pytest.mark.parametrize("name", ANNOTATIONS)
def test_an_annotation_is_used(name: str) -> None:
    assert re.search(rf"\[[^\]\n]*\b{name}\b[^\]\n]*\]", USED)


@pytest.mark.parametrize("name", PATTERNS)
def test_a_goal_pattern_is_used(name: str) -> None:
    assert re.search(rf"\{{ *begin {name}\(", USED)


@pytest.mark.parametrize("name", OPERATORS)
def test_an_operator_is_used(name: str) -> None:
    assert re.search(rf"\{{{name}: ", USED)


PROGRAM = """
limit(1000).
+p(X) : limit(L) & X < L <- -+last(X); Y = X + 1; !turn(Y).
+!turn(Y) <- -+turned(Y).
"""
UNUSED = {
    "needs": "@u[needs(wheels)] +!never <- .print(never).",
    "a goal condition": "+!never <: done <- .print(never).",
    "a sub-plan": "+!never { +other(X) <- .print(X). }",
    "a deadline": "+!never <- !later[within(1000)]. +!later.",
    "attempts": "+!never <- !later[retry(3, 100)]. +!later.",
    "a guard": "@u[while(limit(_))] +!never <- .wait(1000).",
    "forks": "+!never <- .print(a) |&| .print(b).",
}


def perceive(agent: AgentHarness, first: int, end: int) -> None:
    """Let the agent notice new values and react."""
    for number in range(first, end):
        agent.perceive(f"p({number})")
        agent.run()
        agent.perceive_no_more(f"p({number})")


@pytest.mark.parametrize("plan", UNUSED.values(), ids=UNUSED)
def test_a_plan_that_never_runs_costs_the_others_nothing(plan: str, calls_of) -> None:
    def calls(program: str) -> int:
        """Python functions that are called for a hundred percepts with a plan."""
        agent = AgentHarness(program)
        agent.run()
        perceive(agent, 0, 20)
        return calls_of(lambda: perceive(agent, 20, 120))

    assert calls(PROGRAM + plan) <= 1.01 * calls(PROGRAM)
