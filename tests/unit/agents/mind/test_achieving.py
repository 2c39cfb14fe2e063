"""Goals and plans that are checked when they end: ``achieves(Condition, Ms)``."""

import pytest
from recording_host import mind, outcome, programs, ran
from test_snapshot import printed as printed_by_stored_minds

from jacaros.agents.mind.rules.meta_events import observe_goals

pytestmark = pytest.mark.usefixtures("engines")


def test_the_failure_says_what_was_to_be_achieved_and_what_is_believed():
    host = ran(
        """
        docked(false). battery(12, discharging). near(dock).
        !g.
        +!g <- !dock[achieves(docked(true) & battery(_, charging))]; .print(after).
        +!dock <- .print(docking).
        -!dock[error(E), error_msg(M), not_achieved(C), found(Values)]
          <- .print(E, ": ", M);
             C = (docked(Wanted) & _);
             .print(Wanted, " ", Values).
        """
    )
    [first, told, values, after] = host.printed
    assert (first, values, after) == ("docking", "true [docked(false),battery(12,discharging)]", "after")
    assert told == "not_achieved: docked(true) & battery(_,charging) does not hold when the plan has ended"
    assert host.logged == []


GOALS = """
a goal whose condition holds is achieved => moved | after
    !g. +!g <- !h[achieves(at(home) & not held(_))]; .print(after). +!h <- .print(moved); +at(home).
a goal that nothing handles takes its intention along => moved
    !g. +!g <- !h[achieves(at(home))]; .print(never). +!h <- .print(moved).
the values that the plan found count => 3 | not_achieved
    at(3). !g.
    +!g <- !h(X)[achieves(at(X))]; .print(X); !h(Y)[achieves(at(Y) & Y > 3)].
    -!h(Y)[error(E)] <- .print(E).
    +!h(3).
a condition gives values to variables => 12
    battery(12). !g. +!g <- !h[achieves(battery(B) & B + 1 > 12)]; .print(B). +!h.
rules arithmetic and internal actions are conditions => after
    at(2). near(X) :- at(Y) & X - Y < 2.
    !g. +!g <- !h[achieves(near(3) & .member(a, [b, a]) & 2 * 3 == 6)]; .print(after). +!h.
beliefs of the rules of a condition are found => [at(2),at(7),home(9)]
    at(2). at(7). home(9). near :- at(X) & home(Y) & X == Y.
    !g. +!g <- !h[achieves(near)]. +!h. -!h[found(F)] <- .print(F).
separate initial and received goals are checked => a | b | c
    !a[achieves(ok)]. !g.
    +!g <- !!b(X)[achieves(at(X))]; .send(tester, achieve, c[achieves(ok)]).
    at(1).
    +!a. +!b(2). +!c.
    -!a[error(not_achieved)] <- .print(a).
    -!b(_)[error(not_achieved)] <- .print(b).
    -!c[error(not_achieved)] <- .print(c).
two conditions must both hold => not_achieved((a & b))
    a. !g. +!g <- !h[achieves(a), achieves(b)]. +!h. -!h[not_achieved(C)] <- .print(not_achieved(C)).
the answer of a failure plan is not tested => handled | after
    !g. +!g <- !h[achieves(ok)]; .print(after). +!h <- .fail. -!h <- .print(handled).
a failure plan that posts the goal again is tested through that goal => h | 1 | h | 2 | h | 3 | h | after
    n(0). !g.
    +!g <- !h[achieves(ok)]; .print(after).
    +!h <- .print(h).
    -!h : n(N) & N < 3 <- -+n(N + 1); .print(N + 1); !h[achieves(N == 2)].
a failure plan further down handles it => g not_achieved
    !g. +!g <- !h[achieves(ok)]. +!h. -!g[error(E)] <- .print("g ", E).
a goal without applicable plan fails as without a condition => no_applicable
    !g. +!g <- !h[achieves(ok)]. +!h : false. -!h[error(E)] <- .print(E).
a goal that its goal condition ends is tested => not_achieved | after | @0.15
    !g. !t. +!g <- !h[achieves(ok, 100)]; .print(after).
    +!h <: at(home) <- { .wait(900) } |&| { .wait(800); .print(never) }.
    -!h[error(E)] <- .print(E).
    +!t <- .wait(50); +at(home).
a goal that its goal condition ends has time => h | after | @0.1
    !g. !t. +!g <- !h[achieves(ok, 100)]; .print(after).
    +!h <: at(home) <- .print(h); !i; .print(never). +!i <- .wait(900).
    +!t <- .wait(50); +at(home); .wait(50); +ok.
a goal that is done is tested => 1 | 2 | after | @0.01
    n(1). !g. +!g <- !h[achieves(n(2)), retry(4, 10)]; .print(after).
    +!h <: false <- ?n(N); .print(N); .done; .print(never).
    ^!h[state(retried)] <- -+n(2).
a goal condition ends a goal whose sub-goal settles => h | left | @0.1
    !g. !t. +!g <: at(home) <- !h[achieves(ok, 9000)]; .print(never). +!h <- .print(h).
    +!t <- .wait(50); +at(home); .wait(50); if (not .intend(g)) { .print(left) }.
a goal that a sub-plan for an event ends is tested => h | not_achieved | after | @0.07
    !g. !t. +!g <- !h[achieves(ok, 20)]; .print(after).
    +!h <: false <- .print(h). { +e <- .done; .print(never). }
    -!h[error(E)] <- .print(E).
    +!t <- .wait(50); ++e.
a failure plan that is done is not tested => after
    !g. +!g <- !h[achieves(ok)]; .print(after). +!h <- .fail. -!h <- .done; .print(never).
a goal that another intention declares achieved is not tested => after | @0.05
    !g. !t. +!g <- !h[achieves(ok)]; .print(after). +!h <- .wait(900). +!t <- .wait(50); .succeed_goal(h).
a goal that ends by a tail call is tested => 3 | 2 | 1 | 0 | not_achieved
    !g. +!g <- !h(3)[achieves(ok)]. +!h(0) <- .print(0). +!h(N) <- .print(N); !h(N - 1). -!h(_)[error(E)] <- .print(E).
"""


