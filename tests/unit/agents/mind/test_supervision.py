"""Annotations of goals and plans that act: ``within``, ``retry``, ``every``, and ``while`` with ``cleanup``."""

import re

import pytest
from recording_host import mind, outcome, programs, ran
from test_snapshot import printed as printed_by_stored_minds

from jacaros.agents.mind.state.act import Completion

pytestmark = pytest.mark.usefixtures("engines")
NOW = ".nano_time(T); .print(T / 1000000000 - 1577836800)"

WITHIN = """
a sub-goal fails at its deadline => deadline 50, not achieved within 50 ms | after | @0.05
    !g.
    +!g <- !h[within(50)]; .print(after).
    +!h <- .wait(200); .print(never).
    -!h[error(E), error_msg(M), deadline(D)] <- .print(E, " ", D, ", ", M).
separate initial and received goals fail at their deadlines => b deadline | a deadline | c deadline | @0.04
    !a[within(30)]. !g.
    +!g <- !!b[within(20)]; .send(tester, achieve, c[within(40)]).
    +!a <- .wait(200).
    +!b <- .wait(200).
    +!c <- .wait(200).
    -!a[error(E)] <- .print(a, " ", E).
    -!b[error(E)] <- .print(b, " ", E).
    -!c[error(E)] <- .print(c, " ", E).
only the goal with the deadline fails => failed | achieved | @0.2
    // Another intention may pursue an equal goal.
    !g.
    +!g <- !!h(1)[within(50)]; !!h(1).
    +!h(X) <- .wait(200); .print(achieved).
    -!h(X) <- .print(failed).
a failure plan has no deadline => handled | after | @0.2
    !g.
    +!g <- !h[within(50)]; .print(after).
    +!h <- .fail.
    -!h <- .wait(200); .print(handled).
a deadline that has passed fails immediately => deadline
    !g. +!g <- T = 3 - 5; !h[within(T)]. +!h <- .wait(10). -!h[error(E)] <- .print(E).
the deadline of a goal holds for all branches of its fork => b | deadline | after | @0.05
    !g.
    +!g <- !h[within(50)]; .print(after).
    +!h <- { .wait(100); .print(a) } |&| { .wait(20); .print(b) }; .print(never).
    -!h[error(E)] <- .print(E).
a plan has a deadline => deadline30 | after | @0.03
    !g.
    +!g <- !h; .print(after).
    @p[within(30)] +!h <- .wait(200).
    -!h[error(E), deadline(D)] <- .print(E, D).
a goal with sub plans around it finds them => h | h | ia_failed | after
    !g.
    +!g <- !h[within(300), retry(1)]; .print(after). { +!h <- .print(h); .fail. -!h[error(E)] <- .print(E). }
a goal that ends in time leaves no deadline => after | @0.01
    !g. +!g <- !h[within(5000)]; .print(after). +!h <- .wait(10).
a deadline cancels an action => stopped | @0.5 | cancelled 1
    !g. +!g <- !h[within(500)]. +!h <- drive(5). -!h <- .print(stopped).
the deadline of a suspended goal keeps running => deadline | @0.5
    !g. !t.
    +!g <- !h[within(500)].
    +!h <- .wait(200); .print(never).
    -!h[error(E)] <- .print(E).
    +!t <- .wait(100); .suspend(h).
"""
RETRY = f"""
a goal is tried again with back-off => 0 | 0.5 | 1.5 | 3.5 | after | @3.5
    n(0). !g.
    +!g <- !h[retry(3, 500)]; .print(after).
    +!h <- {NOW}; ?n(N); -+n(N + 1); N > 2.
    -!h <- .print(never).
after the last attempt the goal fails with its own reason => try | try | try | blocked kitchen 3 | after | @0.03
    !g.
    +!g <- !h[retry(2, 10)]; .print(after).
    +!h <- .print(try); .fail(error(blocked), door(kitchen)).
    -!h[error(E), door(D), attempts(A)] <- .print(E, " ", D, " ", A).
a goal without applicable plan is tried again => h | @0.3
    !g. !t. +!g <- !h[retry(5, 100)]. +!h : ready <- .print(h). +!t <- .wait(250); +ready.
variables that a failed attempt has bound are free again => 2
    n(0). !g.
    +!g <- !h(X)[retry(3)]; .print(X).
    +!h(X) <- ?n(N); -+n(N + 1); X = N; N > 1.
a goal inside a fork is tried again => h | b | h | handled | after | @0.1
    !g.
    +!g <- !h[retry(1, 100)] |&| {{ .wait(30); .print(b) }}; .print(after).
    +!h <- .print(h); .fail.
    -!h <- .print(handled).
a fork inside a goal is tried again => b | b | 2 | after | @0.12
    !g.
    +!g <- !h[retry(1, 100)]; .print(after).
    +!h <- {{ .wait(10); .fail }} |&| {{ .wait(5); .print(b); .wait(50); .print(never) }}.
    -!h[attempts(A)] <- .print(A).
an atomic plan lets others run between its attempts => h0 | k | h1 | after | @0.1
    n(0). !g. !k.
    +!g <- !h[retry(1, 100)]; .print(after).
    @[atomic] +!h <- ?n(N); -+n(N + 1); .print(h, N); N > 0.
    +!k <- .wait(50); .print(k).
a deadline holds for all attempts => try | try | try | try | deadline | @1.0
    !g.
    +!g <- !h[within(1000), retry(20, 100)].
    +!h <- .print(try); .fail.
    -!h[error(E)] <- .print(E).
"""
EVERY = f"""
a named periodic goal ends between its periods => after
    !g. !end.
    +!g <- !scan[every(1000)]; .print(after).
    +!scan <- .print(scan).
    +!end <- .succeed_goal(scan).
a periodic goal ends in a pursuit => 0 | 1 | 2 | after | @2.0
    n(0). !g.
    +!g <- !scan[every(1000)]; .print(after).
    +!scan <- ?n(N); -+n(N + 1); .print(N); if (N == 2) {{ .succeed_goal(scan) }}; .wait(10).
a pursuit that fails without a plan ends the goal => 0 | 1 | 2 | constraint_failed | @2.0
    n(0). !g.
    +!g <- !scan[every(1000)]; .print(never).
    -!g[error(E)] <- .print(E).
    +!scan <- ?n(N); -+n(N + 1); .print(N); N < 2.
deadline and attempts hold for each period; 2.5 s => 0 | 1 | constraint_failed | 2 | deadline | 3 | deadline | @2.4
    n(0). !scan[every(1000), within(400), retry(1, 100)].
    +!scan <- ?n(N); -+n(N + 1); .print(N); N > 1; .wait(800).
    -!scan[error(E)] <- .print(E).
a period ends by done; 2.5 s => scan | scan | scan | @2.0
    !scan[every(1000)]. +!scan <- .print(scan); .done; .print(never).
a failure plan lets the goal continue; 2.5 s => failed | failed | failed | @2.0
    !scan[every(1000)]. +!scan <- .fail. -!scan <- .print(failed).
variables are new in each period; 0.025 s => 0 | 1 | 2 | @0.02
    n(0). !g. +!g <- !!scan(X)[every(10)]. +!scan(X) <- ?n(X); -+n(X + 1); .print(X).
periods count from start to start; 3.9 s => 0 | 1 | 2 | 3 | @3.3
    !scan[every(1000)]. +!scan <- {NOW}; .wait(300).
"""
WHILE_AND_CLEANUP = """
a plan stops when its condition is lost
=> condition_lost ok, the condition ok of the plan no longer holds | after | @0.1 | cancelled 1
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok)] +!h <- drive(5); .print(never).
    -!h[error(E), error_msg(M), condition_lost(C)] <- .print(E, " ", C, ", ", M).
    +!t <- .wait(100); -ok.
the clean up goal is pursued before the goal fails => parking | dock | condition_lost | after | @0.2 | cancelled 1
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok), cleanup(park(dock))] +!h <- drive(5).
    -!h[error(E)] <- .print(E).
    +!park(X) <- .print(parking); .wait(100); .print(X).
    +!t <- .wait(100); -ok; +ok.
a failing clean up still reports the lost condition => ia_failedok | after | @0.1 | cancelled 1
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok), cleanup(park)] +!h <- drive(5).
    -!h[error(E), condition_lost(C)] <- .print(E, C).
    +!park <- .fail.
    +!t <- .wait(100); -ok.
a condition sees the variables of the plan => t | hallcondition_lost | @0.1 | cancelled 1
    at(hall). !g. !t.
    +!g <- !clean(hall).
    @p[while(at(Room)), within(9000)] +!clean(Room) <- drive(5).
    -!clean(R)[error(E)] <- .print(R, E).
    +!t <- +at(kitchen); .wait(100); -at(kitchen); .print(t); -at(hall).
a plan whose condition does not hold makes no step => condition_lost
    !g. +!g <- !h. @p[while(ok)] +!h <- .print(never). -!h[error(E)] <- .print(E).
a plan that makes its own condition false makes no further step => condition_lost
    ok. !g. +!g <- !h. @[while(ok)] +!h <- -ok; .print(never). -!h[error(E)] <- .print(E).
the condition of a plan does not hold for its failure plan => handled | after | @0.1
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok)] +!h <- .fail.
    -!h <- .wait(100); .print(handled).
    +!t <- .wait(50); -ok.
a failure plan has guards of its own => deadline | @0.05
    !g.
    +!g <- !h.
    -!g[error(E)] <- .print(E).
    +!h <- .fail.
    @p[within(50)] -!h <- .wait(100).
sub plans have guards => condition_lost | after | @0.1 | cancelled 1
    ok. !g. !t.
    +!g <- !h; .print(after). { @[while(ok)] +!h <- drive(3). -!h[error(E)] <- .print(E). }
    +!t <- .wait(100); -ok.
the condition of a plan that has ended is not watched => after | @0.11
    ok. !g. !t.
    +!g <- !h; .wait(100); .print(after).
    @p[while(ok)] +!h <- .wait(10).
    +!t <- .wait(50); -ok.
a plan that has lost its condition is tried again => begin | begin | done | after | @6.1
    ok. !g. !t.
    +!g <- !h[retry(2, 1000)]; .print(after).
    @p[while(ok)] +!h <- .print(begin); .wait(5000); .print(done).
    +!t <- .wait(100); -ok; .wait(500); +ok.
a condition holds for all branches of a fork => condition_lost | after | @0.1 | cancelled 1 | cancelled 2
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok)] +!h <- drive(5) |&| turn(90).
    -!h[error(E)] <- .print(E).
    +!t <- .wait(100); -ok.
a plan term that is added has guards => parked | condition_lost | @0.1 | cancelled 1
    ok. !g. !t.
    +!g <- .add_plan({ @p[while(ok), cleanup(park)] +!h <- drive(5) }); !h.
    -!h[error(E)] <- .print(E).
    +!park <- .print(parked).
    +!t <- .wait(100); -ok.
a plan text that is added has guards => parked | condition_lost | @0.1 | cancelled 1
    ok. !g. !t.
    +!g <- .add_plan("@p[while(ok), cleanup(park)] +!h <- drive(5)."); !h.
    -!h[error(E)] <- .print(E).
    +!park <- .print(parked).
    +!t <- .wait(100); -ok.
"""


