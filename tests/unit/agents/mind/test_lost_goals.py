"""Reports of lost goals: error, place, step and reason, and where the contexts of plans fail."""

from random import Random

import pytest
from recording_host import RecordingHost, mind

from jacaros.agents.mind.actions.internal_action import STANDARD
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
    assert found == lost(
        "g", "test_goal_failed, a test found no answer", 3, "step: ?reading(7,Y)", "no belief `reading`"
    )
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
        "  does not fit: +!g (tester.asl:2), stops at `ready`: no belief `ready`, and no plan adds it",
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
    why = "no belief `help`, and no plan adds it"
    assert found == lost("a", "test_goal_failed, a test found no answer", 4, "step: ?help, for -!b, !a", why)
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


def test_observers_get_error_place_step_reason_and_conjunct():
    host = mind('!a.\n+!a <- .fail(wet, error_msg("ouch")).')
    heard: list[str] = []
    observe_goals(host.agent, lambda state, goal, number, intention, why: heard.append(why) if why else None)
    host.run()
    assert heard == ["internal_action, ouch (tester.asl:2)\nstep: .fail(...)\nreason: wet"]
    host = mind("battery(12). !go.\n+!go : battery(B) & B > 20.")
    heard: list[str] = []
    observe_goals(host.agent, lambda state, goal, number, intention, why: heard.append(why) if why else None)
    host.run()
    (why,) = heard
    error, plan = why.splitlines()
    assert error == "no_applicable, no applicable plan for !go"
    assert plan == "does not fit: +!go (tester.asl:2), stops at `B > 20` with B=12"


ASKS = "!ask.\n+!ask <- .send(self, askOne, door(X), R); .print(R).\n"


def test_questions_are_reported_only_when_their_plan_failed():
    (first, step, _) = told(ASKS + "+?door(X) <- ?seen(X).")
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


def candidates(program: str, **arguments: object) -> list[str]:
    """The lines about plans that did not fit, without their beginning and the place of the plan."""
    return _candidates(_run(program, **arguments))


def _run(program: str, **arguments: object) -> RecordingHost:
    host = mind(program, **arguments)  # type: ignore[arg-type]
    host.run()
    return host


def _candidates(host: RecordingHost) -> list[str]:
    lines = [line.strip() for _, logged in host.logged for line in logged.splitlines()]
    return [line.removeprefix("does not fit: ") for line in lines if line.startswith("does not fit: ")]


def stop(program: str, **arguments: object) -> str:
    """Where the context of the only plan fails."""
    (line,) = candidates(program, **arguments)
    _, _, found = line.partition("), ")
    return found


def test_the_failing_conjunct_is_shown_with_the_values_of_its_variables():
    found = stop("battery(12). limit(20). !go.\n+!go : battery(B) & limit(L) & B > L.")
    assert found == "stops at `B > L` with B=12, L=20"
    assert stop("zone(hall). !go(kitchen).\n+!go(R) : zone(R).") == "stops at `zone(R)` with R=kitchen"
    program = "at(3). at(12). door(12). !go.\n+!go : at(X) & door(X) & X > 50."
    assert stop(program) == "stops at `X > 50` with X=12"
    found = stop("p(1). p(2). p(3). !go.\n+!go : p(X) & X > 5.")
    assert found == "stops at `X > 5` with X=1 (the first of 3 answers)"


def test_a_belief_that_the_agent_does_not_have_is_named_and_long_values_are_cut():
    assert stop("!go(a).\n+!go(R) : zone(R).") == "stops at `zone(R)` with R=a: no belief `zone`"
    assert stop("zone(a). !go(a).\n+!go(R) : zones(R).") == (
        "stops at `zones(R)` with R=a: no belief `zones`; did you mean `zone`?"
    )
    assert stop("redy. !go.\n+!go : ready.") == "stops at `ready`: no belief `ready`; did you mean `redy`?"
    assert stop("at(1,2). !go.\n+!go : at(P).") == "stops at `at(P)`: no belief `at/1`; there is `at/2`"
    assert (
        stop("~safe(a). !go.\n+!go : ~save(a).")
        == "stops at `~save(a)`: no belief `~save`; did you mean `~safe`?"
    )
    found = stop(f"p([{'abcdefghij,' * 20}a]). !go.\n+!go : p(L) & q(L).")
    assert found.startswith("stops at `q(L)` with L=[abcdefghij,")
    assert found.endswith("...: no belief `q`")
    assert len(found) < 100


def test_each_kind_of_conjunct_is_shown():
    assert stop("p(1). !go.\n+!go : p(X) & (X > 5 | q(_)).") == "stops at `X > 5 | q(_)` with X=1"
    assert stop("p(1). !go.\n+!go : p(X) & not p(X).") == "stops at `not p(X)` with X=1"
    program = "low(X) :- battery(X) & X < 20. battery(12). !go.\n+!go : low(X) & X < 10."
    assert stop(program) == "stops at `X < 10` with X=12"
    assert stop("p(2). !go.\n+!go : p(2) & N::p(1) & ready.") == "stops at `N::p(1)`"
    assert stop("low(X) :- X < 5. !go.\n+!go : low(7).") == "stops at `low(7)`"