PLANS = """
a plan is tested with the values that its variables have when it ends => h | not_achieved | at(3,2) | after
    at(3). !g.
    +!g <- !h(X); .print(after).
    @p[achieves(at(X, Y))] +!h(X) <- .print(h); X = 3; Y = 2.
    -!h(X)[error(E), not_achieved(C)] <- .print(E); .print(C).
a plan is cleaned up before it fails => cleaning | not_achieved | after | @0.1
    !g.
    +!g <- !h; .print(after).
    @p[achieves(ok), cleanup(tidy(X))] +!h <- X = kitchen.
    +!tidy(_) <- .print(cleaning); .wait(100).
    -!h[error(E)] <- .print(E).
a plan without steps is tested => not_achieved
    !g. +!g <- !h. @p[achieves(ok)] +!h. -!h[error(E)] <- .print(E).
the condition of the plan comes before that of the goal => not_achieved(b)
    !g. +!g <- !h[achieves(a)]. @p[achieves(b)] +!h. -!h[not_achieved(C)] <- .print(not_achieved(C)).
a failure plan is tested if its own label says so => handled | outer
    !g. +!g <- !h; .print(never). +!h <- .fail.
    @p[achieves(ok)] -!h <- .print(handled).
    -!g[error(not_achieved)] <- .print(outer).
sub plans are tested => not_achieved | after
    !g. +!g <- !h; .print(after). { @[achieves(ok)] +!h. -!h[error(E)] <- .print(E). }
a plan for a test goal is tested => not_achieved
    !g. +!g <- ?h(X). @[achieves(ok)] +?h(3). -?h(X)[error(E)] <- .print(E).
a plan for an event is tested => done
    !g. +!g <- ++e; .print(done). @p[achieves(ok)] +e.
every plan of a chain of tail calls is tested => 2 | 1 | 0 | not_achieved(at(2))
    at(1). at(0). !g. +!g <- !h(2).
    @p[achieves(at(N))] +!h(N) : N > 0 <- .print(N); !h(N - 1).
    @q[achieves(at(N))] +!h(N) <- .print(N).
    -!h(N)[not_achieved(C)] <- .print(not_achieved(C)).
"""


TIMES = """
a condition has time to come true => h | after2 | @0.6
    !g. !t.
    +!g <- !h[achieves(ok(X) & X > 1, 1000)]; .print(after, X).
    +!h <- .print(h).
    +!t <- .wait(300); +ok(1); .wait(300); -+ok(2).
a condition that does not come true in time fails => [ok(1)] | @0.6
    !g. !t.
    +!g <- !h[achieves(ok(2), 500)].
    +!h.
    -!h[found(F)] <- .print(F).
    +!t <- .wait(400); +ok(1); .wait(200); +ok(2).
goal and plan have their own times => after | @0.4
    !g. !t.
    +!g <- !h[achieves(b, 300)]; .print(after).
    @p[achieves(a, 300)] +!h.
    +!t <- .wait(200); +a; .wait(200); +b.
a goal that is not achieved is a failed attempt => 0 | 1 | 2 | after | @1.7
    n(0). !g.
    +!g <- !h[achieves(n(3), 100), retry(5, 500), within(60000)]; .print(after).
    +!h <- ?n(N); -+n(N + 1); .print(N).
    -!h <- .print(never).
the number of attempts is that of a goal that fails => 3not_achieved
    !g. +!g <- !h[achieves(ok), retry(2)]. +!h. -!h[attempts(N), error(E)] <- .print(N, E).
the deadline holds while a goal settles => deadline | @0.3
    !g. +!g <- !h[achieves(ok, 5000), within(300)]. +!h. -!h[error(E)] <- .print(E).
each period is tested; 2.5 s => 0 | 0 | 0 | @2.05
    n(0). !g.
    +!g <- !!h(X)[achieves(n(X) & X < 3, 100), every(1000)].
    +!h(X) <- ?n(X); -n(X); +n(X + 1); .print(X); .wait(50); -n(X + 1); +n(X).
    +!h(X).
each period fails; 2.5 s => not_achieved | not_achieved | not_achieved | @2.0
    !h[achieves(ok), every(1000)]. +!h. -!h[error(E)] <- .print(E).
while holds while a plan settles => tidy | condition_lost | @0.3
    safe. !g. !t.
    +!g <- !h.
    @p[while(safe), achieves(ok, 5000), cleanup(tidy)] +!h.
    -!h[error(E)] <- .print(E).
    +!tidy <- .print(tidy).
    +!t <- .wait(300); -safe.
a goal in a fork is tested with the variables of its branch => 1 | 2 | after | @0.01
    at(1). at(2). !g.
    +!g <- { !h(X)[achieves(at(X), 50)]; .print(X) } |&| { .wait(10); !h(Y)[achieves(at(Y))]; .print(Y) };
           .print(after).
    n(0).
    +!h(N) <- ?n(M); N = M + 1; -+n(N).
a goal that forks is tested with the variables of the last branch => after2 | @0.02
    at(2). !g.
    +!g <- !h(X)[achieves(at(X))]; .print(after, X).
    +!h(X) <- { .wait(10) } |&| { .wait(20); X = 2 }.
"""


