"""Forks, sub-plans, atomic plans, and which of several plans is selected."""

import pytest
from recording_host import mind, printed, programs

from jacaros.agents.mind.rules.cycle import event_of, is_ready
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, atom, functor

PROGRAMS = """
bindings made before a fork are shared and those of branches are not => f(1) | f(1) | b
    !s.
    +!s <- P = f(A); A = 1; (X = a; .print(P)) |&| (X = b; .wait(10); .print(P)); .print(X).
a variable that is free at the fork is bound by each branch for itself => f(1) | f(2)
    !s. +!s <- P = f(A); (A = 1; .print(P)) |&| (A = 2; .print(P)).
a failing branch with a handler of its own does not fail the plan => b | handled | joined
    !s.
    +!s <- !a |&| !b; .print(joined).
    +!a <- .fail.
    -!a <- .print(handled).
    +!b <- .print(b).
when all branches of an or fail the plan fails => ia_failed
    !s. +!s <- .fail ||| .fail; .print(bad). -!s[error(E)] <- .print(E).
a fork inside a loop is made anew each time => a1 | b1 | a2 | b2 | end
    !s. +!s <- for (.range(I, 1, 2)) { .print(a, I) |&| .print(b, I) }; .print(end).
a loop around a fork continues in the surviving branch => a1 | round(1) | a2 | round(2) | a3 | round(3) | end
    !s.
    +!s <- for (.member(X, [1,2,3])) { (.print(a, X) ||| .wait(50)); .print(round(X)) }; .print(end).
a body in curly brackets is a step and a branch => second | first | third | fourth | fifth
    !go.
    +!go
      <- { .wait(200); .print("first") } |&| { .wait(100); .print("second") };
         { .print("third"); { .print("fourth") } };
         X = { .print("never") };
         { .print("fifth") }.
a goal condition ends a goal wherever its plan is => now | after
    !s. !t.
    +!s <- !g(2); .print(after).
    +!g(X) <: n(X) <- !wait; .print(bad).
    +!wait <- .wait(1000); .print(bad).
    +!t <- .wait(10); +n(1); .wait(10); .print(now); +n(2); .wait(10).
a goal whose condition never holds ends with done => g | e | after | t
    !s. !t.
    +!s <- !g; .print(after).
    +!g <: false <- .print(g). { +e <- .print(e); .done. }
    +!t <- .wait(10); ++e; .wait(10); .print(t).
sub plans see the variables of the plans around them => [1,2,3]
    !s.
    +!s <- !g(1, Y); .print(Y).
    +!g(X, Y) : Z = X + 1 <- !h(3, Y). {
      +!h(V, W) <- !k(W). {
        +!k(R) <- R = [X, Z, V].
      }
    }
a failure handler may be a sub plan => ia_failed | end
    !s. +!s <- !g; .print(end). { -!g[error(E)] <- .print(E). +!g <- .fail. }
a sub plan handles no failure of a plan outside its scope =>
    !s. +!s <- !g; .print(end). { -!g <- .print(no). } +!g <- .fail.
a failing handler of the bottom goal ends the intention in a scope too => once
    !s. +!s <- !g. { +!g <- .fail. } -!s <- .print(once); !g. { +!g <- .fail. }
every goal with a sub plan reacts to an event and the library too => e(1) | e(2) | root
    !g(1). !g(2). !t.
    +!g(X) <- .wait(50). { +e <- .print(e(X)). }
    +!t <- .wait(10); ++e.
    +e <- .print(root).
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
rules filter the applicable plans => second2
    p(1). p(2). p(3).
    select__option({ +!g }, _, { @L +!g : C <- B }, Values) :- L = second[_|_] & .member(map('Y', 2), Values).
    select__option({ +!begin }, _, _, _).
    !begin.
    +!begin <- !g.
    @first +!g : p(Y) <- .print(first, Y).
    @second[all_unifs] +!g : p(Y) <- .print(second, Y).
without all unifs only the first answer of a context is an option => 1 | no_option
    p(1). p(2).
    select__option({ +!g(N)[source(S)] }, _, _, V) :- S = self & .member(map('Y', N), V).
    !g(1). !g(2).
    +!g(N) : p(Y) <- .print(Y).
    -!g(N)[error(E)] <- .print(E).
    select__option({ -!g(_) }, _, _, _).
the answers do not multiply without a filter => 1
    p(1). p(2). !g. @l[all_unifs] +!g : p(X) <- .print(X).
the filter gets the intention => done
    select__option(_, I, { @L +!g : C <- B }, _) :- I > 0 & I < 100.
    select__option(_, _, { @L +!begin : C <- B }, _).
    !begin. +!begin <- !g. +!g <- .print(done).
a removed filter does not filter => 2
    select__option(T, I, P, U) :- open.
    open.
    !begin. +!begin <- -open; !!g(1); .wait(10); -{ select__option(T, I, P, U) :- open }; !g(2).
    +!g(X) <- .print(X).
a plan whose event gets more plans still fails with its reason => r(1)ia_failed2 | r(2)ia_failed2
    !r(2).
    +!r(N) : N > 0 <- .add_plan("+!r(77) <- true."); !r(N - 1); .wait(5); .fail.
    +!r(0).
    -!r(N)[error(E), code_line(L)] <- .print(r(N), E, L).
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


@pytest.mark.parametrize("plain", ["", "1"])
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("for (p(X)) { Y = X; .print(Y) }", ["1", "2"]),
        ("for (p(X)) { { .wait(9); Y = X } |&| { .print(b) }; .print(Y) }", ["b", "1", "b", "2"]),
        ("for (p(X)) { Y = X; { .print(Y) } |&| { .print(b) } }", ["1", "b", "2", "b"]),
        ("Z = f(Y); for (p(X)) { { Y = X; .print(Z) } ||| { .wait(50) } }", ["f(1)", "f(2)"]),
        ("while (n(N) & N > 0) { { Y = N; .print(Y) } |&| { .print(b) }; -+n(N - 1) }", ["b", "2", "b", "1"]),
    ],
)
def test_a_variable_that_a_round_binds_is_free_in_the_next_one(body, expected, plain, monkeypatch):
    monkeypatch.setenv("JACAROS_PLAIN", plain)
    program = f"p(1). p(2). n(2). !s. +!s <- !t(Y). +!t(Y) <- {body}; .print(end, Y)."
    assert [line.split("<")[0] for line in printed(program)] == [*expected, "endY"]


def test_branches_share_the_answers_of_the_loop_around_them(calls_of):
    def work(rounds: int) -> int:
        program = f"!s. +!s <- for (.range(I, 1, {rounds})) {{ X = I |&| Y = I }}; .print(end)."
        return calls_of(lambda: printed(program))

    least = work(1)
    assert work(400) - least < 5 * (work(100) - least)


@pytest.mark.parametrize("operator", ["|&|", "|||"])
def test_a_goal_that_is_ended_while_it_is_forked_ends_once(operator):
    program = """
        !m. !k.
        +!m <- !a; .print(once).
        +!a <- !b OPERATOR !c OPERATOR { !d |&| !b }; .print(never).
        -!a <- .print(failed).
        +!b <- .wait(100); .print(never).
        +!c <- .wait(100); .print(never).
        +!d <- .wait(50); .print(never).
        +!k <- .wait(10); .END(a).
        """.replace("OPERATOR", operator)
    assert printed(program.replace("END", "succeed_goal")) == ["once"]
    assert printed(program.replace("END", "fail_goal")) == ["failed", "once"]
    assert printed(program.replace("+!a <-", "+!a <: done <-").replace(".END(a)", "+done")) == ["once"]


def test_sub_plans_are_for_their_plan_only():
    host = mind(
        """
        !s.
        +!s <- !g; !h.
        +!g <- !h. { +!h <- .print(inner). }
        """
    )
    host.run()
    assert host.printed == ["inner"]
    assert "no_relevant" in host.logged[0][1]


def test_handlers_are_searched_from_the_innermost_scope():
    outside = "-!sub <- .print(outside)."
    inside = "+!sub <- .fail. -!g <- .print(inside)."
    assert printed(f"!g. +!g <- !sub. {{ {inside} }} {outside}") == ["inside"]
    text = "!s. +!s <- !g. +!g <- !sub. { +!sub <- .fail. } -!g <- .print(middle). -!s <- .print(bottom)."
    assert printed(text) == ["bottom"]
    assert printed(text.replace("-!s <- .print(bottom).", "")) == ["middle"]
    text = "!s. +!s <- ?q(X). { +!g. } -!s[error(E)] <- .print(E)."
    assert printed(text) == ["test_goal_failed"]
    assert printed("!s. +!s <- ?q(X); .print(X). { +?q(1). }") == ["1"]


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


def test_a_plan_for_any_goal_fails_with_its_reason_in_several_intentions():
    host = mind("""
        !a. !b.
        +!X <- .wait(10); .print(in(X)); .fail.
        -!X[error(E)] <- .print(failed(X, E)).
    """)
    host.run()
    assert sorted(host.printed) == [
        "failed(a,ia_failed)",
        "failed(b,ia_failed)",
        "in(a[source(self)])",
        "in(b[source(self)])",
    ]