def test_every_relevant_plan_has_its_own_conjunct_those_whose_trigger_fits_first():
    assert candidates("p. !go.\n+!go : p & q.\n+!go : r.") == [
        "+!go (tester.asl:2), stops at `q`: no belief `q`, and no plan adds it",
        "+!go (tester.asl:3), stops at `r`: no belief `r`, and no plan adds it",
    ]
    assert candidates("!go(2).\n+!go(1).\n+!go(X) : X > 5.") == [
        "+!go(X) (tester.asl:3), stops at `X > 5` with X=2",
        "+!go(1) (tester.asl:2)",
    ]
    assert (
        stop("!go.\n+!go <- .fail.\n-!go : holiday.")
        == "stops at `holiday`: no belief `holiday`, and no plan adds it"
    )


def test_internal_actions_without_effects_are_called_again():
    program = "!go([1,2]).\n+!go(L) : .length(L, N) & .member(X, L) & X > N."
    assert stop(program) == "stops at `X > N` with X=1, N=2 (the first of 2 answers)"
    assert stop("p(1). p(2). !go.\n+!go : .count(p(_), N) & N > 5.") == "stops at `N > 5` with N=2"
    assert stop("p(1). p(2). !go.\n+!go : .count(p(_)) > 5.") == "stops at `.count(p(_)) > 5`"


def test_effects_of_a_context_are_not_repeated():
    assert [
        name for name, action in STANDARD.items() if action.pure and action.suspends | action.prints
    ] == []
    host = _run('!go.\n+!go : .print("looking") & ready.')
    assert host.printed == ["looking"]
    assert _candidates(host) == [
        "+!go (tester.asl:2), stops at `ready`: no belief `ready`, and no plan adds it"
    ]
    found = stop("lucky :- .random(X) & X < 0. !go.\n+!go : lucky.")
    assert found == "not examined from `lucky` on, which may have effects"
    host = _run("p(a). !go.\n+!go : p(X) & .nth(9, [a], N) & q.")
    reports = [text for _, text in host.logged if "does not hold because" in text]
    assert len(reports) == 1


@pytest.mark.parametrize(
    "conjunct", [".random(X)", ".add_plan({+!a})", "math.random < 2", ".queue.add(Q, 1)"]
)
def test_calls_that_may_have_an_effect_are_not_repeated(conjunct):
    found = stop(f"p. !go.\n+!go : p & {conjunct} & ready.")
    assert found == f"not examined from `{conjunct}` on, which may have effects"


def test_searches_are_limited_and_random_numbers_are_not_used_up():
    program = "!go.\n+!go : p(X) & endless(0).\nendless(X) :- endless(X + 1). p(1)."
    host = _run(program)
    assert _candidates(host) == ["+!go : p(X) & endless(0) (tester.asl:2)"]
    found = stop("!go.\n+!go : .range(X, 1, 20000) & X > 50000.")
    assert found.startswith("stops at `X > 50000` with X=1 (the first of ")
    assert found.endswith(" answers); not searched to the end")
    host = mind("p(1). p(2). low(X) :- p(X) & X > 5.\n+!go : low(X).\n!go.")
    host.run()
    assert host.agent.beliefs.budget is None
    host = _run("!go.\n+!go : .random(X) & X < 0.")
    expected = Random(1)
    expected.random()
    assert host.random.random() == expected.random()


def test_nothing_is_searched_for_handled_failures(monkeypatch):
    monkeypatch.setattr("jacaros.agents.mind.rules.failure_reason.FailingContexts", None)
    host = _run(
        "!go.\n+!go : ready.\n-!go <- .print(saved).\n!outer.\n+!outer <- !go(1).\n+!go(X) : ready.\n-!outer."
    )
    assert host.printed == ["saved"]


def test_a_belief_with_values_of_another_kind_is_shown():
    because = 'stops at `mode(idle)`: the belief is `mode("idle")`: a string, not an atom'
    assert stop('mode("idle"). !go.\n+!go : mode(idle).') == because
    assert stop("at(1, 2). !go.\n+!go : at(X, here).") == (
        "stops at `at(X, here)`: the belief is `at(1,2)`: a number, not an atom"
    )
    assert stop("at(1). at(here). !go.\n+!go : at(there).") == "stops at `at(there)`"
    assert stop("at([1]). !go.\n+!go : at(_) & at(f(1)).") == (
        "stops at `at(f(1))`: the belief is `at([1])`: a list, not a structure"
    )


def test_a_flag_that_a_plan_adds_may_come():
    assert stop("!go.\n+!go : ready.\n+!prepare <- -+ready.") == "stops at `ready`"


@pytest.mark.parametrize(
    ("step", "why"),
    [
        ("?place(X, _)", "no belief `place/2`; there is `place/3`"),
        ("?place(home, _, _)", "the belief is `place(1,2,3)`: a number, not an atom"),
        ("?place(7, _, _)", None),
        (
            "?(place(X, _, _) & X > 5)",
            "stops at `X > 5` with X=1",
        ),
        (".wait(palce(_, _, _), 10)", "no belief `palce`; did you mean `place`?"),
        (
            ".wait({+place(_, _, _)}, 10)",
            "`place(_, _, _)` was added before; wait for the condition: `.wait(place(_, _, _))`",
        ),
    ],
)
def test_tests_and_waits_say_why_nothing_answers(step: str, why: str | None) -> None:
    host = mind(f"place(1, 2, 3). !go.\n+!go <- {step}.")
    host.run()
    (_, told_of) = host.logged[-1]
    assert told_of.splitlines()[2:] == ([] if why is None else [f"  {why}"])
