"""Descriptions of goals that failed and that no plan handled."""

from recording_host import mind

from jacaros.agents.mind.rules.meta_events import observe_goals
from jacaros.agents.mind.state.act import Completion
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.values import String, structure


def told(program: str, **arguments: object) -> list[str]:
    """The lines about what an agent with this program has lost."""
    host = mind(program, **arguments)  # type: ignore[arg-type]
    host.run()
    return [line for level, text in host.logged for line in text.splitlines() if level == "warning"]


def lost(goal: str, why: str, line: int, *details: str) -> list[str]:
    first = f"the goal !{goal} failed and has no plan for its failure: {why} (tester.asl:{line})"
    return [first, *(f"  {each}" for each in details)]


def test_a_step_is_reported_with_its_values():
    found = told("!g.\n+!g <- X = 7;\n ?reading(X, Y).")
    assert found == lost("g", "test_goal_failed, a test found no answer", 3, "step: ?reading(7,Y)")
    found = told("level(3).\n!g.\n+!g <- ?level(X);\n X > 5.")
    assert found == lost("g", "constraint_failed, a constraint does not hold", 4, "step: 3 > 5")
    found = told("!g.\n+!g <- X = 1 div 0.")
    assert found == lost("g", "arithmetic_error, integer division by zero", 2, "step: X = (1 div 0)")
    (first, step) = told("!g.\n+!g <- .nth(7, [a], X).")
    assert first.endswith("internal_action, .nth: position 7 is outside the 1 elements (tester.asl:2)")
    assert step == "  step: .nth(7,[a],X)"
    found = told('!g.\n+!g <- .fail(stuck(3), error_msg("the door is shut")).')
    step = "step: .fail(...)"
    assert found == lost("g", "internal_action, the door is shut", 2, step, "reason: stuck(3)")


def test_a_failing_action_is_reported_with_reason_step_and_goals():
    reason = structure("env_failure_reason", structure("aborted", 204.0, String("no path")))
    failed = Completion(False, (), (structure("error_msg", String("no path")), reason))
    program = (
        "!patrol.\n+!patrol <- !visit(kitchen).\n+!visit(R) <- !go(3, 2).\n+!go(X, Y) <- navigate_to(X, Y)."
    )
    assert told(program, complete=lambda act: failed) == lost(
        "patrol",
        "action_failed, no path",
        4,
        "step: navigate_to(3,2), for !go(3,2), !visit(kitchen), !patrol",
        'reason: env_failure_reason(aborted(204,"no path"))',
    )


def test_goals_without_a_plan_are_reported_with_those_below_and_the_plans_that_do_not_fit():
    assert told("!g.\n+!g <- !missing(4).") == lost("g", "no_relevant, no relevant plan for !missing(4)", 2)
    found = told("!g.\n+!g <- !h.\n+!h <- !i.\n+!i <- !missing(4).")
    assert found == lost("g", "no_relevant, no relevant plan for !missing(4)", 4, "for: !i, !h, !g")
    found = told("!g.\n+!g <- !h(4).\n+!h(X) : X > 5.\n+!h(a).\n+!h(b).\n+!h(c).\n+!h(d).")
    assert found == lost(
        "g",
        "no_applicable, no applicable plan for !h(4)",
        2,
        "does not fit: +!h(X) (tester.asl:3), stops at `X > 5` with X=4",
        "does not fit: +!h(a) (tester.asl:4)",
        "does not fit: +!h(b) (tester.asl:5)",
        "and 2 more plans",
    )
    assert told("!g.\n+!g : ready.") == [
        "the goal !g failed and has no plan for its failure: no_applicable, no applicable plan for !g",
        "  does not fit: +!g (tester.asl:2), stops at `ready`",
    ]


def test_fail_goal_and_deadlines_name_the_ended_goal_and_its_step():
    found = told("!a. !b.\n+!a <- .wait(10);\n .fail_goal(b).\n+!b <- !c(1).\n+!c(X) <- .wait(9000).")
    assert found == lost(
        "b", ".fail_goal in the plan of !a ended it", 5, "step: .wait(9000), for !c(1), !b"
    )  # fmt: skip
    found = told("!a.\n+!a <- .fail_goal(a).")
    assert found == lost("a", ".fail_goal in the plan of !a ended it", 2, "step: .fail_goal(a)")
    found = told("!a.\n+!a <- !late[hard_deadline(50)].\n+!late <- !inner.\n+!inner <- .wait(9000).")
    told_why = "deadline_reached, the goal was not achieved in time"
    assert found == lost("a", told_why, 4, "step: .wait(9000), for !inner, !late, !a")


