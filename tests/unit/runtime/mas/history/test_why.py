"""Answers to questions about a run, from records made by hand."""

import json
from typing import Any

import pytest
from guard_story import PLANS, RECORDS, cause, event, plan

from jacaros.look.why.explanation import Explanation
from jacaros.look.why.why import explain
from jacaros.runtime.errors import UsageError


def ask(question: str, **more: Any) -> Explanation:
    return explain(RECORDS, question, **more)


def kinds(answer: Explanation) -> list[str]:
    return [fact.kind for fact in answer.because]


@pytest.mark.parametrize("question", ["stopped", "why did the robot stop?", "Why does robot1 stand still?"])
def test_a_stop_is_traced_back_to_the_message(question: str) -> None:
    answer = ask(question)
    assert answer.t == 9.1
    assert kinds(answer) == ["command", "operation", "act", "event", "property", "sample"]
    act, handled = answer.because[2], answer.because[3]
    assert (
        act.written()
        == "guard: step `+battery(B) : limit(L) & B < L <- .drop_intention(patrol(_)); stop` of @low (guard.asl:8)"
    )
    assert handled.written() == "guard: +battery(12), handled by @low (guard.asl:7)"
    assert "!patrol(kitchen) dropped at 9.000 s" in answer.text()


def test_a_moving_robot_has_not_stopped() -> None:
    answer = ask("stopped", at=5.0)
    assert answer.answer.startswith(
        "no command to stop until 5.000 s; the last command is `/cmd_vel linear.x=0.3"
    )
    assert kinds(answer) == ["command", "operation", "act", "event"]


def test_robots_are_distinguished() -> None:
    assert ask("stopped", robot="robot1").t == 9.1
    assert ask("stopped", robot="robot2").t is None


def test_an_artifact_that_was_disposed_drove_its_robot() -> None:
    gone = {"artifact": "/main/wheels", "type": "Wheels", "state": "disposed", "robot": None}
    assert explain([*RECORDS, (20.0, "artifact", gone)], "stopped", robot="robot1").t == 9.1


def test_an_unknown_agent_lists_the_agents() -> None:
    with pytest.raises(UsageError, match=r"unknown agent: `guart`\n  = help: agents until .* s: guard"):
        ask("waiting", agent="guart")


def test_a_command_by_its_topic() -> None:
    assert ask("command /cmd_vel").t == 9.2
    assert (
        ask("command /led").answer == "no command on `/led` that an agent caused was recorded until 12.000 s"
    )


def test_an_operation_that_is_still_running() -> None:
    answer = ask("operation go")
    assert answer.answer == "go(kitchen) of /main/wheels began at 0.100 s, still running"
    assert kinds(answer) == ["operation", "act", "event"]


@pytest.mark.parametrize(
    "question", ["+battery(12)", "why was +battery(_) handled", "+battery", "+battery(X)?"]
)
def test_an_event_names_the_chosen_plan(question: str) -> None:
    answer = ask(question)
    assert answer.answer == "guard handled `+battery(12)` at 9.000 s with @low (guard.asl:7)"
    assert kinds(answer) == ["event", "property", "sample"]
    assert "`+battery(B)`: not tried, because the chosen plan comes before it (guard.asl:9)" in answer.text()


def test_an_earlier_event() -> None:
    answer = ask("+battery(_)", at=6.0)
    assert "`+battery(B) : limit(L) & B < L`: stops at `B < L` with B=40, L=20 (guard.asl:7)" in answer.text()


def test_an_event_without_applicable_plan() -> None:
    answer = ask("why did +alarm(_) not trigger")
    assert answer.answer == "guard has no applicable plan for `+alarm(fire)` at 10.000 s"
    assert [fact.text for fact in answer.facts] == [
        "`+alarm(T) : zones(T)`: no belief `zones`; did you mean `zone`?"
    ]


def test_an_event_of_a_rule_never_happens() -> None:
    answer = ask("+low")
    assert answer.t is None
    assert "`low` is the conclusion of a rule; rules cause no events" in answer.text()


def test_a_belief_without_relevant_plan() -> None:
    records = [
        *RECORDS,
        (13.0, "belief", {"agent": "guard", "op": "+", "belief": "alarm(a,b)[source(self)]"}),
    ]
    answer = explain(records, "+alarm(_,_)")
    assert answer.answer == "guard has no relevant plan for `+alarm(a,b)[source(self)]` at 13.000 s"
    assert "does not match: another trigger" in answer.text()


