"""Questions in sentences: which things of a run their words mean, and what the answers say."""

from typing import Any

import pytest
from guard_story import RECORDS, WHEELS, cause, event, goal, plan, program

from jacaros.look.records.records import Record
from jacaros.look.why.deeds import stem
from jacaros.look.why.why import explain
from jacaros.runtime.errors import UsageError

UNCHARGED = (
    "not_achieved, charging does not hold when the plan has ended (a.asl:4)\nreason: not_achieved(charging)"
)
STEP = {"file": "a.asl", "line": 5}


def operation(t: float, number: int, text: str, state: str, parent: int, **more: Any) -> Record:
    data = {"id": number, **WHEELS, "operation": text, "agent": "guard", "state": state, "cause": parent}
    return t, "operation", {**data, **more}


def belief(t: float, text: str, op: str = "+") -> Record:
    return t, "belief", {"agent": "guard", "op": op, "belief": f"{text}[source(self)]"}


def intention(t: float, goals: list[str], waits: str) -> Record:
    stack = [{"goal": each, "plan": 1, **STEP, "step": "..."} for each in goals]
    return (
        t,
        "intention",
        {"agent": "guard", "id": 1, "state": "waits", "stack": stack, "waits": waits, "cause": 5},
    )


PLANS = [plan(1, "p__1", "+!keep", "", 1), plan(2, "p__2", "+!dock_and_charge", "", 3)]
# The guard waits until its battery is low, drives to the dock, and does not charge there.
CHARGING: list[Record] = [
    (0.0, "run", {"name": "guard", "ros": "memory"}),
    (0.0, "agent", {"agent": "guard", "state": "began"}),
    (0.0, "artifact", {**WHEELS, "type": "Wheels", "state": "made", "robot": "robot1"}),
    program(0.0, PLANS, "battery_low :- battery(B) & B < 20."),
    belief(0.0, "place(dock,1,1,0)"),
    belief(0.0, "battery(90)"),
    event(0.0, 5, 0, "+!keep", 1, intention=1),
    goal(0.0, "!keep", "pursued"),
    intention(0.1, ["!keep"], "the condition battery_low"),
    belief(8.0, "battery(90)", "-"),
    belief(8.0, "battery(12)"),
    event(8.0, 6, 5, "+!dock_and_charge", 2, intention=1),
    goal(8.0, "!dock_and_charge", "pursued", id=2),
    cause(8.0, 7, 6, "act", "guard driveTo/2", agent="guard", intention=1, plan=2, **STEP),
    operation(8.0, 8, "driveTo(1,1)", "began", 7),
    (9.0, "believed", {"robot": "robot1", "x": 1.0, "y": 1.0, "yaw": 0.0}),
    operation(12.0, 8, "driveTo(1,1)", "done", 7),
    (12.0, "bump", {"robot": "robot1", "side": "front"}),
    (13.0, "believed", {"robot": "robot1", "x": None, "y": None, "yaw": None}),
    operation(14.0, 9, "operationRecharge", "began", 6),
    operation(15.0, 9, "operationRecharge", "failed", 6, reason="no current", term="no_current"),
    goal(15.0, "!dock_and_charge", "failed", id=2, why=UNCHARGED),
    operation(16.0, 10, "rotate(90)", "began", 6),
    operation(17.0, 10, "rotate(90)", "done", 6),
    intention(18.0, ["!keep", "!stand"], "for 5 s"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("question", "answer", "details"),
    [
        ("why did it go to the dock?", "guard started `driveTo(1,1)` at 8.000 s when `battery_low` held", "battery(12)"),
        ("Why did guard drive to the dock", "guard started `driveTo(1,1)`", "the place is `place(dock,1,1,0)`"),
        ("why did the robot recharge?", "guard started `operationRecharge` at 14.000 s", "no current"),
        ("why did it turn around?", "guard started `rotate(90)` at 16.000 s", ""),
        ("why is it standing still?", "guard waits for 5 s since 18.000 s, for `!stand`", "!keep > !stand"),
        ("what is guard doing", "guard waits for 5 s", ""),
        ("did it reach the dock?", "it believes so: `driveTo(1,1)` of guard was done at 12.000 s", "robot1: bump"),
        ("did it turn?", "yes: `rotate(90)` of guard was done at 17.000 s", ""),
        ("did it recharge?", "no: `operationRecharge` of guard failed at 15.000 s: no current", ""),
        ("did it achieve dock_and_charge", "no: `!dock_and_charge` of guard failed at 15.000 s", "not_achieved(charging)"),
        ("did it achieve !keep", "not yet: `!keep` of guard has not ended", "waits for 5 s"),
        ("why did it not recharge?", "`operationRecharge` of guard failed at 15.000 s: no current", ""),
        ("why did it fail?", "`operationRecharge` failed at 15.000 s: no current", "!dock_and_charge failed"),
        ("what went wrong", "`operationRecharge` failed", "not_achieved(charging)"),
        ("when did it drive to the dock?", "`driveTo(1,1)` happened once, at 8.000 s", "was done at 12.000 s"),
        ("how often did it rotate", "`rotate(90)` happened once", ""),
        ("is the battery low?", "a rule of guard decides `battery_low` with battery(12)", ""),
        ("did it bump into something?", "yes: `bump` of robot1 happened at 12.000 s", ""),
        ("is it docked?", "`!dock_and_charge` of guard failed at 15.000 s", ""),
        ("driveTo", "guard started `driveTo(1,1)` at 8.000 s", ""),
        ("operation", "guard started `rotate(90)` at 16.000 s", ""),
        ("goal keep", "guard pursued `!keep` at 0.000 s", ""),
        ("when did it fall?", "`fell` was not recorded until 18.000 s", ""),
        ("did it fall?", "no: `fell` was not recorded until 18.000 s", ""),
    ],
)  # fmt: skip
def test_a_sentence_is_about_what_its_words_name(question: str, answer: str, details: str) -> None:
    found = explain(CHARGING, question)
    assert found.answer.startswith(answer)
    assert details in found.text()


def test_the_end_of_something_else_gives_no_verdict() -> None:
    begun = goal(19.0, "!find_dock", "pursued", id=9)
    answer = explain(
        [*CHARGING[:8], begun, goal(20.0, "!find_dock", "achieved", id=9)], "did it dock?"
    ).answer
    assert answer == "`!find_dock` of guard was achieved at 20.000 s"


def test_a_name_fits_better_than_an_argument() -> None:
    begun = [
        goal(float(t), text, "pursued", id=t)
        for t, text in enumerate(("!wait_until_charged", "!attempt(wait_until_charged,1)"))
    ]
    answer = explain([*CHARGING[:3], *begun], "is it charging?").answer
    assert answer == "`!wait_until_charged` of guard has not ended"


def test_of_several_robots_the_one_asked_about_is_meant() -> None:
    other = operation(20.0, 90, "rotate(-5)", "began", 0, agent="scout")
    records = [*CHARGING, (19.0, "agent", {"agent": "scout", "state": "began"}), other]
    assert explain(records, "why did it turn?").answer.startswith("scout started `rotate(-5)`")
    assert explain(records, "why did guard turn?").answer.startswith("guard started `rotate(90)`")


def test_what_did_not_happen_is_explained_by_its_plan() -> None:
    assert explain(RECORDS, "why did it dock?").answer.startswith("it did not: `+!dock` of guard")
    assert explain(RECORDS, "did it dock?").answer.startswith(
        "no: `+!dock` of guard (guard.asl:13) was never"
    )


def test_a_belief_that_names_something_else_gives_no_verdict() -> None:
    known = [belief(0.0, "place(dock,1,1,0)"), belief(0.0, "recharges(1)")]
    begun = [*RECORDS[:3], program(0.0, [], "help_fact(docked(D)) :- docked(D)."), *known]
    for question in ("is it docked?", "did it dock?", "is it charging?"):
        assert "was not recorded" in explain(begun, question).answer


def test_an_agent_and_its_goal_may_have_one_name() -> None:
    renamed = [
        (t, kind, {**data, "agent": "charge"} if "agent" in data else data) for t, kind, data in CHARGING
    ]
    answer = explain(renamed, "did charge achieve dock_and_charge?").answer
    assert answer.startswith("no: `!dock_and_charge` of charge failed")
    assert explain(renamed, "did it recharge?").answer.startswith("no: `operationRecharge` of charge failed")


@pytest.mark.parametrize(
    "question",
    [
        "operation paint",
        "why did it paint the fence?",
        "how far did it drive",
        "did it go to the kitchen?",
        "did it come back?",
        "did it arrive?",
        "did it reach its goal?",
        "",
    ],
)
def test_an_unknown_sentence_lists_what_this_run_can_be_asked_about(question: str) -> None:
    with pytest.raises(UsageError) as refused:
        explain(CHARGING, question)
    lines = str(refused.value).split("\n")
    assert "  = help: operations of this run, newest first: rotate, operationRecharge, driveTo" in lines
    assert "  = help: goals of this run, newest first: dock_and_charge, keep" in lines
    assert "  = help: events in the world of this run, newest first: bump" in lines
    assert any(line.lstrip().startswith("why did it VERB ...") for line in lines)


@pytest.mark.parametrize(
    "words",
    [
        "recharge recharged recharges recharging",
        "patrol patrolled patrolling",
        "deliver delivery deliveries",
        "go went gone",
        "stop stopped",
    ],
)
def test_forms_of_a_word_have_one_stem(words: str) -> None:
    assert len(set(map(stem, words.split()))) == 1
