"""Annotations of goals and plans that act: ``within``, ``retry``, ``every``, and ``while`` with ``cleanup``."""

import re

import pytest
from recording_host import RecordingHost, mind, programs
from test_snapshot import printed as printed_by_stored_minds

from jacaros.agents.mind.state.act import Completion


@pytest.fixture(params=["fast", "plain"], autouse=True)
def engine(request, monkeypatch):
    """Each test runs with generated code, and by the rules alone."""
    if request.param == "plain":
        monkeypatch.setenv("JACAROS_PLAIN", "1")
    else:
        monkeypatch.delenv("JACAROS_PLAIN", raising=False)


def ran(program: str, seconds: float = 60.0, **arguments: object) -> RecordingHost:
    host = mind(program, **arguments)
    host.run(seconds=seconds)
    return host


def printed(program: str, seconds: float = 60.0) -> list[str]:
    return ran(program, seconds).printed


def elapsed(host: RecordingHost) -> float:
    return round(host.time - 1_577_836_800.0, 3)


NOW = ".nano_time(T); .print(T / 1000000000 - 1577836800)"

# --- within ------------------------------------------------------------------------------------------------


def test_a_sub_goal_fails_at_its_deadline():
    host = ran(
        """
        !g.
        +!g <- !h[within(50)]; .print(after).
        +!h <- .wait(200); .print(never).
        -!h[error(E), error_msg(M), deadline(D)] <- .print(E, " ", D, ", ", M).
        """
    )
    assert host.printed == ["deadline 50, not achieved within 50 ms", "after"]
    assert elapsed(host) == 0.05


WITHIN_PROGRAMS = """
separate initial and received goals fail at their deadlines => b deadline | a deadline | c deadline
    !a[within(30)]. !g.
    +!g <- !!b[within(20)]; .send(tester, achieve, c[within(40)]).
    +!a <- .wait(200).
    +!b <- .wait(200).
    +!c <- .wait(200).
    -!a[error(E)] <- .print(a, " ", E).
    -!b[error(E)] <- .print(b, " ", E).
    -!c[error(E)] <- .print(c, " ", E).
only the goal with the deadline fails => failed | achieved
    // Another intention may pursue an equal goal.
    !g.
    +!g <- !!h(1)[within(50)]; !!h(1).
    +!h(X) <- .wait(200); .print(achieved).
    -!h(X) <- .print(failed).
a failure plan has no deadline => handled | after
    !g.
    +!g <- !h[within(50)]; .print(after).
    +!h <- .fail.
    -!h <- .wait(200); .print(handled).
a deadline that has passed fails immediately => deadline
    !g. +!g <- T = 3 - 5; !h[within(T)]. +!h <- .wait(10). -!h[error(E)] <- .print(E).
the deadline of a goal holds for all branches of its fork => b | deadline | after
    !g.
    +!g <- !h[within(50)]; .print(after).
    +!h <- { .wait(100); .print(a) } |&| { .wait(20); .print(b) }; .print(never).
    -!h[error(E)] <- .print(E).
a plan has a deadline => deadline30 | after
    !g.
    +!g <- !h; .print(after).
    @p[within(30)] +!h <- .wait(200).
    -!h[error(E), deadline(D)] <- .print(E, D).
a goal with sub plans around it finds them => h | h | ia_failed | after
    !g.
    +!g <- !h[within(300), retry(1)]; .print(after). { +!h <- .print(h); .fail. -!h[error(E)] <- .print(E). }
"""


@programs(WITHIN_PROGRAMS)
def test_what_a_program_prints_of_within(program, output):
    assert printed(program) == output


def test_deadlines_that_are_over_leave_nothing():
    host = ran("!g. +!g <- !h[within(5000)]; .print(after). +!h <- .wait(10).")
    assert (host.printed, elapsed(host)) == (["after"], 0.01)
    assert not host.agent.waits.alarms
    host = ran("!g. +!g <- !h[within(500)]. +!h <- drive(5). -!h <- .print(stopped).")
    assert (host.printed, host.cancelled) == (["stopped"], [1])


def test_the_deadline_of_a_suspended_goal_keeps_running():
    host = ran(
        """
        !g. !t.
        +!g <- !h[within(500)].
        +!h <- .wait(200); .print(never).
        -!h[error(E)] <- .print(E).
        +!t <- .wait(100); .suspend(h).
        """
    )
    assert (host.printed, elapsed(host)) == (["deadline"], 0.5)