def test_failing_handlers_are_reported_with_their_goals():
    found = told("!a.\n+!a <- !b.\n+!b <- .fail.\n-!b <- ?help.")
    assert found == lost("a", "test_goal_failed, a test found no answer", 4, "step: ?help, for -!b, !a")
    assert told("!a.\n+!a <- !b.\n+!b <- .fail.\n-!b[error(other)].") == [
        (
            "no applicable plan for the failure event -!b; the intention is dropped: "
            "ia_failed, internal action .fail failed (tester.asl:3)"
        ),
        "  step: .fail, for !b, !a",
        "  does not fit: -!b[error(other)] (tester.asl:4)",
    ]
    assert told("low(7).\n+low(X) <- .fail.") == [
        (
            "the plan for +low(7) failed and has no plan for its failure: "
            "ia_failed, internal action .fail failed (tester.asl:2)"
        ),
        "  step: .fail",
    ]


def test_long_terms_messages_and_stacks_are_cut():
    goals = "\n".join(f"+!g{n} <- !g{n + 1}." for n in range(10))
    (_, step) = told(f"!g0.\n{goals}\n+!g10 <- .length([{'abcdefghi,' * 20}a], 3).")
    assert step == (
        "  step: .length([abcdefghi," + "abcdefghi," * 9 + "abcdefgh..., for "
        "!g10, !g9, !g8, !g7, !g6, 5 more, !g0"
    )
    found = told("!b(200, a).\n+!b(0, T) <- .fail.\n+!b(N, T) <- !b(N - 1, f(T, T)); .print(N).")
    assert len(found) == 2
    assert found[1].startswith("  step: .fail, for !b(0,f(f(f(")
    assert found[1].endswith(", 195 more, !b(200,a)")
    assert len(found[1]) < 1000
    (found,) = told("!a.\n+!a <- .findall(X, .range(X, 1, 50000), L); !g(L).")
    assert "no relevant plan for !g([1,2,3," in found
    assert len(found) < 1000


def test_an_observer_gets_error_place_step_and_reason():
    host = mind('!a.\n+!a <- .fail(wet, error_msg("ouch")).')
    heard: list[str] = []
    observe_goals(host.agent, lambda state, goal, number, intention, why: heard.append(why) if why else None)
    host.run()
    assert heard == ["internal_action, ouch (tester.asl:2)\nstep: .fail(...)\nreason: wet"]


ASKS = "!ask.\n+!ask <- .send(self, askOne, door(X), R); .print(R).\n"


def test_questions_are_reported_only_when_their_plan_failed():
    (first, step) = told(ASKS + "+?door(X) <- ?seen(X).")
    assert first.startswith("the question ?door(")
    assert first.endswith(
        " from self is answered false, because its plan failed: "
        "test_goal_failed, a test found no answer (tester.asl:3)"
    )
    assert step.startswith("  step: ?seen(")
    host = mind(ASKS + "+?door(X) : open(X).")
    host.run()
    assert host.printed == ["false"]
    assert host.logged == []
    assert told(ASKS + "+?door(X) <- .fail.\n-?door(X) <- X = shut.") == []


def details(program: str, verbose: int = 2) -> list[str]:
    """What an agent logs as details, line by line."""
    host = mind(program, options=Options(verbose=verbose))
    host.run()
    return [line.strip() for level, logged in host.logged for line in logged.splitlines() if level == "debug"]


WHY_NOT = [
    "no applicable plan for +alarm(fire)",
    "does not fit: +alarm(T) (tester.asl:1), stops at `zones(T)` with T=fire: no belief `zones`",
]


def test_details_report_why_no_plan_was_selected_for_an_event():
    plan = "+alarm(T) : zones(T).\n"
    assert details(plan + "alarm(fire).") == WHY_NOT
    assert details(plan + "!go.\n+!go <- +alarm(fire).") == WHY_NOT
    assert details(plan + "!go.\n+!go <- +alarm(fire). { +other. }") == WHY_NOT
    assert details("+alarm(T) : zones(T). alarm(fire).", verbose=1) == []
    assert details("+other. alarm(fire).") == []