def test_an_event_that_never_happened_has_a_near_name() -> None:
    assert "did you mean `alarm`?" in ask("+alarn(_)").text()


def test_a_goal_tells_how_it_ended() -> None:
    answer = ask("!patrol(_)")
    assert answer.answer == "guard handled `+!patrol(kitchen)` at 0.100 s with @patrol (guard.asl:5)"
    assert "!patrol(kitchen) dropped at 9.000 s" in answer.text()


@pytest.mark.parametrize("question", ["plan @low", "why not @low?", "plan guard.asl:8", "low"])
def test_a_plan_that_was_chosen(question: str) -> None:
    answer = ask(question)
    assert answer.answer == "@low of guard (guard.asl:7) was chosen for `+battery(12)` at 9.000 s"
    assert "until then chosen once, refused once, not tried 0 times" in answer.text()


def test_a_plan_that_was_refused() -> None:
    answer = ask("plan @low", at=6.0)
    assert answer.answer == "@low of guard (guard.asl:7) did not apply for `+battery(40)` at 5.000 s"
    assert "stops at `B < L` with B=40, L=20" in answer.text()
    assert "`+battery(B)` was chosen (guard.asl:9)" in answer.text()


def test_a_plan_that_was_never_considered() -> None:
    answer = ask("plan guard.asl:12")
    assert answer.answer == "@dock of guard (guard.asl:11) was never considered"
    assert "no goal `+!dock` happened in guard until 12.000 s" in answer.text()


def test_an_unknown_plan_lists_the_plans() -> None:
    with pytest.raises(UsageError, match="unknown plan: `@lo`\n  = help: known plans: @dock, @low, @patrol"):
        ask("plan @lo")


def test_waiting() -> None:
    answer = ask("what is it waiting for?")
    assert answer.answer == "1 of 1 intentions of all agents wait at 12.000 s"
    assert answer.facts[0].written() == (
        "guard: intention 3, !watch, waits for 500 ms since 11.500 s, in `.wait(500)` (guard.asl:12)"
    )


def test_nothing_happens_because_everything_waits() -> None:
    answer = ask("why does nothing happen")
    assert answer.answer == "every open intention of all agents waits at 12.000 s"
    assert "the last event `+alarm(fire)` had no applicable plan" in answer.text()


def test_nothing_happens_because_no_agent_has_anything() -> None:
    assert ask("nothing", at=10.5).answer == (
        "no agent has a goal or an event at 10.000 s; the last event was `+alarm(fire)` at 10.000 s"
    )
    assert ask("idle", agent="guard", at=10.5).answer.startswith(
        "guard has neither a goal nor an event at 10.000 s"
    )


def test_nothing_happens_because_the_run_is_over_or_paused() -> None:
    ended = [*RECORDS, (13.0, "ended", {"code": 0})]
    assert explain(ended, "idle").answer == "the run ended at 13.000 s with exit code 0"
    paused = [*RECORDS, (13.0, "debug", {"state": "paused", "why": "breakpoint guard.asl:8"})]
    assert explain(paused, "idle").answer == "the run is paused: breakpoint guard.asl:8"


@pytest.mark.parametrize("question", ["belief battery(_)", "what changed battery(_)?", "battery"])
def test_a_belief_and_what_changed_it(question: str) -> None:
    answer = ask(question)
    assert answer.answer == "guard came to believe `battery(12)[source(percept)]` at 9.000 s"
    assert kinds(answer) == ["property", "sample"]
    assert "before: -battery(40)[source(percept)] at 9.000 s" in answer.text()


def test_a_belief_of_the_program() -> None:
    answer = ask("belief battery(_)", at=1.0)
    assert answer.facts[0].text == "it is an initial belief, or was added from outside of the plans"


def test_a_belief_that_a_step_changed() -> None:
    change = {
        "agent": "guard",
        "op": "+",
        "belief": "seen(a)[source(self)]",
        "intention": 2,
        "file": "guard.asl",
        "line": 10,
    }
    answer = explain([*RECORDS, (13.0, "belief", change)], "belief seen(_)")
    assert answer.facts[0].written() == (
        "the step `+alarm(T) : zones(T) <- .print(T)` of intention 2 did it (guard.asl:10)"
    )