# --- retry -------------------------------------------------------------------------------------------------


def test_a_goal_is_tried_again_with_back_off():
    host = ran(
        f"""
        n(0). !g.
        +!g <- !h[retry(3, 500)]; .print(after).
        +!h <- {NOW}; ?n(N); -+n(N + 1); N > 2.
        -!h <- .print(never).
        """
    )
    assert host.printed == ["0", "0.5", "1.5", "3.5", "after"]


RETRY_PROGRAMS = """
after the last attempt the goal fails with its own reason => try | try | try | blocked kitchen 3 | after
    !g.
    +!g <- !h[retry(2, 10)]; .print(after).
    +!h <- .print(try); .fail(error(blocked), door(kitchen)).
    -!h[error(E), door(D), attempts(A)] <- .print(E, " ", D, " ", A).
a goal without applicable plan is tried again => h
    !g. !t. +!g <- !h[retry(5, 100)]. +!h : ready <- .print(h). +!t <- .wait(250); +ready.
variables that a failed attempt has bound are free again => 2
    n(0). !g.
    +!g <- !h(X)[retry(3)]; .print(X).
    +!h(X) <- ?n(N); -+n(N + 1); X = N; N > 1.
a goal inside a fork is tried again => h | b | h | handled | after
    !g.
    +!g <- !h[retry(1, 100)] |&| { .wait(30); .print(b) }; .print(after).
    +!h <- .print(h); .fail.
    -!h <- .print(handled).
a fork inside a goal is tried again => b | b | 2 | after
    !g.
    +!g <- !h[retry(1, 100)]; .print(after).
    +!h <- { .wait(10); .fail } |&| { .wait(5); .print(b); .wait(50); .print(never) }.
    -!h[attempts(A)] <- .print(A).
an atomic plan lets others run between its attempts => h0 | k | h1 | after
    n(0). !g. !k.
    +!g <- !h[retry(1, 100)]; .print(after).
    @[atomic] +!h <- ?n(N); -+n(N + 1); .print(h, N); N > 0.
    +!k <- .wait(50); .print(k).
"""


@programs(RETRY_PROGRAMS)
def test_what_a_program_prints_of_retry(program, output):
    assert printed(program) == output


def test_a_lost_goal_reports_the_number_of_attempts():
    host = ran("!g. +!g <- !h[retry(2)]. +!h <- 2 > 20.")
    [(level, told)] = host.logged
    assert level == "warning"
    assert told.splitlines()[1:] == ["  step: 2 > 20, for !h, !g", "  reason: attempts(3)"]


def test_a_deadline_holds_for_all_attempts():
    host = ran(
        """
        !g.
        +!g <- !h[within(1000), retry(20, 100)].
        +!h <- .print(try); .fail.
        -!h[error(E)] <- .print(E).
        """
    )
    assert host.printed == ["try"] * 4 + ["deadline"]
    assert elapsed(host) == 1.0


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
    assert (host.printed, elapsed(host)) == (expected, 0.5)
    assert not host.agent.alive


# --- every -------------------------------------------------------------------------------------------------


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
    assert (host.printed, elapsed(host)) == (["scan"] * 3, 2.5)
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
    assert (host.printed, elapsed(host)) == ([*["scan"] * 3, *told, "after"], moment / 1000)
    assert not host.agent.alive
    assert not host.agent.waits.alarms


def test_a_periodic_goal_ends_by_success_or_failure():
    program = """
        !g. !end.
        +!g <- !scan[every(1000)]; .print(after).
        +!scan <- .print(scan).
        +!end <- .succeed_goal(scan).
        """
    assert printed(program, 5.0) == ["after"]
    program = """
        n(0). !g.
        +!g <- !scan[every(1000)]; .print(after).
        +!scan <- ?n(N); -+n(N + 1); .print(N); if (N == 2) { .succeed_goal(scan) }; .wait(10).
        """
    assert printed(program) == ["0", "1", "2", "after"]
    assert printed(
        """
        n(0). !g.
        +!g <- !scan[every(1000)]; .print(never).
        -!g[error(E)] <- .print(E).
        +!scan <- ?n(N); -+n(N + 1); .print(N); N < 2.
        """
    ) == ["0", "1", "2", "constraint_failed"]
    assert printed(
        """
        n(0). !scan[every(1000), within(400), retry(1, 100)].
        +!scan <- ?n(N); -+n(N + 1); .print(N); N > 1; .wait(800).
        -!scan[error(E)] <- .print(E).
        """,
        2.5,
    ) == ["0", "1", "constraint_failed", "2", "deadline", "3", "deadline"]


