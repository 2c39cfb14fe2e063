"""What minds do and why, as records: one test for each kind."""

from collections import Counter
from pathlib import Path

from observed_runs import of, records_of

from jacaros import PythonAgent
from jacaros.runtime.mas.embedding.mas import Mas


def test_agents_begin_and_end():
    def during(mas):
        mas.add_agent("bob", "p.")
        mas.system.end_agent("ann")

    records = records_of({"ann": "p."}, during=during)
    agents = of(records, "agent")
    states = [(each["agent"], each["state"]) for each in agents]
    assert states == [("ann", "began"), ("bob", "began"), ("ann", "ended")]
    assert agents[0]["what"] == "asl"
    (run,) = of(records, "run")
    assert (run["clock"], run["ros"], run["seed"]) == ("fast", "memory", 1)
    assert run["jacaros"]
    assert run["name"]


def test_a_program_has_its_plans_rules_and_source(tmp_path):
    file = tmp_path / "ann.asl"
    file.write_text("safe(X) :-\n p(X) & X > 2.\n!go.\n@first\n+!go : safe(Y)\n  <- true.\n-!go.\n")
    records = records_of({"ann": file})
    (program,) = of(records, "program")
    assert program["rules"] == ["safe(X) :- p(X) & X > 2"]
    assert program["thresholds"] == [
        {"belief": "p", "argument": 0, "operator": ">", "value": 2.0, "rule": "safe"}
    ]
    first, second = program["plans"]
    place = {"file": first["file"], "line": 4, "end": 6}
    assert first == {"id": 1, "label": "first", "trigger": "+!go", "context": "safe(Y)", **place}
    assert (second["id"], second["trigger"], second["context"]) == (2, "-!go", "")
    (source,) = of(records, "source")
    assert source == {"file": first["file"], "text": file.read_text()}


def test_a_program_is_recorded_again_when_its_plans_change():
    records = records_of({"ann": "!go. +!go <- .wait(1000); .add_plan({ +!later <- true }); .wait(100)."})
    programs = [(t, len(data["plans"])) for t, event, data in records if event == "program"]
    assert programs == [(0.0, 1), (1.0, 2)]


def test_beliefs_say_where_they_come_from():
    program = 'p(1). !go. +!go <- .wait(1000);\n +q("a b", X); -p(_); .send(bob, tell, r(2)).'
    records = records_of({"ann": program, "bob": "s."})
    beliefs = [(t, data) for t, event, data in records if event == "belief"]
    assert [(t, data["agent"], data["op"], data["belief"]) for t, data in beliefs] == [
        (0.0, "ann", "+", "p(1)[source(self)]"),
        (0.0, "bob", "+", "s[source(self)]"),
        (1.0, "ann", "+", 'q("a b",X)[source(self)]'),
        (1.0, "ann", "-", "p(1)[source(self)]"),
        (1.0, "bob", "+", "r(2)[source(ann)]"),
    ]
    initial, _, added, _, told = (data for _, data in beliefs)
    assert not {"cause", "intention", "file", "line"} & set(initial)
    assert (added["intention"], added["line"]) == (1, 2)
    assert "intention" not in told
    assert told["cause"] == of(records, "message")[0]["id"]


LAMP = """from jacaros.artifacts import Artifact, operation


class Lamp(Artifact):
    def init(self):
        self.define_property("power", 0)

    @operation
    def switch(self, power):
        self.update_property("power", power)
"""


def test_the_chain_leads_from_the_act_over_the_percept_to_the_event(tmp_path):
    (tmp_path / "artifacts.py").write_text(LAMP)
    (tmp_path / "ann.asl").write_text(
        "!go.\n+!go\n <- switch(5).\n+power(P) : P > 2 <- !react(P).\n+!react(P) <-\n switch(1).\n"
    )
    project = "mas p { agent ann { focus: w.lamp } workspace w { artifact lamp: Lamp } }"
    (tmp_path / "p.jcm").write_text(project)
    records = records_of({}, project=tmp_path / "p.jcm")
    links = {each["id"]: each for each in (*of(records, "cause"), *of(records, "deliberation"))}
    second = [each for each in of(records, "cause") if each["kind"] == "act"][1]
    assert (second["agent"], second["plan"], second["line"]) == ("ann", 3, 6)
    chain, number = [], second["id"]
    while number:
        chain.append(links[number].get("kind") or links[number]["trigger"])
        number = links[number]["parent"]
    assert chain == ["act", "+!react(5)", "+power(5)", "property", "operation", "act", "+!go"]
    believed = next(each for each in of(records, "belief") if each["belief"].startswith("power(5)"))
    assert links[believed["cause"]]["kind"] == "property"


REFUSED = """
battery(12). limit(20).
!go.
+!go : ready <- .print(a).
+!go : battery(B) & limit(L) & B > L <- .print(b).
+!go : battery(B) <- !sub(B).
+!go.
+!sub(X) <- true.
"""


def test_a_deliberation_says_why_plans_were_refused():
    go, sub = of(records_of({"ann": REFUSED}), "deliberation")
    assert (go["trigger"], go["chosen"], go["untried"], go["intention"]) == ("+!go", 3, [4], None)
    assert go["options"] == [
        {"plan": 1, "why": "stops at `ready`: no belief `ready`, and no plan adds it"},
        {"plan": 2, "why": "stops at `B > L` with B=12, L=20"},
    ]
    assert (sub["trigger"], sub["parent"], sub["intention"]) == ("+!sub(12)", go["id"], 1)
    (event,) = of(records_of({"ann": "p(1). +p(X) : X > 3 <- true."}), "deliberation")
    assert (event["chosen"], event["untried"]) == (None, [])
    assert event["options"] == [{"plan": 1, "why": "stops at `X > 3` with X=1"}]


