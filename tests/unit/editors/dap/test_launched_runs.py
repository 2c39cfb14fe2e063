"""An editor launches a program, stops it at breakpoints, steps and looks."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from dap_client import DapClient

PROGRAM = """\
battery(57).
place(kitchen, pos(1.5, 2)).
place(hall, pos(3, 2)).
!go(kitchen, [1, f(a)]).
+!go(P, L)
   <- .print("to ", P);
      !inner(P);
      .print("b");
      !missing.
+!inner(P)
   <- ?place(P, X);
      .print("x");
      .wait(100);
      .print("y").
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "robot.asl"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def client(tmp_path: Path) -> Iterator[DapClient]:
    with DapClient(tmp_path) as client:
        yield client


def test_a_breakpoint_stops_the_run_and_shows_the_intention(client: DapClient, program: Path) -> None:
    set_ = client.launch(program, [{"line": 12}, {"line": 2}, {"line": 99}])
    assert [(each["verified"], each["line"]) for each in set_] == [(True, 12), (True, 5), (False, 99)]
    assert set_[2]["message"] == "no step on line 99 or below"
    stopped = client.event("stopped")
    assert stopped["reason"] == "breakpoint"
    assert client.lines(stopped) == [6]
    client.resume(stopped)
    stopped = client.event("stopped")
    frames = client.frames(stopped)
    assert [(each["name"], each["line"]) for each in frames] == [
        ("!inner(kitchen)", 12),
        ("!go(kitchen,[1,f(a)])", 7),
    ]
    assert frames[0]["source"] == {"name": "robot.asl", "path": str(program)}
    threads = client.ask("threads")["threads"]
    assert threads == [{"id": stopped["threadId"], "name": "robot: !go(kitchen,[1,f(a)])"}]
    assert client.output["stdout"] == "[robot] to kitchen\n"


def test_scopes_show_bindings_beliefs_the_goal_and_its_events(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 6}])
    stopped = client.event("stopped")
    bindings = client.scope(stopped, "Bindings")
    assert {name: each["value"] for name, each in bindings.items()} == {"P": "kitchen", "L": "[1,f(a)]"}
    parts = client.variables(bindings["L"]["variablesReference"])
    assert (parts["1"]["value"], parts["1"]["type"]) == ("1", "number")
    assert client.variables(parts["2"]["variablesReference"])["1"]["value"] == "a"
    beliefs = client.scope(stopped, "Beliefs")
    assert beliefs["battery/1"]["value"] == "battery(57)"
    assert (
        client.variables(beliefs["battery/1"]["variablesReference"])["annotations"]["value"] == "source(self)"
    )
    assert beliefs["place/2"]["value"] == "2 beliefs"
    places = client.variables(beliefs["place/2"]["variablesReference"])
    assert places["2"]["value"] == "place(hall,pos(3,2))"
    assert client.scope(stopped, "Goal")["state"]["value"] == "running"
    assert "!go(kitchen,[1,f(a)]) pursued" in [
        each["value"] for each in client.scope(stopped, "Events").values()
    ]


def test_steps_go_over_into_and_out_of_subgoals(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 6}])
    stopped = client.event("stopped")
    stopped = client.step("next", stopped)
    assert (stopped["reason"], client.lines(stopped)) == ("step", [7])
    stopped = client.step("stepIn", stopped)
    assert client.lines(stopped) == [11, 7]
    stopped = client.step("next", stopped, granularity="instruction")
    assert client.lines(stopped)[-1] == 7, "one reasoning cycle"
    stopped = client.step("stepOut", stopped)
    assert client.lines(stopped) == [8]


def test_over_a_subgoal_time_passes(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 7}])
    stopped = client.step("next", client.event("stopped"))
    assert client.lines(stopped) == [8]
    assert client.output["stdout"].endswith("[robot] x\n[robot] y\n")


def test_conditions_hit_counts_and_log_messages(client: DapClient, tmp_path: Path) -> None:
    program = tmp_path / "loop.asl"
    program.write_text("!go(0).\n+!go(N) : N < 9\n   <- .wait(10);\n      !go(N + 1).\n+!go(N).\n")
    set_ = client.launch(
        program, [{"line": 3, "condition": "N > 2", "hitCondition": "2"}, {"line": 4, "logMessage": "n={N}"}]
    )
    assert all(each["verified"] for each in set_)
    stopped = client.event("stopped")
    assert client.scope(stopped, "Bindings")["N"]["value"] == "4"
    assert client.output["console"].splitlines() == [f"[loop] n={n}" for n in range(4)]
    wrong = client.ask(
        "setBreakpoints", source={"path": str(program)}, breakpoints=[{"line": 3, "condition": "N >"}]
    )
    assert wrong["breakpoints"][0]["verified"] is False
    assert wrong["breakpoints"][0]["message"].startswith("expected")


def test_a_failure_stops_the_run_where_it_happened(client: DapClient, program: Path) -> None:
    client.launch(program, filters=("plan",))
    stopped = client.event("stopped")
    assert (stopped["reason"], client.lines(stopped)) == ("exception", [9])
    about = client.ask("exceptionInfo", threadId=stopped["threadId"])
    assert about["exceptionId"] == "no_relevant"
    assert "no relevant plan for !missing" in about["description"]
    assert client.scope(stopped, "Bindings")["P"]["value"] == "kitchen"