def test_a_belief_that_never_existed() -> None:
    answer = ask("belief batery(_)")
    assert answer.t is None
    assert answer.answer == "no agent ever believed `batery(_)` until 12.000 s"
    assert answer.facts[0].text == "did you mean `battery`?"
    assert "it is the conclusion of a rule: low :-" in ask("belief low").text()


def test_several_plans_for_one_goal() -> None:
    records = [
        *RECORDS,
        event(13.0, 40, 0, "+!dock", 6, options=[{"plan": 5, "why": "stops at `B > 50` with B=12"}]),
    ]
    answer = explain(records, "plan +!dock")
    assert "`+!dock : battery(B) & B > 50`: stops at `B > 50` with B=12 (guard.asl:11)" in answer.text()
    assert "`+!dock`: chosen (guard.asl:13)" in answer.text()


def test_a_question_of_another_agent() -> None:
    records = [
        (
            0.0,
            "program",
            {"agent": "guard", "plans": [plan(1, "p__1", "+?time(T)", "clock(T)", 1)], "rules": []},
        ),
        event(1.0, 1, 0, "+?time(_)", None, options=[{"plan": 1, "why": "no belief `clock`"}]),
    ]
    for question in ("?time(_)", "+?time(_)", "why was ?time(T) not answered"):
        assert explain(records, question).answer == "guard has no applicable plan for `+?time(_)` at 1.000 s"


@pytest.mark.parametrize("question", ["how are you doing today", "stoped", "+", "plan"])
def test_an_unknown_question_lists_the_forms(question: str) -> None:
    with pytest.raises(UsageError) as refused:
        ask(question)
    assert "plan @LABEL, plan FILE:LINE" in str(refused.value) or "not an event" in str(refused.value)


def test_an_unknown_word_has_a_near_one() -> None:
    with pytest.raises(UsageError, match=r"did you mean `stopped`\?"):
        ask("stoped")


def test_an_answer_is_plain_data() -> None:
    data = json.loads(json.dumps(ask("stopped").data()))
    assert data["because"][0]["kind"] == "command"
    assert data["t"] == 9.1


def test_records_without_a_field_are_skipped() -> None:
    broken = [
        (1.0, "cause", {}),
        (1.0, "program", {"agent": "a"}),
        (1.0, "deliberation", {"id": 1}),
        (2.0, "new", {}),
    ]
    assert explain([*broken, *RECORDS], "stopped").t == 9.1


def test_a_cyclic_chain_ends() -> None:
    records = [
        (1.0, "cause", {"id": 1, "parent": 2, "kind": "command", "what": "/a", "at": 1.0}),
        (1.0, "cause", {"id": 2, "parent": 1, "kind": "operation", "what": "go", "at": 1.0}),
    ]
    assert kinds(explain(records, "command")) == ["command", "operation"]


def test_a_stop_by_a_suspended_goal_names_the_step_and_the_event() -> None:
    pause = plan(9, "p__9", "+near(_7)", "", 8)
    cancelled = [each for each in RECORDS if each[0] < 5.0]
    records = [
        *cancelled,
        (5.0, "program", {"agent": "guard", "plans": [*PLANS, pause], "rules": []}),
        cause(5.0, 50, 0, "sample", "/scan", topic="/scan"),
        cause(5.0, 51, 50, "property", "near(2)"),
        event(5.0, 52, 51, "+near(2)", 9, intention=5),
        (
            5.0,
            "goal",
            {"agent": "guard", "goal": "!patrol(kitchen)", "state": "suspended", "id": 1, "intention": 1},
        ),
        (
            5.0,
            "goal",
            {"agent": "guard", "goal": "!visit(_3)", "state": "suspended", "id": 2, "intention": 1},
        ),
        cause(5.0, 53, 50, "command", "/cmd_vel", topic="/cmd_vel"),
        (9.0, "belief", {"agent": "guard", "op": "+", "belief": "late[source(self)]"}),
    ]
    answer = explain(records, "stopped")
    assert kinds(answer) == ["command", "goal", "act", "event", "property", "sample"]
    assert answer.because[1].text == "!patrol(kitchen) with 1 goal above it suspended at 5.000 s"
    assert (
        answer.because[2].written() == "guard: step `.drop_intention(patrol(_))` of `+near(_)` (guard.asl:8)"
    )


def test_a_stop_at_the_end_of_the_run_is_not_a_decision() -> None:
    records = [
        *(each for each in RECORDS if each[0] < 5.0),
        cause(6.0, 50, 3, "command", "/cmd_vel", topic="/cmd_vel"),
        (6.0, "ended", {"code": 0}),
    ]
    assert [fact.text for fact in explain(records, "stopped").facts] == [
        "the run ended at 6.000 s; robots are stopped then"
    ]


