"""What ends later, crossed with clocks that are set back and with minds that are stored between any two cycles."""

import pytest
from recording_host import RecordingHost, mind
from test_snapshot import printed, restored

pytestmark = pytest.mark.usefixtures("engines")

PENDING = {
    "time": "!s. +!s <- .wait(300); .print(waited).",
    "event with a time limit": "!s. +!s <- .wait({+e(X)}, 100, T); .print(X, T); ?q. -!s[error(E)] <- .print(E).",
    "condition that becomes true": "!s. !t. +!s <- .wait(q(X) & X > 1, 900, T); .print(X, T). +!t <- .wait(50); +q(3).",
    "condition with a time limit": "!s. +!s <- .wait(q(X), 40); .print(never). -!s[error(E)] <- .print(E).",
    "deadline": "!s. +!s <- !a[within(300)]; .print(never). +!a <- .wait(900). -!s[error(E)] <- .print(E).",
    "deadline of a plan": "!s. @p[within(30)] +!s <- .wait(90); .print(never). -!s[error(E)] <- .print(E).",
    "attempts": "n(0). !s. +!s <- !a[retry(3, 20)]; .print(done). +!a : n(N) <- -+n(N+1); .print(N); .wait(5); N > 1.",
    "a deadline for all attempts": """
        n(0). !s. +!s <- !a[within(70), retry(9, 20)]; .print(never). -!s[error(E)] <- .print(E).
        +!a : n(N) <- -+n(N+1); .print(N); .wait(5); N > 9.
        """,
    "periods": """
        n(0). !s. +!s <- !!a[every(50)]; .wait(n(4)); .succeed_goal(a); .print(done).
        +!a : n(N) <- .print(N); .wait(N * 30); -+n(N+1).
        """,
    "condition of a plan": """
        ok(1). !s. !t. +!t <- .wait(40); -ok(1). -!s[error(E)] <- .print(E).
        @p[while(ok(X)), cleanup(c(Y))] +!s <- Y = 7; .wait(900). +!c(Y) <- .wait(20); .print(cleaned, Y).
        """,
    "goal condition": """
        !s. !t. +!s <: ok(X) <- .wait(900); .print(never). ^!s[state(finished)] <- .print(over).
        +!t <- .wait(40); +ok(1).
        """,
    "goal that is suspended": """
        !s. !t. +!s <- !g; .print(after). +!g <- .wait(30); .print(g).
        +!t <- .suspend(g); .wait(90); .resume(g).
        """,
    "fork": """
        !s. +!s <- { !g(1) |&| !g(2) }; .print(joined); { !g(1) ||| !g(2) }; .print(raced).
        +!g(N) <- .wait(N*40); .print(N).
        """,
    "sub-plans": """
        !s. !t. +!s <- X = 5; .wait(60); !in(1); !last(2). {
            +!in(Y) <- .wait(20); .print(in, X, Y).
            +e(Y) <- .wait(5); .print(seen, X, Y).
        }
        +!last(Z) <- !in(Z); .wait(30); .print(last).
        +!t <- .wait(10); +e(1); .wait(80); ++e(2).
        """,
    "atomic plan": "!s. !t. @a[atomic] +!s <- .print(a); !g; .print(b). +!g <- .print(g). +!t <- .print(t).",
    "question": "!s. +!s <- .send(friend, askOne, p(_), A, 40); .print(A).",
    "event": """
        !s. +!s <- .at("now +20 ms", {+!g(1)}); .at("now +40 ms", {+e(2)}).
        +!g(X) <- .print(X). +e(X) <- .print(e, X).
        """,
    "for": "p(1). p(2). !s. +!s <- for (p(X)) { .wait(200); .print(X) }; .print(done).",
    "results": "!s. +!s <- !a(X, Y); .print(X, Y). +!a(X, Y) <- X = Y; .wait(100); Y = 3.",
    "added plan": "!s. +!s <- .add_plan({+!n(X) : X > 0 <- .wait(100); .print(X)}); !n(2); .print(end).",
    "random": "!s. +!s <- +r(1); .wait(100); -+r(2)[x]; ?r(X)[x]; .print(X); .random(R); .print(R).",
    "while": "k(0). !s. +!s <- while (k(N) & N < 3) { .wait(10); M = N; .print(M); -+k(N+1) }; .print(end).",
}


@pytest.mark.parametrize("program", PENDING.values(), ids=PENDING)
def test_what_is_pending_survives_storage_after_each_cycle(program):
    expected = printed(program, exchanged=False)
    assert expected
    assert "never" not in expected
    assert printed(program, exchanged=True) == expected


def set_back(host: RecordingHost, seconds: float) -> None:
    """Set the clock of a host back. Its timers ring when they would have rung, as those of a computer do."""
    host.time -= seconds
    host._timers = [(moment - seconds, *rest) for moment, *rest in host._timers]


def test_the_elapsed_time_of_a_wait_is_that_which_has_passed():
    host = mind("!s. +!s <- .wait({+e}, 60000, T); .print(T). !t. +!t <- .wait(100); +e.")
    host.run(seconds=0.05)
    set_back(host, 3600)
    host.run(seconds=5)
    assert host.printed == ["100"]


def test_a_periodic_goal_continues_in_a_new_period():
    host = mind("n(0). !s. +!s <- !!a[every(1000)]. +!a : n(N) <- -+n(N+1); .print(N).")
    host.run(seconds=2.5)
    assert host.printed == ["0", "1", "2"]
    set_back(host, 3600)
    host.run(seconds=3.9)
    assert host.printed == ["0", "1", "2", "3", "4", "5"]
    assert host.logged == []


@pytest.mark.parametrize(
    ("by", "then"), [(-3600.0, 1.0), (-0.2, 1.0), (0.0, 1.0), (0.3, 0.7), (0.999, 0.001), (3600.0, 0.0)]
)
def test_a_stored_wait_ends_with_its_remaining_time(by, then):
    """Time that has passed meanwhile counts; a clock that was set back does not make it longer."""
    host = mind("!s. +!s <- .wait(1000); .print(waited).")
    host.run(seconds=0)
    restored(host, later=by)
    began = host.time
    host.run(seconds=10)
    assert host.printed == ["waited"]
    assert round(host.time - began, 3) == then


@pytest.mark.parametrize("by", [-3600.0, 0.0])
def test_a_stored_period_goes_on_whatever_the_clock_says(by):
    host = mind("n(0). !s. +!s <- !!a[every(1000)]. +!a : n(N) <- -+n(N+1); .print(N).")
    host.run(seconds=1.5)
    restored(host, later=by)
    host.run(seconds=2.9)
    assert host.printed == ["0", "1", "2", "3"]


def test_a_restored_mind_answers_as_the_old_one():
    host = mind(
        "!s. +!s <- .wait(10); .findall(X, p(X)[a], L); .print(L). p(1)[a]. p(2)[b,a]. p(X)[c] :- q(X). p(3)[a]."
    )
    host.run(seconds=0)
    restored(host)
    host.run(seconds=1)
    assert host.printed == ["[1,2,3]"]
