"""Atomic plans: nothing comes in between, and what that does not mean."""

from recording_host import mind, printed

from jacaros.agents.mind.rules.cycle import event_of, is_ready
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, atom, functor


def test_an_atomic_plan_is_never_interleaved() -> None:
    lines = printed(
        """
        !a. !b.
        @l[atomic] +!a <- .print(a1); !sub; .print(a3).
        +!sub <- .print(a2).
        +!b <- .print(b1); .print(b2).
        """
    )
    assert lines == ["a1", "a2", "a3", "b1", "b2"]


def test_nothing_else_runs_while_an_atomic_plan_waits() -> None:
    lines = printed(
        """
        !a. !b.
        @l[atomic] +!a <- .print(a1); .wait(50); .print(a2).
        +!b <- .print(b1).
        """
    )
    assert lines == ["a1", "a2", "b1"]


def test_an_atomic_intention_handles_its_own_failure_events() -> None:
    assert printed(
        """
        !a.
        @l[atomic] +!a <- .wait({+x}, 100); .print(no).
        -!a[error(E)] <- .print(E); !b.
        @m[atomic] +!b <- !h; .print(after).
        +!h <- .fail_goal(h); .print(no).
        -!h <- .print(handled).
        """
    ) == ["wait_timeout", "handled", "after"]


def test_the_intention_of_an_ended_atomic_plan_runs_one_more_step_first() -> None:
    assert printed(
        """
        !a. !b.
        +!a <- .print(a0); !s; .print(a1); .print(a2).
        @l[atomic] +!s <- .print(s1); .print(s2).
        +!b <- .print(b1); .print(b2); .print(b3).
        """
    ) == ["a0", "s1", "s2", "a1", "b1", "a2", "b2", "b3"]


def test_a_tail_call_ends_the_privilege_of_an_atomic_plan() -> None:
    assert printed(
        """
        !a(2). !b.
        @l[atomic] +!a(N) : N > 0 <- .print(N); !a(N-1).
        +!a(0) <- .print(z1); .print(z2); .print(z3); .print(z4).
        +!b <- .print(b1); .print(b2); .print(b3).
        """
    ) == ["2", "1", "z1", "z2", "b1", "z3", "b2", "z4", "b3"]


def test_an_atomic_intention_finds_its_own_event_after_others() -> None:
    host = mind("+!a <- .wait(10). +!b.")
    host.agent.post_goal(atom("a"))
    host.agent.run(10)
    (intention,) = host.agent.alive.values()
    host.agent.post_goal(atom("b"))
    assert event_of(host.agent, intention) is None
    own = ((trigger("+", "!", functor("b", 0)),), intention, BY_SELF, None)
    host.agent.events.append(own)
    assert event_of(host.agent, intention) is None  # it waits for something else
    intention.waiting = None
    assert event_of(host.agent, intention) is own
    host.agent.intentions.append(intention)
    assert is_ready(host.agent, intention)
    assert event_of(host.agent, intention) is None


def test_an_atomic_intention_continues_wherever_it_is() -> None:
    plans = "@a[atomic] +!a <- !b; .print(a). +!b <- !c; .print(b). @c[atomic] +!c <- .print(c). +!d(X) <- .print(X)."
    goals = [*(f"!d({number})." for number in range(3)), "!a.", *(f"!d({number})." for number in range(3, 6))]
    lines = printed(" ".join([*goals, plans]))
    assert "".join(lines).count("cba") == 1