def test_a_periodic_goal_continues_after_failures_and_ends_periods_by_done():
    assert printed("!scan[every(1000)]. +!scan <- .print(scan); .done; .print(never).", 2.5) == ["scan"] * 3
    assert printed("!scan[every(1000)]. +!scan <- .fail. -!scan <- .print(failed).", 2.5) == ["failed"] * 3
    assert printed(
        "n(0). !g. +!g <- !!scan(X)[every(10)]. +!scan(X) <- ?n(X); -+n(X + 1); .print(X).", 0.025
    ) == ["0", "1", "2"]
    assert printed(f"!scan[every(1000)]. +!scan <- {NOW}; .wait(300).", 3.9) == ["0", "1", "2", "3"]


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


# --- while and cleanup -------------------------------------------------------------------------------------


def test_a_plan_stops_when_its_condition_is_lost():
    host = ran(
        """
        ok. !g. !t.
        +!g <- !h; .print(after).
        @p[while(ok)] +!h <- drive(5); .print(never).
        -!h[error(E), error_msg(M), condition_lost(C)] <- .print(E, " ", C, ", ", M).
        +!t <- .wait(100); -ok.
        """
    )
    assert host.printed == ["condition_lost ok, the condition ok of the plan no longer holds", "after"]
    assert host.cancelled == [1]
    assert not host.agent.waits.conditions


WHILE_AND_CLEANUP_PROGRAMS = """
the clean up goal is pursued before the goal fails => parking | dock | condition_lost | after
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok), cleanup(park(dock))] +!h <- drive(5).
    -!h[error(E)] <- .print(E).
    +!park(X) <- .print(parking); .wait(100); .print(X).
    +!t <- .wait(100); -ok; +ok.
a failing clean up still reports the lost condition => ia_failedok | after
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok), cleanup(park)] +!h <- drive(5).
    -!h[error(E), condition_lost(C)] <- .print(E, C).
    +!park <- .fail.
    +!t <- .wait(100); -ok.
a condition sees the variables of the plan => t | hallcondition_lost
    at(hall). !g. !t.
    +!g <- !clean(hall).
    @p[while(at(Room)), within(9000)] +!clean(Room) <- drive(5).
    -!clean(R)[error(E)] <- .print(R, E).
    +!t <- +at(kitchen); .wait(100); -at(kitchen); .print(t); -at(hall).
a plan whose condition does not hold makes no step => condition_lost
    !g. +!g <- !h. @p[while(ok)] +!h <- .print(never). -!h[error(E)] <- .print(E).
a plan that makes its own condition false makes no further step => condition_lost
    ok. !g. +!g <- !h. @[while(ok)] +!h <- -ok; .print(never). -!h[error(E)] <- .print(E).
the condition of a plan does not hold for its failure plan => handled | after
    ok. !g. !t.
    +!g <- !h; .print(after).
    @p[while(ok)] +!h <- .fail.
    -!h <- .wait(100); .print(handled).
    +!t <- .wait(50); -ok.
a failure plan has guards of its own => deadline
    !g.
    +!g <- !h.
    -!g[error(E)] <- .print(E).
    +!h <- .fail.
    @p[within(50)] -!h <- .wait(100).
sub plans have guards => condition_lost | after
    ok. !g. !t.
    +!g <- !h; .print(after). { @[while(ok)] +!h <- drive(3). -!h[error(E)] <- .print(E). }
    +!t <- .wait(100); -ok.
"""


@programs(WHILE_AND_CLEANUP_PROGRAMS)
def test_what_a_program_prints_of_while_and_cleanup(program, output):
    assert printed(program) == output


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
    assert printed(program) == ["low", "1condition_lost"]


def test_the_condition_of_a_plan_that_has_ended_is_not_watched():
    host = ran(
        """
        ok. !g. !t.
        +!g <- !h; .wait(100); .print(after).
        @p[while(ok)] +!h <- .wait(10).
        +!t <- .wait(50); -ok.
        """
    )
    assert host.printed == ["after"]