def test_the_number_of_examined_contexts_per_second_is_limited():
    program = "!go(0). +!go(N) : N < 0. +!go(N) : N < 50 <- !go(N + 1). +!go(_) <- .wait(1500); !end. +!end : no. +!end."
    found = of(records_of({"ann": program}), "deliberation")
    examined = [bool(each["options"]) for each in found]
    assert examined[:10] == [True] * 10
    assert examined[-1] is True  # in another second
    assert not any(examined[10:-1])
    assert len(examined) > 40


def test_variables_of_a_goal_are_shown_as_they_were_before_a_plan_bound_them():
    program = "!go. +!go <- !ask(Where, _). +!ask(a, _) : no. +!ask(b, _)."
    _, ask = of(records_of({"ann": program}), "deliberation")
    assert ask["trigger"] == "+!ask(Where,_)"
    assert ask["options"] == [{"plan": 2, "why": "stops at `no`: no belief `no`, and no plan adds it"}]
    goals = of(records_of({"ann": "!go. +!go <- !ask(Where, _). +!ask(_, _) <- .wait(10)."}), "goal")
    assert {goal["goal"] for goal in goals} == {"!go", "!ask(Where,_)"}


def test_an_intention_shows_its_stack_and_what_it_waits_for(tmp_path):
    file = tmp_path / "ann.asl"
    file.write_text("!go(1).\n+!go(X)\n <- Y = X + 1;\n  !inner(Y);\n  true.\n+!inner(Z) <-\n .wait(3000).\n")
    records = records_of({"ann": file})
    first, over = of(records, "intention")
    assert (first["state"], first["waits"], first["since"], first["urgency"]) == ("waits", "3 s", 0.0, 0)
    assert [(each["goal"], each["plan"], each["line"], each["step"]) for each in first["stack"]] == [
        ("!go(1)", 1, 4, "!inner(2)"),
        ("!inner(2)", 2, 7, ".wait(3000)"),
    ]
    assert first["cause"] == of(records, "deliberation")[-1]["id"]
    assert (over["id"], over["state"]) == (first["id"], "over")


def test_a_suspended_intention_says_why():
    program = "!go. !other. +!go <- .wait(9000). @u[urgency(3)] +!other <- .wait(1000); .suspend(go)."
    found = [each for each in of(records_of({"ann": program}), "intention") if each["state"] != "over"]
    assert {each["urgency"] for each in found} == {0, 3}
    suspended = [each for each in found if each["state"] == "suspended"]
    assert {each["stack"][0]["goal"] for each in suspended} == {"!go"}
    assert suspended[0]["reason"]


def test_intentions_are_checked_ten_times_a_second_some_of_many():
    program = "!go. +!go <- for (.range(I, 1, 300)) { .wait(10) }."
    found = of(records_of({"ann": program}, seconds=4.0), "intention")
    assert 20 <= len(found) <= 32
    programs: dict[str, str | Path] = {f"a{number}": "!go. +!go <- .wait(9000)." for number in range(120)}
    found = Counter(t for t, event, _ in records_of(programs, seconds=4.0) if event == "intention")
    assert found == {0.1: 50, 0.2: 50, 0.3: 20}


def test_an_agent_that_ends_drops_its_goals():
    records = records_of({"ann": "!go. +!go <- .wait(9000)."}, during=lambda mas: mas.system.end_agent("ann"))
    states = [(t, data["state"]) for t, event, data in records if event == "goal"]
    assert states == [(0.0, "pursued"), (5.0, "dropped")]


def test_messages_link_what_two_agents_do():
    asks = "!go. +!go <- .send(bob, achieve, greet(ann)); .send(bob, askOne, name(_), name(N))."
    records = records_of({"ann": asks, "bob": "name(bob). +!greet(A) <- .wait(10)."})
    achieve, ask, *rest = [each for each in of(records, "message") if each["state"] == "sent"]
    assert (achieve["from"], achieve["to"], achieve["performative"]) == ("ann", "bob", "achieve")
    assert (achieve["content"], ask["content"]) == ("greet(ann)", "name(_)")
    (answer,) = rest
    assert (answer["reply_to"], answer["cause"]) == (ask["id"], ask["id"])
    go, greet = of(records, "deliberation")
    assert achieve["cause"] == go["id"]
    assert greet["parent"] == achieve["id"]
    read = [each["id"] for each in of(records, "message") if each["state"] == "read"]
    assert read == [achieve["id"], ask["id"], answer["id"]]


class Reader(PythonAgent):
    """Reads a message, and asks a question."""

    async def run(self) -> None:
        await self.receive()
        await self.ask("ann", "name(X)")


def test_agents_in_python_read_messages():
    records = records_of({"ann": "name(ann). !go. +!go <- .send(pia, tell, p(1)).", "pia": Reader})
    states = [(each["what"], each["state"]) for each in of(records, "agent")[:2]]
    assert states == [("asl", "began"), ("python", "began")]
    told, asked, answer = [each["id"] for each in of(records, "message") if each["state"] == "sent"]
    assert [each["id"] for each in of(records, "message") if each["state"] == "read"] == [told, asked, answer]


async def test_without_a_listener_nothing_is_observed():
    async with Mas(on_log=lambda *line: None) as mas:
        mas.add_agent("ann", "p.")
        host = mas.system.directory.find("ann")
        assert host.mind.observers.mind is None
        history = mas.system.history()
        history.start()
        assert host.mind.observers.mind is not None
        assert mas.system.mailboxes.observer is not None
        history.stop()
        assert host.mind.observers.mind is None
        assert mas.system.mailboxes.observer is None