@programs(WITHIN + RETRY + EVERY + WHILE_AND_CLEANUP)
def test_what_a_program_does(program, output, limit):
    host = ran(program, limit)
    assert outcome(host) == output
    assert limit < 60 or not (host.agent.waits.alarms or host.agent.waits.conditions)


def test_a_lost_goal_reports_the_number_of_attempts():
    host = ran("!g. +!g <- !h[retry(2)]. +!h <- 2 > 20.")
    [(level, told)] = host.logged
    assert level == "warning"
    assert told.splitlines()[1:] == ["  step: 2 > 20, for !h, !g", "  reason: attempts(3)"]


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        (".drop_intention(h)", []),
        (".drop_desire(h)", []),
        (".succeed_goal(h)", ["after"]),
        (".fail_goal(h)", ["handled", "after"]),
    ],
)
def test_a_goal_between_two_attempts_is_dropped_succeeds_and_fails(step, expected):
    host = ran(
        f"""
        !g. !t.
        +!g <- !h[retry(3, 1000)]; .print(after).
        +!h <- .fail.
        -!h <- .print(handled).
        +!t <- .wait(500); {step}.
        """
    )
    assert outcome(host) == [*expected, "@0.5"]
    assert not host.agent.alive


def test_missed_periods_are_reported_once_and_warned_of_seldom():
    host = ran(
        f"""
        n(0). !scan[every(1000)].
        +!scan <- {NOW}; ?n(N); -+n(N + 1); .wait(N * 1500).
        ^!scan[state(missed)[periods(P)]] <- .print(missed, P).
        """,
        9.0,
    )
    assert host.printed == ["0", "1", "missed1", "3", "missed2", "6"]
    assert host.logged == [("warning", "goal !scan has missed a period of 1000 ms: it takes longer")]
    host = ran("!scan[every(100)]. +!scan <- .wait(150).", 40.0)
    counts = [int(found[1]) if (found := re.search(r"(\d+) periods", text)) else 1 for _, text in host.logged]
    assert counts == [1, 10, 100]