@pytest.mark.parametrize("end", [".drop_intention(h)", ".fail_goal(h)", ".succeed_goal(h)"])
def test_a_plan_ended_from_outside_leaves_nothing_behind(end):
    host = ran(
        f"ok. !g. !t. +!g <- !h. @[while(ok), within(9000)] +!h <- drive(5). -!h. +!t <- .wait(50); {end}."
    )
    assert elapsed(host) == 0.05
    assert not host.agent.waits.conditions
    assert not host.agent.waits.alarms
    assert not host.agent.alive


def test_a_plan_that_has_lost_its_condition_is_tried_again():
    host = ran(
        """
        ok. !g. !t.
        +!g <- !h[retry(2, 1000)]; .print(after).
        @p[while(ok)] +!h <- .print(begin); .wait(5000); .print(done).
        +!t <- .wait(100); -ok; .wait(500); +ok.
        """
    )
    assert (host.printed, elapsed(host)) == (["begin", "begin", "done", "after"], 6.1)


def test_a_condition_holds_for_all_branches_of_a_fork():
    host = ran(
        """
        ok. !g. !t.
        +!g <- !h; .print(after).
        @p[while(ok)] +!h <- drive(5) |&| turn(90).
        -!h[error(E)] <- .print(E).
        +!t <- .wait(100); -ok.
        """
    )
    assert (host.printed, sorted(host.cancelled)) == (["condition_lost", "after"], [1, 2])


def test_a_plan_for_an_event_has_guards():
    host = ran("ok. !t. @p[while(ok)] +e <- drive(5). +!t <- ++e; .wait(100); -ok.")
    assert "the plan for +e failed" in host.logged[0][1]
    assert host.cancelled == [1]


@pytest.mark.parametrize("added", ["{{{}}}", '"{}."'])
def test_plans_that_are_added_at_run_time_have_guards(added):
    plan = added.format("@p[while(ok), cleanup(park)] +!h <- drive(5)")
    assert printed(
        f"""
        ok. !g. !t.
        +!g <- .add_plan({plan}); !h.
        -!h[error(E)] <- .print(E).
        +!park <- .print(parked).
        +!t <- .wait(100); -ok.
        """
    ) == ["parked", "condition_lost"]


def test_a_plan_with_guards_keeps_what_it_needs_until_it_ends():
    host = ran(
        """
        ok. !g.
        +!g <- !h; .print(after).
        @p[needs(base), while(ok), within(9000)] +!h <- .wait(100); .print(done).
        """,
        complete=lambda act: Completion(True),
    )
    assert (host.printed, host.cancelled) == (["done", "after"], [1])

    host = mind(
        "ok. !h. @p[needs(base), while(ok)] +!h <- .wait(100).", complete=lambda act: Completion(True)
    )
    host.agent.run(50)
    assert host.cancelled == []


# --- stored minds ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "program",
    [
        "n(0). !g. +!g <- !h[retry(3, 500)]; .print(after). +!h <- ?n(N); -+n(N + 1); .print(N); N > 2.",
        "!g. +!g <- !h[within(300)]; .print(after). +!h <- .wait(900). -!h[error(E), deadline(D)] <- .print(E, D).",
        (
            f"n(0). !g. +!g <- !!h[every(1000)]; .wait(9000); .drop_intention(h)."
            f" +!h <- ?n(N); -+n(N + 1); {NOW}; .wait(N * 500). ^!h[state(missed)[periods(P)]] <- .print(missed, P)."
        ),
        (
            "ok. !g. !t. +!g <- !h; .print(after). @p[while(ok), cleanup(park)] +!h <- .print(begin); .wait(5000)."
            " +!t <- .wait(100); -ok; .print(t). -!h[error(E), condition_lost(C)] <- .print(E, C)."
            " +!park <- .print(parking); .wait(100); .print(parked)."
        ),
        (
            "ok. b(1). !g. !t. +!g <- !h[retry(3, 100), within(2000)]; .print(after)."
            " @p[while(ok & b(X) & X > 0), within(700)] +!h <- .print(begin);"
            " { .wait(300); .print(a) } |&| { .wait(400); .print(b) }; .wait(4000)."
            " +!t <- .wait(350); -ok; .wait(50); .print(t); +ok. -!h[error(E)] <- .print(E)."
        ),
    ],
)
def test_a_mind_that_is_restored_after_each_cycle_prints_the_same(program):
    expected = printed_by_stored_minds(program, exchanged=False)
    assert expected
    assert printed_by_stored_minds(program, exchanged=True) == expected