def test_breakpoints_for_events_and_plans(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 6}])
    stopped = client.event("stopped")
    wanted = [{"name": "+!inner(_)"}, {"name": "+!("}]
    set_ = client.ask("setFunctionBreakpoints", breakpoints=wanted)["breakpoints"]
    assert [each["verified"] for each in set_] == [True, False]
    client.resume(stopped)
    assert client.event("stopped")["description"] == "Paused: breakpoint +!inner(_)"


def test_questions_see_the_bindings_and_change_nothing(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 6}])
    frame = client.frames(client.event("stopped"))[0]["id"]

    def evaluated(expression: str) -> str:
        response = client.response("evaluate", expression=expression, frameId=frame, context="repl")
        return str(response["body"]["result"] if response["success"] else response["message"])

    assert evaluated("P") == "kitchen"
    assert evaluated("?place(P, Where)") == "Where = pos(1.5,2)"
    assert evaluated("place(A, _)") == "A = kitchen\nA = hall"
    assert evaluated("battery(B) & B < 20") == "no"
    assert evaluated("?(") == "expected a term, found the end of the file"
    assert evaluated("+battery(3)").startswith("this session is read-only")
    assert evaluated("battery(B)") == "B = 57"


def test_changes_can_be_allowed(client: DapClient, program: Path) -> None:
    client.launch(program, [{"line": 6}], allowChanges=True)
    client.event("stopped")
    assert (
        client.ask("evaluate", expression="-+battery(3)", context="repl")["result"] == "replaced battery(3)"
    )
    assert client.ask("evaluate", expression="?battery(B)", context="repl")["result"] == "B = 3"


def test_a_run_stops_on_entry_pauses_and_is_terminated(client: DapClient, tmp_path: Path) -> None:
    program = tmp_path / "loop.asl"
    program.write_text("!go.\n+!go\n   <- .wait(50);\n      !go.\n")
    client.launch(program, stopOnEntry=True, clock="real")
    stopped = client.event("stopped")
    assert stopped["reason"] == "entry"
    client.resume(stopped)
    client.ask("pause", threadId=stopped["threadId"])
    stopped = client.event("stopped")
    assert stopped["reason"] == "pause"
    client.resume(stopped)
    client.ask("terminate")
    assert client.event("exited") == {"exitCode": 0}
    client.event("terminated")
    assert client.process.wait(60) == 0


def test_a_run_without_debugging_begins_when_the_editor_is_ready(client: DapClient, program: Path) -> None:
    client.ask("initialize", adapterID="jacaros")
    client.send("launch", program=str(program), clock="fast", noDebug=True, args=["--until-idle"])
    client.event("initialized")
    for _ in range(100):
        client.ask("setBreakpoints", source={"path": str(program)}, breakpoints=[])
    assert "stdout" not in client.output
    client.ask("configurationDone")
    client.event("terminated")
    assert "stdout" in client.output


def test_a_run_without_debugging_only_shows_its_output(client: DapClient, program: Path) -> None:
    set_ = client.launch(program, [{"line": 6}], noDebug=True, args=["--until-idle"])
    assert set_ == []
    client.event("terminated")
    assert client.output["stdout"].startswith("[robot] to kitchen\n[robot] x\n")
    assert "the goal !go(kitchen,[1,f(a)]) failed" in client.output["stderr"]


def test_the_properties_of_a_robot_are_shown(client: DapClient, tmp_path: Path) -> None:
    program = tmp_path / "look.asl"
    program.write_text("!go.\n+!go\n   <- .wait(odom(_, _, _));\n      .print(x).\n")
    client.launch(program, [{"line": 4}], mapping=["turtlebot4.yaml"], world="patrol")
    stopped = client.event("stopped")
    artifacts = client.scope(stopped, "Artifacts")
    robot = client.variables(artifacts["/main/turtlebot4"]["variablesReference"])
    assert robot["odom"]["value"].startswith("odom(")
    belief = client.scope(stopped, "Beliefs")["odom/3"]
    assert belief["value"] == robot["odom"]["value"]
    annotations = client.variables(belief["variablesReference"])["annotations"]["value"]
    assert "artifact_name(turtlebot4)" in annotations


def test_an_agent_in_python_is_a_thread_without_plans(client: DapClient, tmp_path: Path) -> None:
    (tmp_path / "ann.asl").write_text("!go.\n+!go\n   <- .print(a).\n")
    (tmp_path / "bob.py").write_text(
        "from jacaros import PythonAgent\n\n\nclass Bob(PythonAgent):\n    async def run(self) -> None:\n"
        "        await self.sleep(3600)\n"
    )
    project = tmp_path / "both.jcm"
    project.write_text("mas both {\n  agent ann : ann.asl\n  agent bob : bob.py\n}\n")
    client.launch(project, clock="real", stopOnEntry=True)
    client.event("stopped")
    assert "not paused: agent bob (Python)" in client.output["important"]
    threads = {each["name"]: each["id"] for each in client.ask("threads")["threads"]}
    assert set(threads) == {"ann", "bob (Python)"}
    response = client.response("next", threadId=threads["bob (Python)"])
    assert response["message"] == "agent `bob` is written in Python; step another agent, or continue"
    stopped = client.step("next", {"threadId": threads["ann"]})
    assert client.lines(stopped) == [3]