@pytest.mark.parametrize("drop", [".drop_intention(scan)", ".drop_desire(scan)"])
def test_a_periodic_goal_ends_when_it_is_dropped(drop):
    host = ran(f"!g. +!g <- !!scan[every(1000)]; .wait(2500); {drop}. +!scan <- .print(scan).")
    assert outcome(host) == ["scan", "scan", "scan", "@2.5"]
    assert not host.agent.alive
    assert not host.agent.waits.alarms


@pytest.mark.parametrize("moment", [2100, 2500], ids=["in a pursuit", "between two"])
@pytest.mark.parametrize(
    ("end", "told"), [(".succeed_goal(scan)", []), (".fail_goal(scan)", ["failed"])], ids=["succeed", "fail"]
)
def test_a_periodic_goal_that_is_named_ends_for_good_and_its_plan_continues(moment, end, told):
    host = ran(
        f"""
        !g. !end.
        +!g <- !scan[every(1000), retry(2), within(900)]; .print(after).
        +!scan <- .print(scan); .wait(300).
        -!scan <- .print(failed).
        +!end <- .wait({moment}); {end}.
        """
    )
    assert outcome(host) == [*["scan"] * 3, *told, "after", f"@{moment / 1000}"]
    assert not host.agent.alive
    assert not host.agent.waits.alarms