def test_unnamed_variables_and_annotations_of_percepts_are_not_shown() -> None:
    belief = (
        'battery(7)[artifact_id(cobj_5),percept_type(obs_prop),source(percept),workspace("/main",cobj_1)]'
    )
    records = [(1.0, "belief", {"agent": "guard", "op": "+", "belief": belief})]
    assert (
        explain(records, "battery").answer == "guard came to believe `battery(7)[source(percept)]` at 1.000 s"
    )
    records = [event(1.0, 1, 0, "+!find(_17,a)", None)]
    assert explain(records, "!find(_,a)").answer == "guard has no relevant plan for `+!find(_,a)` at 1.000 s"


def test_a_lone_word_may_be_an_operation() -> None:
    assert ask("go").answer.startswith("go(kitchen) of /main/wheels began")


def test_plans_that_a_busy_agent_did_not_examine_are_listed() -> None:
    answer = explain([*RECORDS, event(13.0, 60, 0, "+alarm(fire)", None)], "+alarm(_)")
    assert answer.answer == "guard has no applicable plan for `+alarm(fire)` at 13.000 s"
    assert (
        answer.facts[0].text
        == "`+alarm(T) : zones(T)`: did not apply; not examined, because the agent was busy"
    )
    other = (
        13.0,
        "program",
        {"agent": "guard", "plans": [plan(1, "p__1", "+a(X)[source(percept)]", "", 1)], "rules": []},
    )
    answer = explain([other, event(13.0, 60, 0, "+a(1)", None)], "+a(_)")
    assert answer.facts[0].text == "`+a(X)[source(percept)]`: its annotations do not match"
    answer = explain([*RECORDS, event(13.0, 60, 0, "+alarm(a,b)", None)], "+alarm(_,_)")
    assert answer.answer == "guard has no relevant plan for `+alarm(a,b)` at 13.000 s"


def test_a_stop_of_a_robot_that_others_drive_is_the_end_of_an_operation() -> None:
    begun = {"id": 5, "artifact": "/main/nav", "operation": "navigate_to(1,2)", "agent": "guard", "cause": 4}
    records = [
        (0.0, "artifact", {"artifact": "/main/nav", "type": "Nav2", "state": "made", "robot": "robot1"}),
        event(1.0, 3, 0, "+!go", 1, intention=1),
        cause(1.0, 4, 3, "act", "guard navigate_to/2", agent="guard", intention=1),
        cause(1.0, 5, 4, "operation", "navigate_to(1,2)", artifact="/main/nav"),
        (1.0, "operation", {**begun, "state": "began"}),
        (4.0, "operation", {**begun, "state": "failed", "reason": "no way"}),
    ]
    answer = explain(records, "why did robot1 stop?")
    assert answer.answer == (
        "no agent sent commands to the wheels; the last operation: navigate_to(1,2) of /main/nav failed at 4.000 s: no way"
    )
    assert kinds(answer) == ["operation", "act", "event"]
    assert explain(records, "stopped", robot="robot2").t is None


def test_a_loop_is_shown_once_with_the_number_of_its_rounds() -> None:
    rounds = [
        record
        for turn in range(25)
        for record in (
            event(float(turn), 2 * turn + 1, 2 * turn, f"+!patrol({turn})", 1),
            event(turn + 0.5, 2 * turn + 2, 2 * turn + 1, f"+!dock({turn})", 6),
        )
    ]
    end = event(30.0, 51, 50, "+alarm(9)", 4)
    answer = explain([*RECORDS[:3], *rounds, end], "+alarm(_)")
    assert [fact.text.partition(",")[0] for fact in answer.because] == [
        "+alarm(9)",
        "+!dock(24)",
        "+!patrol(24)",
        "24 earlier rounds like this",
    ]
    assert answer.because[-1].t == 0.0


def test_a_message_is_shown_whole() -> None:
    told = "/battery: " + ", ".join(f"field_{number}={number}" for number in range(12)) + ", percentage=0.4"
    records = [
        *RECORDS[:3],
        cause(1.0, 10, 0, "sample", told, topic="/battery"),
        event(1.0, 11, 10, "+alarm(9)", 4),
    ]
    assert explain(records, "+alarm(_)").because[-1].text == told
