"""Which plan is taken: rules for ``select__option``, all answers of a context, and plans compiled again."""

from recording_host import mind, printed, programs

PROGRAMS = """
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