def test_the_periods_of_a_suspended_goal_are_missed_once():
    host = ran(
        f"""
        !scan[every(1000)]. !t.
        +!scan <- {NOW}.
        +!t <- .wait(1500); .suspend(scan); .wait(4750); .resume(scan); .wait(2000); .drop_desire(scan).
        ^!scan[state(missed)[periods(P)]] <- .print(missed, P).
        """
    )
    assert [line[:7] for line in host.printed] == ["0", "1", "missed4", host.printed[3][:7], "7", "8"]
    assert 6.24 < float(host.printed[3]) < 6.26


@pytest.mark.parametrize(
    "condition",
    ["battery(B) & B > 20", "full_enough", "not (battery(B) & B <= 20)", "limit(L) & battery(B) & B > L"],
)
def test_conditions_are_formulas_of_beliefs_and_rules(condition):
    program = f"""
        battery(90). limit(20). full_enough :- battery(B) & B > 20.
        !g. !t.
        +!g <- !h(1).
        @p[while({condition})] +!h(X) <- drive(5).
        -!h(X)[error(E)] <- .print(X, E).
        +!t <- .wait(100); -+battery(30); .print(low); .wait(100); -+battery(10).
        """
    assert ran(program).printed == ["low", "1condition_lost"]


@pytest.mark.parametrize("end", [".drop_intention(h)", ".fail_goal(h)", ".succeed_goal(h)"])
def test_a_plan_ended_from_outside_leaves_nothing_behind(end):
    host = ran(
        f"ok. !g. !t. +!g <- !h. @[while(ok), within(9000)] +!h <- drive(5). -!h. +!t <- .wait(50); {end}."
    )
    assert outcome(host) == ["@0.05", "cancelled 1"]
    assert not any((host.agent.waits.conditions, host.agent.waits.alarms, host.agent.alive))


def test_a_plan_for_an_event_has_guards():
    host = ran("ok. !t. @p[while(ok)] +e <- drive(5). +!t <- ++e; .wait(100); -ok.")
    assert "the plan for +e failed" in host.logged[0][1]
    assert host.cancelled == [1]


def test_a_plan_with_guards_keeps_what_it_needs_until_it_ends():
    program = "ok. !h. @p[needs(base), while(ok), within(9000)] +!h <- .wait(100); .print(done)."
    host = mind(program, complete=lambda act: Completion(True))
    host.agent.run(50)
    assert host.cancelled == []
    host.run()
    assert outcome(host) == ["done", "@0.1", "cancelled 1"]


STORED = f"""
attempts => 0 | 1 | 2 | 3 | after
    n(0). !g. +!g <- !h[retry(3, 500)]; .print(after). +!h <- ?n(N); -+n(N + 1); .print(N); N > 2.
a deadline => deadline300 | after
    !g. +!g <- !h[within(300)]; .print(after). +!h <- .wait(900). -!h[error(E), deadline(D)] <- .print(E, D).
periods => 0 | 1 | 2 | 3 | missed1 | 5 | missed1 | 7
    n(0). !g. +!g <- !!h[every(1000)]; .wait(9000); .drop_intention(h).
    +!h <- ?n(N); -+n(N + 1); {NOW}; .wait(N * 500). ^!h[state(missed)[periods(P)]] <- .print(missed, P).
a condition and a clean-up => begin | t | parking | parked | condition_lostok | after
    ok. !g. !t. +!g <- !h; .print(after). @p[while(ok), cleanup(park)] +!h <- .print(begin); .wait(5000).
    +!t <- .wait(100); -ok; .print(t). -!h[error(E), condition_lost(C)] <- .print(E, C).
    +!park <- .print(parking); .wait(100); .print(parked).
a fork with a condition and attempts => begin | a | t | begin | a | b | begin | a | b | deadline | after
    ok. b(1). !g. !t. +!g <- !h[retry(3, 100), within(2000)]; .print(after).
    @p[while(ok & b(X) & X > 0), within(700)] +!h
      <- .print(begin); {{ .wait(300); .print(a) }} |&| {{ .wait(400); .print(b) }}; .wait(4000).
    +!t <- .wait(350); -ok; .wait(50); .print(t); +ok. -!h[error(E)] <- .print(E).
"""


@programs(STORED)
def test_a_mind_that_is_restored_after_each_cycle_prints_the_same(program, output):
    assert printed_by_stored_minds(program, exchanged=False) == output
    assert printed_by_stored_minds(program, exchanged=True) == output
