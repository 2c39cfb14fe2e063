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
    assert printed("!s. +!s <- !g; .print(end). { -!g[error(E)] <- .print(E). } +!g <- .fail.") == [
        "ia_failed",
        "end",
    ]


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
