"""Answers to questions about a run, from records made by hand."""

import json
from typing import Any

import pytest
from guard_story import PLANS, RECORDS, cause, event, goal, plan, program

from jacaros.look.records.records import Record
from jacaros.look.why.explanation import Explanation
from jacaros.look.why.why import explain
from jacaros.runtime.errors import UsageError


def ask(question: str, **more: Any) -> Explanation:
    return explain(RECORDS, question, **more)


def kinds(answer: Explanation) -> list[str]:
    return [fact.kind for fact in answer.because]


def belief(t: float, text: str, **more: Any) -> Record:
    return t, "belief", {"agent": "guard", "op": "+", "belief": text, **more}


@pytest.mark.parametrize("question", ["stopped", "why did the robot stop?", "Why did robot1 stop?"])
def test_a_stop_is_traced_back_to_the_message(question: str) -> None:
    answer = ask(question)
    assert answer.t == 9.1
    assert kinds(answer) == ["command", "operation", "act", "event", "property", "sample"]
    step = "`+battery(B) : limit(L) & B < L <- .drop_intention(patrol(_)); stop` of @low"
    assert answer.because[2].written() == f"guard: step {step} (guard.asl:8)"
    assert answer.because[3].written() == "guard: +battery(12), handled by @low (guard.asl:7)"
    assert "!patrol(kitchen) dropped at 9.000 s" in answer.text()
    data = json.loads(json.dumps(answer.data()))
    assert data["because"][0]["kind"] == "command"
    assert data["t"] == 9.1


def test_a_moving_robot_has_not_stopped() -> None:
    answer = ask("stopped", at=5.0)
    assert answer.answer.startswith(
        "no command to stop until 5.000 s; the last command is `/cmd_vel linear.x=0.3"
    )
    assert kinds(answer) == ["command", "operation", "act", "event"]


def test_robots_are_distinguished_also_after_their_artifact_was_disposed() -> None:
    assert ask("stopped", robot="robot1").t == 9.1
    assert ask("stopped", robot="robot2").t is None
    gone = {"artifact": "/main/wheels", "type": "Wheels", "state": "disposed", "robot": None}
    assert explain([*RECORDS, (20.0, "artifact", gone)], "stopped", robot="robot1").t == 9.1


def test_unknown_names_and_words_have_near_ones() -> None:
    with pytest.raises(UsageError, match=r"unknown agent: `guart`\n  = help: agents until .* s: guard"):
        ask("waiting", agent="guart")
    with pytest.raises(UsageError, match="unknown plan: `@lo`\n  = help: known plans: @dock, @low, @patrol"):
        ask("plan @lo")
    with pytest.raises(UsageError, match=r"did you mean `stopped`\?"):
        ask("stpped")


def test_a_command_and_an_operation_are_named() -> None:
    assert ask("command /cmd_vel").t == 9.2
    assert (
        ask("command /led").answer == "no command on `/led` that an agent caused was recorded until 12.000 s"
    )
    answer = ask("operation go")
    assert answer.answer == "guard started `go(kitchen)` at 0.100 s for `!patrol(kitchen)`; it has not ended"
    assert kinds(answer) == ["operation", "act", "event"]
    assert ask("go").answer == answer.answer


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


def test_an_event_without_a_plan_has_a_reason() -> None:
    answer = ask("why did +alarm(_) not trigger")
    assert answer.answer == "guard has no applicable plan for `+alarm(fire)` at 10.000 s"
    assert [fact.text for fact in answer.facts] == [
        "`+alarm(T) : zones(T)`: no belief `zones`; did you mean `zone`?"
    ]
    answer = ask("+low")
    assert answer.t is None
    assert "rules conclude it, and cause no events: low :- " in answer.text()
    answer = explain([*RECORDS, belief(13.0, "alarm(a,b)[source(self)]")], "+alarm(_,_)")
    assert answer.answer == "guard has no relevant plan for `+alarm(a,b)[source(self)]` at 13.000 s"
    assert "does not match: another trigger" in answer.text()
    assert "did you mean `alarm`?" in ask("+alarn(_)").text()


def test_a_goal_tells_how_it_ended() -> None:
    answer = ask("!patrol(_)")
    assert answer.answer == "guard handled `+!patrol(kitchen)` at 0.100 s with @patrol (guard.asl:5)"
    assert "!patrol(kitchen) was dropped at 9.000 s" in answer.text()


