"""Whatever a program does, its agent lives on: what cannot be done fails, with a reason, and only that."""

import gc

import pytest
from recording_host import believed, mind, printed, programs

from jacaros.agents.mind.actions import internal_action
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.values import String, Var, atom, structure


@pytest.fixture(autouse=True)
def without_garbage() -> None:
    """What earlier tests left behind is not cleared away in the depths of a recursion, where there is no room for it."""
    gc.collect()


PROGRAMS = """
a context may end with a difference => yes
    !g(5,2). +!g(X,Y) : 2 < X-Y <- .print(yes). +!g(_,_) <- .print(no).
a plan for any goal fails in place after many kinds of goals => b | test_goal_failed missing
    !a.
    +!X : not b = X <- !b; ?missing.
    +!b <- .print(b).
    -!a[error(E), code(C)] <- .print(E, " ", C).
running plans for every goal show what is left of each => { !show; .print(rest) } | rest
    !a(1).
    +!X : not show = X & not c = X <- !c; !show; .print(rest).
    +!c.
    +!show <- .intention(_, _, S, current); .reverse(S, [im(_, _, B, _)|_]); .print(B).
an infinite number may be in a head => infinite
    !g(1/0). +!g(1e400) <- .print(infinite). +!g(_) <- .print(other).
the reasons of a retried goal do not pile up => unknown[source(self)]
    n(0). !unknown.
    -!X : n(N) & N < 60 <- -+n(N+1); !X.
    -!X[code(C)] <- .print(C).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_unevaluated_initial_clauses_are_skipped_and_reported():
    host = mind("p(1). p(1 div 0). !g(1 div 0). !h. +!h <- .print(ready). +!g(_) <- .print(never).")
    host.run()
    assert host.printed == ["ready"]
    assert believed(host, "p") == ["p(1)[source(self)]"]
    assert [text for level, text in host.logged if level == "error"] == [
        "tester.asl:1: cannot evaluate an initial belief or goal: integer division by zero",
        "tester.asl:1: cannot evaluate an initial belief or goal: integer division by zero",
    ]
    host = mind("r(1)[1 div 0] :- p. p. !g. +!g <- .print(alive).")
    host.run()
    assert host.printed == ["alive"]
    assert any("cannot evaluate" in text for level, text in host.logged if level == "error")


@pytest.mark.parametrize(
    "fault",
    [
        KeyError("k"),
        RecursionError(),
        MemoryError(),
        ZeroDivisionError(),
        StopIteration(),
        OSError(),
        SystemError(),
    ],
)
def test_an_exception_of_an_internal_action_fails_its_step_only(fault, monkeypatch):
    def explode(ctx: object) -> None:
        raise fault

    monkeypatch.setitem(internal_action._declared, ".explode", InternalAction(".explode", explode))
    program = """
    !a. !b.
    +!a <- .explode; .print(never).
    -!a[error(E)] <- .print(E).
    +!b <- .wait(1); .print(alive); if (.explode) { .print(never) } else { .print(no) }.
    """
    host = mind(program)
    host.run()
    assert host.printed[1:] == ["alive", "no"]
    assert host.printed[0] in ("unknown", "internal_action", "too_deep", "no_memory")


@pytest.mark.parametrize(
    "content",
    [
        1.0,
        String("p("),
        String("\ud800"),
        Var("X"),
        structure("p", Var("X")),
        structure("f", structure("g")),
        atom("[]"),
    ],
    ids=str,
)
@pytest.mark.parametrize(
    "performative",
    [
        *("tell", "untell", "achieve", "unachieve", "signal", "askOne", "askAll", "askHow", "tellHow"),
        *("untellHow", "unheard_of", "ask-one"),
    ],
)
def test_no_message_content_does_any_harm(performative, content):
    host = mind("q(1). +!g <- .print(here).")
    host.agent.receive(SpeechAct(performative, "friend", "tester", content, "m1"))
    host.run()
    host.agent.post_goal(atom("g"))
    host.run()
    assert host.printed == ["here"]
    if performative in ("askOne", "askAll", "askHow", "ask-one"):
        assert [message.in_reply_to for message in host.sent] == ["m1"]


def ended(program: str, **options: int) -> list[str]:
    """What a program prints with small limits."""
    host = mind(program, options=Options(**options))
    host.run()
    return host.printed


def test_endless_rules_fail_with_the_reason():
    program = """
    !s. !other.
    endless(N) :- endless(N+1).
    +!s <- ?endless(0); .print(never).
    -!s[error(E), error_msg(M)] <- .print(E); .print(M).
    +!other <- .print(alive).
    """
    assert ended(program, rule_depth=2000) == [
        "alive",
        "too_deep",
        "more than 2000 rules and conditions are open at once (option rule_depth)",
    ]


def test_endless_conditions_and_changes_have_an_end():
    program = "!s. e :- e. +!s : e <- .print(never). +!s <- .print(next); if (e) { .print(never) }. -!s <- .print(failed)."
    assert ended(program, rule_depth=2000) == ["next", "failed"]
    program = "!s. +!s <- +b(1); .print(never). +b(N) <- +b(N+1); .print(never). -!s[error(E)] <- .print(E)."
    assert ended(program, goal_depth=500) == ["too_deep"]


def test_endless_goals_fail_with_the_reason():
    program = """
    !s.
    +!s <- !g(0).
    +!g(N) <- !g(N+1); .print(never).
    -!s[error(E), error_msg(M), code(C)] <- .print(E); .print(M); .print(C).
    """
    assert ended(program, goal_depth=500) == [
        "too_deep",
        "more than 500 plans are on the stack of the intention (option goal_depth)",
        "g(499)[source(self)]",
    ]


def test_goals_without_value_fail_and_can_be_handled():
    program = """
    !g. !h.
    +!g <- Y = 1 div X; X = 0; !unknown(Y); .print(never).
    -!g[error(E)] <- .print(E).
    +!h <- .print(alive).
    """
    assert sorted(printed(program)) in (["alive", "arithmetic_error"], ["alive", "no_relevant"])
    program = """
    !s.
    +!s <- !g(1); .print(done).
    +!g(N) <- !g(N+1); -+depth(N).
    -!g(N)[error(too_deep)] <- .print(N).
    """
    assert ended(program, goal_depth=500) == ["500", "done"]
    program = """
    !s. !other.
    +!s <- !g(0); .print(never).
    +!g(N) <- ?missing.
    -!g(N) <- !g(N+1).
    -!s[error(E)] <- .print(E).
    +!other <- .print(alive).
    """
    assert ended(program, goal_depth=500) == ["alive", "too_deep"]


@pytest.mark.whole_stack
def test_an_element_that_python_could_not_hash_is_refused():
    program = """
    !g.
    +!g <- !deep(20000, a, T); .set.create(S); .set.add(S, [1, 2]); .print(S); .set.add(S, T); .print(never).
    +!deep(0, T, T).
    +!deep(N, T, R) <- !deep(N-1, f(T), R).
    -!g[error(E)] <- .print(E).
    """
    assert printed(program) == ["{[1,2]}", "too_deep"]


@pytest.mark.whole_stack
def test_a_sum_that_waits_for_its_operand_may_be_hundreds_of_operations_deep():
    program = """
    !s.
    +!s <- !sum(300, 0, Open, S); Open = 1; .print(S).
    +!sum(0, A, _, A).
    +!sum(N, A, Open, S) <- !sum(N-1, A+Open, Open, S).
    """
    assert printed(program) == ["300"]