@programs(GOALS + PLANS + TIMES)
def test_what_a_program_does(program, output, limit):
    host = ran(program, limit)
    assert outcome(host) == output
    assert limit < 60 or not (host.agent.waits.alarms or host.agent.waits.conditions)


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        (".drop_intention(h)", []),
        (".drop_desire(h)", []),
        (".succeed_goal(h)", ["after"]),
        (".fail_goal(h)", ["handled", "after"]),
        (".suspend(h); .wait(200); +ok; .wait(200); .print(resumed); .resume(h)", ["resumed", "after"]),
    ],
)
def test_a_goal_that_settles_is_a_goal_of_its_intention(step, expected):
    host = ran(
        f"""
        !g. !t.
        +!g <- !h[achieves(ok, 900)]; .print(after).
        +!h.
        -!h <- .print(handled).
        +!t <- .wait(100); {step}.
        """
    )
    assert host.printed == expected
    assert not any((host.agent.waits.conditions, host.agent.waits.alarms, host.agent.alive))


def test_a_condition_that_cannot_be_evaluated_does_not_hold():
    host = ran("ok :- ok. !g. +!g <- !h[achieves(ok, 5000)]. +!h. -!h[error(E)] <- .print(E).")
    assert host.printed == ["not_achieved"]
    [(level, told)] = host.logged
    assert level == "error"
    assert told.startswith("cannot evaluate the condition ok: ")


def test_a_condition_without_value_does_not_hold():
    host = ran("!g. +!g <- !h(X)[achieves(ok(6 div X), 20)]. +!h(0). -!h(_)[error(E)] <- .print(E).")
    assert host.printed == ["not_achieved"]
    assert "ArithmeticFault: integer division by zero" in host.logged[0][1]


def test_a_lost_goal_names_the_plan_that_ended():
    host = ran("docked(false).\n!g.\n+!g <- !h[achieves(docked(true))].\n+!h <- .print(h).")
    [(level, told)] = host.logged
    assert level == "warning"
    first, reason = told.splitlines()
    assert first.endswith(": not_achieved, docked(true) does not hold when the plan has ended (tester.asl:4)")
    assert reason == "  reason: not_achieved(docked(true)), found([docked(false)])"


def test_observers_see_that_a_goal_settles_and_fails():
    host = mind("!h[achieves(ok, 500)]. +!h.")
    seen = []
    observe_goals(host.agent, lambda state, goal, number, *_: seen.append((state, number)))
    host.run(seconds=10)
    assert [state for state, _ in seen] == [
        "executing",
        "waiting",
        "executing",
        "failed",
        "finished",
        "finished",
    ]
    assert len({number for _, number in seen}) == 1


STORED = """
a goal that is done and settles => h | after
    !g. !t. +!g <- !h[achieves(ok, 300)]; .print(after). +!h <: false <- .print(h); .done. +!t <- .wait(100); +ok.
a goal that settles and is tried again => h | h | 3
    !g. !t. +!g <- !h(X)[achieves(ok(X), 900), retry(2, 100)]; .print(X). +!h(X) <- .print(h).
    +!t <- .wait(1500); +ok(3).
a goal that fails => 2ok(2)[ok(1)]
    ok(1). !g. +!g <- !h(X)[achieves(ok(X), 300)]. +!h(2). -!h(X)[not_achieved(C), found(F)] <- .print(2, C, F).
a plan that settles and is cleaned up => h | tidy | not_achieved
    !g. !t. +!g <- !h. +!t <- .wait(100); +ok. +!tidy <- .print(tidy); .wait(10). -!h[error(E)] <- .print(E).
    @p[achieves(ok & Y > 1, 300), cleanup(tidy)] +!h <- Y = 1; .print(h).
"""


@programs(STORED)
def test_a_mind_that_is_stored_while_a_goal_settles_goes_on(program, output):
    assert printed_by_stored_minds(program, exchanged=False) == output
    assert printed_by_stored_minds(program, exchanged=True) == output