@pytest.mark.parametrize("question", ["plan @low", "why not @low?", "plan guard.asl:8", "low"])
def test_a_plan_that_was_chosen(question: str) -> None:
    answer = ask(question)
    assert answer.answer == "@low of guard (guard.asl:7) was chosen for `+battery(12)` at 9.000 s"
    assert "until then chosen once, refused once, not tried 0 times" in answer.text()


def test_a_plan_that_was_refused_or_never_considered() -> None:
    answer = ask("plan @low", at=6.0)
    assert answer.answer == "@low of guard (guard.asl:7) did not apply for `+battery(40)` at 5.000 s"
    assert "stops at `B < L` with B=40, L=20" in answer.text()
    assert "`+battery(B)`: chosen (guard.asl:9)" in answer.text()
    answer = ask("plan guard.asl:12")
    assert answer.answer == "@dock of guard (guard.asl:11) was never considered"
    assert "no goal `+!dock` happened in guard until 12.000 s" in answer.text()
    records = [
        *RECORDS,
        event(13.0, 40, 0, "+!dock", 6, options=[{"plan": 5, "why": "stops at `B > 50` with B=12"}]),
    ]
    answer = explain(records, "plan +!dock")
    assert "`+!dock : battery(B) & B > 50`: stops at `B > 50` with B=12 (guard.asl:11)" in answer.text()
    assert "`+!dock`: chosen (guard.asl:13)" in answer.text()


def test_what_it_waits_for_and_why_nothing_happens() -> None:
    answer = ask("what is it waiting for?")
    assert answer.answer == "guard waits for 500 ms since 11.500 s, for `!watch`"
    assert answer.facts[0].written() == (
        "guard: intention 3, !watch, waits for 500 ms since 11.500 s, in `.wait(500)` (guard.asl:12)"
    )
    answer = ask("why does nothing happen")
    assert answer.answer == "guard waits for 500 ms since 11.500 s, for `!watch`"
    assert "the last event `+alarm(fire)` had no applicable plan" in answer.text()
    idle = "no agent has a goal or an event at 10.000 s; the last event was `+alarm(fire)` at 10.000 s"
    assert ask("nothing", at=10.5).answer == idle
    answer = ask("idle", agent="guard", at=10.5).answer
    assert answer.startswith("guard has neither a goal nor an event at 10.000 s")
    ended = [*RECORDS, (13.0, "ended", {"code": 0})]
    assert explain(ended, "idle").answer == (
        "the run ended at 13.000 s with exit code 0; until then, guard waited for 500 ms since 11.500 s, for `!watch`"
    )
    paused = [*RECORDS, (13.0, "debug", {"state": "paused", "why": "breakpoint guard.asl:8"})]
    assert explain(paused, "idle").answer == "the run is paused: breakpoint guard.asl:8"


@pytest.mark.parametrize("question", ["belief battery(_)", "what changed battery(_)?", "battery"])
def test_a_belief_and_what_changed_it(question: str) -> None:
    answer = ask(question)
    assert answer.answer == "guard came to believe `battery(12)[source(percept)]` at 9.000 s"
    assert kinds(answer) == ["property", "sample"]
    assert "before: -battery(40)[source(percept)] at 9.000 s" in answer.text()


def test_where_a_belief_comes_from() -> None:
    answer = ask("belief battery(_)", at=1.0)
    assert answer.facts[0].text == "it is an initial belief, or was added from outside of the plans"
    change = belief(13.0, "seen(a)[source(self)]", intention=2, file="guard.asl", line=10)
    answer = explain([*RECORDS, change], "belief seen(_)")
    assert answer.facts[0].written() == (
        "the step `+alarm(T) : zones(T) <- .print(T)` of intention 2 did it (guard.asl:10)"
    )
    answer = ask("belief batery(_)")
    assert answer.t is None
    assert answer.answer == "no belief `batery(_)` was recorded until 12.000 s"
    assert answer.facts[0].text == "did you mean `battery`?"
    assert "rules conclude it, and cause no events: low :-" in ask("belief low").text()


def test_a_question_of_another_agent() -> None:
    records = [
        program(0.0, [plan(1, "p__1", "+?time(T)", "clock(T)", 1)]),
        event(1.0, 1, 0, "+?time(_)", None, options=[{"plan": 1, "why": "no belief `clock`"}]),
    ]
    for question in ("?time(_)", "+?time(_)", "why was ?time(T) not answered"):
        assert explain(records, question).answer == "guard has no applicable plan for `+?time(_)` at 1.000 s"


