"""Goals and loops that repeat without a step that takes time."""

import pytest
from asl_lab import program

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.checks.checker import check
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.mind.actions.internal_action import STANDARD


def places(text: str) -> list[tuple[str, int]]:
    """Return what repeats, and the line of the step by which it does."""
    found = check(program(text), KnownActions(STANDARD))
    return [
        (each.message.partition(" repeats")[0], each.span.line)
        for each in found
        if each.code == "loop-without-wait" and each.span is not None
    ]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("!go.\n+!go\n <- !go.", ("`!go`", 3)),
        ("+!go <- .print(a);\n !!go.", ("`!go`", 2)),
        ("+!go(N) <- +n(N); .random(X); if (n(X)) { +m } else { -m };\n !go(N + 1).", ("`!go`", 2)),
        ("+!go : ready <- !go. +!go\n <- !go.", ("`!go`", 2)),
        ("+!go : ready <- rest; !go. +!go\n <- !go.", ("`!go`", 2)),
        ("+!a <- !b.\n+!b <- .print(b);\n !a.", ("`!a`", 3)),
        ("+!go <- !note;\n !go. +!note <- +noted.", ("`!go`", 2)),
        ("+!go <- !!beat;\n !go. +!beat <- .wait(10).", ("`!go`", 2)),
        ("n(0). +!go <- ?n(N); -+n(N + 1);\n !go.", ("`!go`", 2)),
        ("n(a, 0). +!go <- ?n(a, N); -n(a, N); +n(a, N + 1);\n !go.", ("`!go`", 2)),
        ("+tick(N)\n <- -+tick(N + 1).", ("`+tick`", 2)),
        ("+!go <- .print(a);\n while (true) { +a }.", ("this loop", 2)),
        ("+!go <- .print(a);\n while (not ready & a) { .print(b) }.", ("this loop", 2)),
    ],
)
def test_a_loop_without_a_wait_is_reported_at_the_step_that_repeats_it(text, found):
    assert places(text) == [found]


@pytest.mark.parametrize(
    "text",
    [
        "+!go <- .wait(10); !go.",
        "+!go <- act; !go.",
        "+!go <- .wait({+ready}); !go.",
        "+!go <- !rest; !go. +!rest <- .wait(10).",
        "+!go <- !rest; !go. +!rest : tired <- +a.",  # the sub-goal may fail
        "+!go <- !rest; !go.",
        "+!go : ready <- !go.",
        "+!count(0). +!count(N) <- !count(N - 1).",
        "+!count(N) : N > 0 <- !count(N - 1). +!count(_).",
        "+!go([]) <- +done. +!go([H|T]) <- +seen(H); !go(T).",
        "+!go <- if (ready) { !go }.",
        "+!go <- ?n(N); N > 3; !go. n(0).",
        "+!go <- ?ready; !go.",
        "n(0). +!go(N) <- ?n(N); !go(N).",
        "n(0). +!go <- ?n(N); -n(N); !go.",
        "+!go <- !go[every(1000)].",
        "!go[within(50)]. +!begin <- !go[within(50)]. +!go <- !go.",
        "+!begin <- !go ||| .wait(10). +!go <- !step. +!step <- !go.",
        "@go[within(10)] +!go <- !go.",
        "+!begin <- !go. +!go <- !go. +stop <- .drop_intention(go).",
        "+!go <- !G; !go. +!h(G) <- !go.",
        "+p <- +p. +p(N) <- -+p(N).",
        "+!go <- while (n(N) & N > 3) { -+n(N - 1) }; while (p) { -p }; while (q) { .wait(1) }; while (false) { +a }.",
    ],
)
def test_loops_that_wait_or_end_are_not_reported(text):
    assert places(text) == []
