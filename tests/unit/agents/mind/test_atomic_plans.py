"""Atomic plans: nothing comes in between, and what that does not mean."""

from recording_host import mind, printed, programs

from jacaros.agents.mind.rules.cycle import event_of, is_ready
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, atom, functor

PROGRAMS = """
an atomic plan is never interleaved => a1 | a2 | a3 | b1 | b2
    !a. !b.
    @l[atomic] +!a <- .print(a1); !sub; .print(a3).
    +!sub <- .print(a2).
    +!b <- .print(b1); .print(b2).
nothing else runs while an atomic plan waits => a1 | a2 | b1
    !a. !b.
    @l[atomic] +!a <- .print(a1); .wait(50); .print(a2).
    +!b <- .print(b1).
an atomic intention handles its own failure events => wait_timeout | handled | after
    !a.
    @l[atomic] +!a <- .wait({+x}, 100); .print(no).
    -!a[error(E)] <- .print(E); !b.
    @m[atomic] +!b <- !h; .print(after).
    +!h <- .fail_goal(h); .print(no).
    -!h <- .print(handled).
the intention of an ended atomic plan runs one more step first => a0 | s1 | s2 | a1 | b1 | a2 | b2 | b3
    !a. !b.
    +!a <- .print(a0); !s; .print(a1); .print(a2).
    @l[atomic] +!s <- .print(s1); .print(s2).
    +!b <- .print(b1); .print(b2); .print(b3).
a tail call ends the privilege of an atomic plan => 2 | 1 | z1 | z2 | b1 | z3 | b2 | z4 | b3
    !a(2). !b.
    @l[atomic] +!a(N) : N > 0 <- .print(N); !a(N-1).
    +!a(0) <- .print(z1); .print(z2); .print(z3); .print(z4).
    +!b <- .print(b1); .print(b2); .print(b3).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


def test_an_atomic_intention_finds_its_own_event_after_others():
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


def test_an_atomic_intention_continues_wherever_it_is():
    plans = "@a[atomic] +!a <- !b; .print(a). +!b <- !c; .print(b). @c[atomic] +!c <- .print(c). +!d(X) <- .print(X)."
    goals = [*(f"!d({number})." for number in range(3)), "!a.", *(f"!d({number})." for number in range(3, 6))]
    lines = printed(" ".join([*goals, plans]))
    assert "".join(lines).count("cba") == 1
