"""Which plan is taken: rules for ``select__option``, all answers of a context, and plans compiled again."""

from recording_host import mind


def test_rules_filter_the_applicable_plans() -> None:
    host = mind("""
        p(1). p(2). p(3).
        select__option({ +!g }, _, { @L +!g : C <- B }, Values) :- L = second[_|_] & .member(map('Y', 2), Values).
        select__option({ +!begin }, _, _, _).
        !begin.
        +!begin <- !g.
        @first +!g : p(Y) <- .print(first, Y).
        @second[all_unifs] +!g : p(Y) <- .print(second, Y).
    """)
    host.run()
    assert host.printed == ["second2"]


def test_without_all_unifs_only_the_first_answer_of_a_context_is_an_option() -> None:
    host = mind("""
        p(1). p(2).
        select__option({ +!g(N)[source(S)] }, _, _, V) :- S = self & .member(map('Y', N), V).
        !g(1). !g(2).
        +!g(N) : p(Y) <- .print(Y).
        -!g(N)[error(E)] <- .print(E).
        select__option({ -!g(_) }, _, _, _).
    """)
    host.run()
    assert host.printed == ["1", "no_option"]


def test_the_answers_do_not_multiply_without_a_filter() -> None:
    host = mind("p(1). p(2). !g. @l[all_unifs] +!g : p(X) <- .print(X).")
    host.run()
    assert host.printed == ["1"]


def test_the_filter_gets_the_intention() -> None:
    host = mind("""
        select__option(_, I, { @L +!g : C <- B }, _) :- I > 0 & I < 100.
        select__option(_, _, { @L +!begin : C <- B }, _).
        !begin. +!begin <- !g. +!g <- .print(done).
    """)
    host.run()
    assert host.printed == ["done"]


def test_a_removed_filter_does_not_filter() -> None:
    host = mind("""
        select__option(T, I, P, U) :- open.
        open.
        !begin. +!begin <- -open; !!g(1); .wait(10); -{ select__option(T, I, P, U) :- open }; !g(2).
        +!g(X) <- .print(X).
    """)
    host.run()
    assert host.printed == ["2"]


def test_a_plan_for_any_goal_fails_with_its_reason_in_several_intentions() -> None:
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


def test_a_plan_whose_event_gets_more_plans_still_fails_with_its_reason() -> None:
    host = mind("""
        !r(2).
        +!r(N) : N > 0 <- .add_plan("+!r(77) <- true."); !r(N - 1); .wait(5); .fail.
        +!r(0).
        -!r(N)[error(E), code_line(L)] <- .print(r(N), E, L).
    """)
    host.run()
    assert host.printed == ["r(1)ia_failed3", "r(2)ia_failed3"]