@pytest.mark.parametrize("question", ["how are you doing today", "stpped", "+", "plan"])
def test_an_unknown_question_lists_the_forms(question: str) -> None:
    with pytest.raises(UsageError) as refused:
        ask(question)
    assert "plan @LABEL, plan FILE:LINE" in str(refused.value) or "not an event" in str(refused.value)


def test_broken_records_and_cyclic_chains_end() -> None:
    broken = [
        (1.0, "cause", {}),
        (1.0, "program", {"agent": "a"}),
        (1.0, "deliberation", {"id": 1}),
        (2.0, "new", {}),
    ]
    assert explain([*broken, *RECORDS], "stopped").t == 9.1
    records = [
        (1.0, "cause", {"id": 1, "parent": 2, "kind": "command", "what": "/a", "at": 1.0}),
        (1.0, "cause", {"id": 2, "parent": 1, "kind": "operation", "what": "go", "at": 1.0}),
    ]
    assert kinds(explain(records, "command")) == ["command", "operation"]


def test_a_stop_by_a_suspended_goal_names_the_step_and_the_event() -> None:
    records = [
        *(each for each in RECORDS if each[0] < 5.0),
        program(5.0, [*PLANS, plan(9, "p__9", "+near(_7)", "", 8)]),
        cause(5.0, 50, 0, "sample", "/scan", topic="/scan"),
        cause(5.0, 51, 50, "property", "near(2)"),
        event(5.0, 52, 51, "+near(2)", 9, intention=5),
        goal(5.0, "!patrol(kitchen)", "suspended"),
        goal(5.0, "!visit(_3)", "suspended", id=2),
        cause(5.0, 53, 50, "command", "/cmd_vel", topic="/cmd_vel"),
        belief(9.0, "late[source(self)]"),
    ]
    answer = explain(records, "stopped")
    assert kinds(answer) == ["command", "goal", "act", "event", "property", "sample"]
    assert answer.because[1].text == "!patrol(kitchen) with 1 goal above it suspended at 5.000 s"
    step = "guard: step `.drop_intention(patrol(_))` of `+near(_)` (guard.asl:8)"
    assert answer.because[2].written() == step


def test_a_stop_at_the_end_of_the_run_is_not_a_decision() -> None:
    records = [
        *(each for each in RECORDS if each[0] < 5.0),
        cause(6.0, 50, 3, "command", "/cmd_vel", topic="/cmd_vel"),
        (6.0, "ended", {"code": 0}),
    ]
    assert explain(records, "stopped").answer == (
        "the robot stopped at 6.000 s, because the run ended; robots are stopped then"
    )


def test_unnamed_variables_and_annotations_of_percepts_are_not_shown() -> None:
    text = 'battery(7)[artifact_id(cobj_5),percept_type(obs_prop),source(percept),workspace("/main",cobj_1)]'
    answer = explain([belief(1.0, text)], "battery")
    assert answer.answer == "guard came to believe `battery(7)[source(percept)]` at 1.000 s"
    answer = explain([event(1.0, 1, 0, "+!find(_17,a)", None)], "!find(_,a)")
    assert answer.answer == "guard has no relevant plan for `+!find(_,a)` at 1.000 s"


def test_plans_that_a_busy_agent_did_not_examine_are_listed() -> None:
    answer = explain([*RECORDS, event(13.0, 60, 0, "+alarm(fire)", None)], "+alarm(_)")
    assert answer.answer == "guard has no applicable plan for `+alarm(fire)` at 13.000 s"
    busy = "`+alarm(T) : zones(T)`: did not apply; not examined, because the agent was busy"
    assert answer.facts[0].text == busy
    other = program(13.0, [plan(1, "p__1", "+a(X)[source(percept)]", "", 1)])
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
        "no agent sent commands to the wheels; the last operation: `navigate_to(1,2)` of guard failed at 4.000 s: no way"
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
    *newest, note = answer.because
    assert [fact.text.partition(",")[0] for fact in newest] == ["+alarm(9)", "+!dock(24)", "+!patrol(24)"]
    assert (note.text, note.t) == ("24 earlier rounds like this, since 0.000 s", None)


def test_a_message_is_shown_whole() -> None:
    told = "/battery: " + ", ".join(f"field_{number}={number}" for number in range(12)) + ", percentage=0.4"
    records = [
        *RECORDS[:3],
        cause(1.0, 10, 0, "sample", told, topic="/battery"),
        event(1.0, 11, 10, "+alarm(9)", 4),
    ]
    assert explain(records, "+alarm(_)").because[-1].text == told
