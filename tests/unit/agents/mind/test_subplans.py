"""Goal conditions and plans inside plans."""

from recording_host import mind, printed


def test_a_goal_condition_ends_a_goal_wherever_its_plan_is() -> None:
    assert printed(
        """
        !s. !t.
        +!s <- !g(2); .print(after).
        +!g(X) <: n(X) <- !wait; .print(bad).
        +!wait <- .wait(1000); .print(bad).
        +!t <- .wait(10); +n(1); .wait(10); .print(now); +n(2); .wait(10).
        """
    ) == ["now", "after"]


def test_a_goal_whose_condition_never_holds_ends_with_done() -> None:
    assert printed(
        """
        !s. !t.
        +!s <- !g; .print(after).
        +!g <: false <- .print(g). { +e <- .print(e); .done. }
        +!t <- .wait(10); ++e; .wait(10); .print(t).
        """
    ) == ["g", "e", "after", "t"]


def test_sub_plans_see_the_variables_of_the_plans_around_them() -> None:
    assert printed(
        """
        !s.
        +!s <- !g(1, Y); .print(Y).
        +!g(X, Y) : Z = X + 1 <- !h(3, Y). {
          +!h(V, W) <- !k(W). {
            +!k(R) <- R = [X, Z, V].
          }
        }
        """
    ) == ["[1,2,3]"]


def test_sub_plans_are_for_their_plan_only() -> None:
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


def test_a_failure_handler_may_be_a_sub_plan() -> None:
    assert printed("!s. +!s <- !g; .print(end). { -!g[error(E)] <- .print(E). +!g <- .fail. }") == [
        "ia_failed",
        "end",
    ]


def test_a_sub_plan_handles_no_failure_of_a_plan_outside_its_scope() -> None:
    assert printed("!s. +!s <- !g; .print(end). { -!g <- .print(no). } +!g <- .fail.") == []


def test_the_innermost_scope_is_searched_for_handlers_of_the_whole_stack_first() -> None:
    outside = "-!sub <- .print(outside)."
    inside = "+!sub <- .fail. -!g <- .print(inside)."
    assert printed(f"!g. +!g <- !sub. {{ {inside} }} {outside}") == ["inside"]


def test_outside_the_innermost_scope_the_bottom_goal_comes_first() -> None:
    text = "!s. +!s <- !g. +!g <- !sub. { +!sub <- .fail. } -!g <- .print(middle). -!s <- .print(bottom)."
    assert printed(text) == ["bottom"]
    assert printed(text.replace("-!s <- .print(bottom).", "")) == ["middle"]


def test_a_failing_handler_of_the_bottom_goal_ends_the_intention_in_a_scope_too() -> None:
    assert printed("!s. +!s <- !g. { +!g <- .fail. } -!s <- .print(once); !g. { +!g <- .fail. }") == ["once"]


def test_a_test_without_a_plan_fails_as_a_test_beside_sub_plans() -> None:
    text = "!s. +!s <- ?q(X). { +!g. } -!s[error(E)] <- .print(E)."
    assert printed(text) == ["test_goal_failed"]
    assert printed("!s. +!s <- ?q(X); .print(X). { +?q(1). }") == ["1"]


def test_every_goal_with_a_sub_plan_reacts_to_an_event_and_the_library_too() -> None:
    lines = printed(
        """
        !g(1). !g(2). !t.
        +!g(X) <- .wait(50). { +e <- .print(e(X)). }
        +!t <- .wait(10); ++e.
        +e <- .print(root).
        """
    )
    assert lines == ["e(1)", "e(2)", "root"]
