"""Goal conditions and plans inside plans."""

from recording_host import mind, printed, programs

PROGRAMS = """
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
"""


@programs(PROGRAMS)
def test_what_a_program_prints(program, output):
    assert printed(program) == output


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
