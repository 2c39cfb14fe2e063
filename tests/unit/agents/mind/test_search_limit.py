"""The agent option ``search_limit``: a search without end fails, and its agent lives on."""

import pytest
from recording_host import mind

from jacaros.agents.mind.state.budget import Options

ENDLESS = {
    "range": "e :- .range(I, 1, 1e15) & I < 0.",
    "nested": "e :- .range(I, 1, 1000) & .range(J, 1, 1000) & .range(K, 1, 1000) & I + J + K < 0.",
    "recursion": "e :- p(60). p(N) :- N > 0 & p(N - 1). p(N) :- N > 0 & p(N - 1).",
    "deep": "e :- p(300). p(N) :- N > 0 & (p(N - 1) | p(N - 1)).",
    "negation": "e :- not q. q :- .range(I, 1, 1e15) & I < 0.",
    "facts": "s(1). s(2). s(3). e :- p(60). p(N) :- N > 0 & s(X) & p(N - 1) & X > 5.",
    "annotated": "e :- p(60)[a]. p(N)[a] :- N > 0 & (p(N - 1)[a] | p(N - 1)[a]).",
    "open": "q(X, Y, Z). e :- p(60). p(N) :- N > 0 & q(N, N, N) & p(N - 1). p(N) :- N > 0 & p(N - 1).",
}
"""Rules for ``e`` whose search ends only in another age."""


def ended(program: str, limit: int = 20_000) -> tuple[list[str], list[str]]:
    """Return the output and the log of an agent."""
    host = mind(program, options=Options(search_limit=limit))
    host.run()
    return host.printed, [text for _, text in host.logged]


@pytest.mark.parametrize("kind", ENDLESS)
def test_an_endless_search_in_a_step_fails_with_the_reason(kind: str) -> None:
    program = """
    !s.
    +!s <- ?e; .print(never).
    -!s[error(E), error_msg(M), code_line(L)] <- .print(E, " in line ", L); .print(M).
    """
    printed, told = ended(program + ENDLESS[kind])
    assert printed == [
        "search_limit in line 3",
        "the search takes more than 20000 rules and answers (option search_limit)",
    ]
    assert told == []


@pytest.mark.parametrize("kind", ENDLESS)
def test_a_context_with_an_endless_search_does_not_hold(kind: str) -> None:
    program = "!s. @first +!s : e <- .print(never). +!s <- .print(next). " + ENDLESS[kind]
    printed, told = ended(program)
    assert printed == ["next"]
    reason = "the search takes more than 20000 rules and answers (option search_limit)"
    assert told == [f"cannot evaluate the context of plan first: {reason}"]


def test_endless_collecting_fails_too() -> None:
    program = "!s. +!s <- .findall(I, .range(I, 1, 1e15), L); .print(never). -!s[error(E)] <- .print(E)."
    assert ended(program)[0] == ["search_limit"]


def test_a_handler_gets_the_whole_search_limit_again() -> None:
    program = """
    !s.
    +!s <- ?(.range(I, 1, 1e15) & I < 0).
    -!s <- .findall(I, .range(I, 1, 15000), L); .length(L, N); .print(N).
    """
    assert ended(program)[0] == ["15000"]


def test_searches_of_different_cycles_do_not_add_up() -> None:
    program = "!s. +!s <- for (.range(I, 1, 1000)) { ?(.range(J, 1, 100) & J = 100) }; .print(done)."
    assert ended(program)[0] == ["done"]


def test_agents_of_one_program_keep_their_own_budgets() -> None:
    program = "!s. e(0). e(N) :- N > 0 & e(N - 1). +!s <- ?e(50); .print(found). -!s[error(E)] <- .print(E)."
    assert [ended(program, limit)[0] for limit in (10, 0, 1000)] == [["search_limit"], ["found"], ["found"]]
