"""The records of a short run, as docs/reference/recordings.md describes them: a guard stops for a low battery."""

from typing import Any

from jacaros.look.records.records import Record

SOURCE = """battery(100).
limit(20).
low :- battery(B) & limit(L) & B < L.

@patrol
+!patrol(Room) : limit(_) <- go(Room).
@low
+battery(B) : limit(L) & B < L <- .drop_intention(patrol(_)); stop.
+battery(B) <- true.
+alarm(T) : zones(T) <- .print(T).
@dock
+!dock : battery(B) & B > 50 <- .print(full).
+!dock <- go(dock).
"""


def plan(
    number: int, label: str, trigger: str, context: str, line: int, end: int | None = None
) -> dict[str, Any]:
    place = {"file": "guard.asl", "line": line, "end": end or line}
    return {"id": number, "label": label, "trigger": trigger, "context": context, **place}


PLANS = [
    plan(1, "patrol", "+!patrol(Room)", "limit(_)", 5, 6),
    plan(2, "low", "+battery(B)", "limit(L) & B < L", 7, 8),
    plan(3, "p__3", "+battery(B)", "", 9),
    plan(4, "p__4", "+alarm(T)", "zones(T)", 10),
    plan(5, "dock", "+!dock", "battery(B) & B > 50", 11, 12),
    plan(6, "p__6", "+!dock", "", 13),
]


def cause(t: float, number: int, parent: int, kind: str, what: str, **more: Any) -> Record:
    return t, "cause", {"id": number, "parent": parent, "kind": kind, "what": what, "at": t, **more}


def program(t: float, plans: list[dict[str, Any]], *rules: str) -> Record:
    return t, "program", {"agent": "guard", "plans": plans, "rules": list(rules)}


def goal(t: float, text: str, state: str, **more: Any) -> Record:
    return t, "goal", {"agent": "guard", "goal": text, "state": state, "id": 1, "intention": 1, **more}


def event(t: float, number: int, parent: int, trigger: str, chosen: int | None, **more: Any) -> Record:
    data = {"id": number, "parent": parent, "agent": "guard", "trigger": trigger, "chosen": chosen}
    return t, "deliberation", {"intention": None, "options": [], "untried": [], **data, **more}


def command(t: float, number: int, parent: int, speed: float) -> Record:
    return cause(
        t, number, parent, "command", f"/cmd_vel linear.x={speed} angular.z=0.0", topic="/cmd_vel", **WHEELS
    )


WHEELS = {"artifact": "/main/wheels"}
STEP = {"goal": "!watch", "plan": 5, "file": "guard.asl", "line": 12, "step": ".wait(500)"}
WAITS = {"waits": "for 500 ms", "since": 11.5, "urgency": 0}

RECORDS: list[Record] = [
    (0.0, "run", {"name": "guard", "clock": "fast", "ros": "memory", "seed": 1, "jacaros": "0"}),
    (0.0, "source", {"file": "guard.asl", "text": SOURCE}),
    (0.0, "agent", {"agent": "guard", "what": "asl", "state": "began"}),
    program(0.0, PLANS, "low :- battery(B) & limit(L) & B < L."),
    (0.0, "artifact", {"artifact": "/main/wheels", "type": "Wheels", "state": "made", "robot": "robot1"}),
    (0.0, "belief", {"agent": "guard", "op": "+", "belief": "battery(100)[source(self)]"}),
    event(0.1, 1, 0, "+!patrol(kitchen)", 1, intention=1),
    goal(0.1, "!patrol(kitchen)", "pursued"),
    cause(0.1, 2, 1, "act", "guard go/1", agent="guard", intention=1, plan=1, file="guard.asl", line=6),
    cause(0.1, 3, 2, "operation", "/main/wheels go/1", artifact="/main/wheels"),
    (
        0.1,
        "operation",
        {"id": 3, **WHEELS, "operation": "go(kitchen)", "agent": "guard", "state": "began", "cause": 2},
    ),
    command(0.2, 4, 3, 0.3),
    cause(5.0, 10, 0, "sample", "/battery", topic="/battery"),
    cause(5.0, 11, 10, "property", "battery(40)"),
    event(5.0, 12, 11, "+battery(40)", 3, options=[{"plan": 2, "why": "stops at `B < L` with B=40, L=20"}]),
    (5.0, "belief", {"agent": "guard", "op": "+", "belief": "battery(40)[source(percept)]", "cause": 11}),
    cause(9.0, 20, 0, "sample", "/battery", topic="/battery"),
    cause(9.0, 21, 20, "property", "battery(12)"),
    (9.0, "belief", {"agent": "guard", "op": "-", "belief": "battery(40)[source(percept)]", "cause": 21}),
    (9.0, "belief", {"agent": "guard", "op": "+", "belief": "battery(12)[source(percept)]", "cause": 21}),
    event(9.0, 22, 21, "+battery(12)", 2, intention=2, untried=[3]),
    goal(9.0, "!patrol(kitchen)", "dropped"),
    cause(9.0, 23, 22, "act", "guard stop/0", agent="guard", intention=2, plan=2, file="guard.asl", line=8),
    cause(9.0, 24, 23, "operation", "/main/wheels stop/0", artifact="/main/wheels"),
    command(9.1, 25, 24, 0.0),
    command(9.2, 26, 24, 0.0),
    event(
        10.0,
        30,
        0,
        "+alarm(fire)",
        None,
        options=[{"plan": 4, "why": "no belief `zones`; did you mean `zone`?"}],
    ),
    (12.0, "intention", {"agent": "guard", "id": 3, "state": "waits", "stack": [STEP], **WAITS}),
]
