"""Agents written in Python, in projects with others: what they do, and how they begin and end."""

import sys
from pathlib import Path

import pytest

import jacaros
from jacaros import Literal, Mas, PythonAgent
from jacaros.errors import UsageError
from jacaros.testing import RunResult, run_project

ARTIFACTS = """
from jacaros.env import Artifact, Out, operation


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)
        self.signal("tick", self.value("count"))

    @operation
    def read(self, out: Out):
        out.set(self.value("count"))


class Wheels(Artifact):
    def init(self):
        self.define_property("speed", 0.0)

    @operation(name="moveForward")
    async def move_forward(self, metres: float):
        try:
            self.update_property("speed", 1.0)
            await self.sleep(metres)
        finally:
            self.update_property("speed", 0.0)
            self.log("still")
"""
BOTH = """mas m {{
    agent a: a.py {{ focus: w.{0} }}
    agent bob {{ focus: w.{0} }}
    workspace w {{ artifact {0}: {1} }}
}}"""


@pytest.fixture(autouse=True)
def no_compiled_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that a test writes twice within a second are read twice."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)


def run(folder: Path, *, idle: bool = True, seconds: float | None = 60, **files: str) -> RunResult:
    """Write files (``a_asl`` is a.asl) and run the first until nothing is left to do."""
    (folder / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    paths = []
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        paths.append(folder / f"{stem}.{suffix}")
        head = "from jacaros import OperationFailed, Out, PythonAgent, UnknownAgent, Atom, Literal\n"
        paths[-1].write_text(head + text if suffix == "py" else text, encoding="utf-8")
    return run_project(paths[0], until_idle=idle, seconds=seconds)


def alone(folder: Path, body: str, **options: object) -> RunResult:
    """Run one agent in Python; *body* is that of its class."""
    indented = "\n".join(f"    {line}" for line in body.strip("\n").splitlines())
    return run(folder, a_py=f"class A(PythonAgent):\n{indented}\n", **options)  # type: ignore[arg-type]


# ---- acting and perceiving


def test_it_acts_and_sees_the_result(tmp_path: Path) -> None:
    result = alone(
        tmp_path,
        """
async def run(self):
    await self.make_artifact("counter", "Counter", [1])
    self.focus("counter")
    await self.act("inc", 2)
    self.print(self.value("count"), " ", self.values("count"), " ", await self.act("read", Out()))
    self.print(self.has_property("count", 3), " ", len(self.properties("count")), " ", self.lookup("counter").name)
    try:
        await self.act("fly")
    except OperationFailed as failure:
        self.print(failure.message)
""",
    )
    assert result.of("a") == [
        "3 [3] 3",
        "true 1 counter",
        "no artifact of workspace /main has an operation fly/0",
    ]
    assert result.errors == []


def test_it_shares_artifacts_with_an_agent_in_agentspeak(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_jcm="""mas m {
            agent painter: painter.py { focus: lab.counter }
            agent bob { focus: lab.counter }
            workspace lab { artifact counter: Counter(10) }
        }""",
        painter_py="""
class Painter(PythonAgent):
    async def run(self):
        self.print(self.value("count"), " ", self.session.joined)
        await self.until(lambda: self.value("count") == 11)
        await self.act("inc", 5)
        async for signal in self.signals("tick"):
            self.print(signal.name, signal.arguments, " ", signal.artifact.path)
            break
""",
        bob_asl="""!go.
            +!go <- .wait(100); inc(1); .wait({+count(16)}); .print("sixteen"); .wait(100); inc(1).
            +tick(N) <- .print("tick ", N).""",
    )
    assert result.of("painter") == ['10 ["/main","/main/lab"]', "tick[17] /main/lab/counter"]
    assert result.of("bob") == ["tick 11", "sixteen", "tick 16", "tick 17"]
    assert result.errors == []


def test_its_name_counts_as_that_of_the_caller(tmp_path: Path) -> None:
    assert alone(tmp_path, 'async def run(self):\n    await self.act("println", "x ", 1)').lines == [
        "[a] x 1"
    ]


def test_it_waits_for_an_artifact(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_jcm="mas m { agent a: a.py   agent bob }",
        a_py="""
class A(PythonAgent):
    async def run(self):
        await self.focus_when_available("counter")
        self.print(self.clock.now() % 1000, " ", self.value("count"))
""",
        bob_asl='!go. +!go <- .wait(2000); makeArtifact(counter, "Counter", [4]).',
    )
    assert result.of("a") == ["802 4"]


def test_without_an_environment_it_cannot_act(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_mas2j="MAS m { agents: a a.py; }",
        a_py='class A(PythonAgent):\n    async def run(self):\n        await self.act("inc")\n',
    )
    assert result.errors[0].startswith(
        "[a] error: the agent has ended: WorkspaceError: the project has no environment"
    )
    assert result.errors[0].endswith(f"({tmp_path}/a.py:4, in run)")


# ---- messages

TALK = "MAS m { agents: a a.py; bob; }"


def talk(folder: Path, body: str, bob: str, **options: object) -> RunResult:
    indented = "\n".join(f"    {line}" for line in body.strip("\n").splitlines())
    text = f"class A(PythonAgent):\n{indented}\n"
    return run(folder, m_mas2j=TALK, a_py=text, bob_asl=bob, **options)  # type: ignore[arg-type]


def test_it_tells_and_achieves(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    self.send("bob", "tell", "painted(wall)")
    self.send("bob", "tell", Literal("painted", (Atom("door"), "red", [1, 2])))
    self.send("bob", "achieve", "paint(X)")
    self.send(["bob"], "tellHow", "+!clean <- .print(cleaned).")
    self.broadcast("achieve", Atom("clean"))
    self.send("bob", "untell", "painted(wall)")
""",
        """+painted(X)[source(S)] <- .print(X, " ", S).  -painted(X) <- .print("not ", X).
           +painted(A, B, C) <- .print(A, B, C).  +!paint(_) <- .print(paint).""",
    )
    assert sorted(result.of("bob")) == ["cleaned", "doorred[1,2]", "not wall", "paint", "wall a"]
    assert result.errors == []


def test_it_asks(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    one = await self.ask("bob", "colour(X)")
    self.print(one.functor, " ", one.arguments)
    self.print(await self.ask("bob", "colour(X)", "askAll"), await self.ask("bob", "size(X)", "askAll"))
    self.print(await self.ask("bob", "size(X)"))
    self.print(len(await self.ask("bob", "+!go", "askHow")))
    try:
        await self.ask("bob", "slow(X)", timeout=0.5)
    except TimeoutError as error:
        self.print(error, " ", self.clock.now() % 1)
    await self.sleep(1)
    self.print((await self.ask("bob", "slow(X)")).arguments[0])
""",
        "colour(red). colour(blue). !go. +!go. +?slow(1) <- .wait(700).",
    )
    assert result.of("a") == [
        "colour [red]",
        "[colour(red),colour(blue)][]",
        "None",
        "1",
        "no answer from bob within 0.5 s 0.5",
        "1",
    ]
    assert result.errors == []


def test_it_is_told_and_asked(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    async for message in self.messages():
        self.print(message.performative, " ", message.content, " ", message.sender)
        if message.performative == "askAll":
            message.reply(["size(1)", Literal("size", (2,))])
        elif message.is_question:
            message.reply(None if message.content.functor == "weight" else "size(3)")
""",
        """!go. +!go <- .send(a, tell, [p(1), "x"]); .send(a, askOne, size(X), A); .print(A);
             .send(a, askOne, weight(X), B); .print(B); .send(a, askAll, size(X), C); .print(C);
             .send(a, achieve, g(f(2)[s])); .send(a, askOne, size(Z)).
           +size(N)[source(S)] <- .print(N, S).""",
    )
    assert result.of("bob") == [
        "size(3)[source(a)]",
        "false",
        "[size(1)[source(a)],size(2)[source(a)]]",
        "3a",
    ]
    assert result.of("a")[0] == 'tell [p(1),"x"] bob'
    assert result.of("a")[4] == "achieve g(f(2)) bob"
    assert result.errors == []


def test_handlers_are_called_one_after_the_other(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_jcm=BOTH.format("counter", "Counter"),
        a_py="""
class A(PythonAgent):
    async def on_message(self, message):
        await self.sleep(0.5)
        self.print(message)
        if message.is_question:
            return Literal("size", (3,))

    def on_signal(self, signal):
        self.print(signal.name, signal.arguments)

    def on_property(self, change):
        self.print(change.name, " ", change.before, " ", change.now)
""",
        bob_asl="""!go. +!go <- inc; .send(a, tell, hello); .send(a, askOne, size(X), A); inc; .print(A);
            .send(a, achieve, clean).""",
    )
    assert result.of("a") == [
        "count None [0]",
        "tick[1]",
        "count [0] [1]",
        "tell from bob: hello",
        "askOne from bob: size(X)",
        "tick[2]",
        "count [1] [2]",
        "achieve from bob: clean",
    ]
    assert result.of("bob") == ["size(3)[source(a)]"]
    assert result.errors == []


def test_who_is_over_gives_no_answers(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        'async def run(self):\n    await self.sleep(1)\n    self.print("over")',
        """!go. +!go <- .send(a, tell, p); .send(a, askOne, size(X), A); .print(A);
             .send(a, askOne, size(X), B); .print(B); .all_names(L); .print(L).""",
    )
    assert result.lines == ["[a] over", "[bob] false", "[bob] false", "[bob] [a,bob]"]


def test_a_message_to_nobody_is_an_error_in_python(tmp_path: Path) -> None:
    body = """
async def run(self):
    for receiver in ("nobody", "a"):
        try:
            self.send(receiver, "tell", "p")
        except UnknownAgent as error:
            self.print(error)
    self.print((await self.receive()).sender)
    try:
        await self.receive(timeout=1.5)
    except TimeoutError as error:
        self.print(error)
    try:
        self.send("a", "tell", "p(")
    except Exception as error:
        self.print(type(error).__name__)
"""
    assert alone(tmp_path, body).of("a") == [
        "there is no agent nobody; there are a",
        "self",
        "no message within 1.5 s",
        "AslError",
    ]


# ---- its life


def test_time_is_virtual_and_numbers_are_seeded(tmp_path: Path) -> None:
    body = """
async def run(self):
    await self.sleep(3600)
    self.print(self.random.random())
"""
    first, second = alone(tmp_path, body, seconds=None), alone(tmp_path, body, seconds=None)
    assert first.lines == second.lines
    assert first.seconds == 3600


def test_a_run_is_idle_when_its_agents_wait_for_each_other(tmp_path: Path) -> None:
    body = """
import asyncio
class A(PythonAgent):
    async def run(self):
        self.focus("counter")
        self.start(self.sleep(5))
        async with asyncio.TaskGroup() as group:
            group.create_task(self.read())
            group.create_task(self.until(lambda: self.value("count") > 5))
            group.create_task(self.work())
    async def read(self):
        async for message in self.messages():
            self.print(message)
    async def work(self):
        for _ in range(3):
            await self.sleep(1)
            await self.act("inc")
        await asyncio.gather(anext(self.signals()), self.receive())
"""
    result = run(
        tmp_path,
        seconds=100,
        m_jcm="mas m { agent a: a.py { join: w } workspace w { artifact counter: Counter } }",
        a_py=body,
    )
    assert result.errors == []
    assert result.seconds == 5


def test_who_waits_for_something_else_is_not_idle(tmp_path: Path) -> None:
    body = """
async def run(self):
    import asyncio
    await asyncio.sleep(5)
    self.print(await asyncio.to_thread(lambda: "done"))
"""
    result = alone(tmp_path, body)
    assert result.lines == ["[a] done"]
    assert result.seconds == 5


def test_it_gives_others_their_turn(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        idle=False,
        m_jcm="mas m { agent a: a.py   agent bob   workspace w { artifact counter: Counter  agents: a } }",
        a_py="class A(PythonAgent):\n    async def run(self):\n        while True:\n            await self.act('inc')\n",
        bob_asl="!go. +!go <- .wait(1); .print(here); .stopMAS.",
    )
    assert result.lines == ["[bob] here"]
    assert result.errors == []


@pytest.mark.parametrize("end", [".stopMAS", ".kill_agent(a)"])
def test_at_its_end_its_operations_are_cancelled_and_finally_runs(tmp_path: Path, end: str) -> None:
    result = run(
        tmp_path,
        m_jcm=BOTH.format("wheels", "Wheels"),
        a_py="""
class A(PythonAgent):
    async def run(self):
        self.begin("moveForward", 100)
        try:
            await self.act("moveForward", 50)
        finally:
            self.print("leaving")
            await self.act("moveForward", 1)
            self.print("still ", self.value("speed"))
""",
        bob_asl=f"!go. +!go <- .wait(1000); {end}; .print(ended). +speed(X) <- .print(X).",
    )
    assert result.of("a") == ["leaving", "still 0"]
    assert [line for line in result.errors if "still" in line] == ["[wheels] still"] * 3
    assert result.seconds < 3


def test_an_exception_ends_this_agent_only(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    try:
        await self.sleep(1)
        self.compute(0)
    finally:
        self.print("finally")

def compute(self, x):
    return 1 / x
""",
        "!go. +!go <- .wait(2000); .all_names(L); .print(L).",
    )
    assert result.lines == ["[a] finally", "[bob] [bob]"]
    assert result.errors == [
        f"[a] error: the agent has ended: ZeroDivisionError: division by zero ({tmp_path}/a.py:11, in compute)",
        f"[a]   called from {tmp_path}/a.py:6, in run",
    ]
    assert result.exit_code == 0


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("raise SystemExit(3)", "SystemExit: 3"),
        ("raise ValueError", "ValueError"),
        (
            "self.value('count')",
            "UnknownProperty: no observable property count is known: no artifact is focused",
        ),
        ("self.send('x', 'tell', 'p')", "UnknownAgent: there is no agent x; there are a"),
        ("await self.act('x')", "OperationFailed: no artifact of workspace /main has an operation x/0"),
        (
            "A.on_message = print; self.messages()",
            "JacarosError: A has on_message, which is called with every message",
        ),
        ("self.focus('x')", "UnknownArtifact: workspace /main has no artifact x"),
        ("self.join('x')", "UnknownWorkspace: there is no workspace /main/x; did you mean /main?"),
    ],
)
def test_what_is_raised_is_told_with_its_place(tmp_path: Path, code: str, told: str) -> None:
    result = alone(tmp_path, f"async def run(self):\n    {code}")
    assert result.errors[0].startswith(f"[a] error: the agent has ended: {told}")
    assert result.errors[0].endswith(f" ({tmp_path}/a.py:4, in run)")
    assert len(result.errors) == 1
    assert result.exit_code == 0


def test_an_exception_in_a_started_task_or_a_handler_ends_the_agent(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    self.start(self.other())
    await self.receive()

async def other(self):
    await self.sleep(1)
    raise KeyError("other")
""",
        "",
    )
    assert result.errors == [
        f"[a] error: the agent has ended: KeyError: 'other' ({tmp_path}/a.py:9, in other)"
    ]
    result = talk(tmp_path, "def on_message(self, message):\n    message.x", "!g. +!g <- .send(a, tell, p).")
    assert "AttributeError" in result.errors[0]
    assert f"({tmp_path}/a.py:4, in on_message)" in result.errors[0]


def test_tasks_of_a_group_that_fail_are_told(tmp_path: Path) -> None:
    result = alone(
        tmp_path,
        """
async def run(self):
    import asyncio
    async with asyncio.TaskGroup() as group:
        group.create_task(self.fail())

async def fail(self):
    raise KeyError("x")
""",
    )
    assert result.errors[1:] == [f"[a]   KeyError: 'x' ({tmp_path}/a.py:9, in fail)"]


def test_it_may_refuse_to_be_killed(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
def accept_kill(self, killer):
    return killer != "bob"

async def run(self):
    await self.receive()
    self.print("alive")
""",
        "!go. +!go <- .kill_agent(a); .send(a, tell, p). -!go <- .print(refused); .send(a, tell, p).",
    )
    assert result.of("a") == ["alive"]


def test_it_makes_and_ends_agents_and_the_run(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        idle=False,
        a_py="""
from jacaros.errors import JacarosError

class A(PythonAgent):
    async def run(self):
        self.print(self.create_agent("b"), self.create_agent("b"), self.create_agent("c", "c.py"), self.agent_names())
        await self.sleep(1)
        self.print(self.kill_agent("b"), self.kill_agent("b"), self.agent_names())
        try:
            self.create_agent("d")
        except JacarosError as error:
            self.print(error)
        self.stop_system(3)
        self.print("after")
        await self.sleep(1)
        self.print("never")
""",
        b_asl='!go. +!go <- .print(b); .create_agent(e, "c.py").',
        c_py="class C(PythonAgent):\n    async def run(self):\n        self.print(self.name)\n",
    )
    assert result.of("a") == [
        'bb_1c["a","b","b_1","c"]',
        'truefalse["a","b_1","c","e","e_1"]',
        "agent d cannot be made; the log says why",
        "after",
    ]
    assert result.of("e") == ["e"]
    assert result.exit_code == 3


def test_the_directory_facilitator_knows_it(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    self.register_service("paint")
    self.subscribe_to_service("sell")
    self.print(await self.receive())
    self.print(self.providers("sell"), self.providers("paint"))
    self.deregister_service("paint")
    self.print(self.providers("paint"))
""",
        """!go. +!go <- .df_search(paint, L); .print(L); .df_register(sell).""",
    )
    assert result.of("bob") == ["[a]"]
    assert result.of("a") == ['tell from df: provider(bob,"sell")', '["bob"]["a"]', "[]"]


# ---- project files


def test_instances_options_and_beliefs(tmp_path: Path) -> None:
    code = """
class Painter(PythonAgent):
    async def run(self):
        self.print(self.name, " ", self.options["speed"], " ", self.beliefs, " ", self.beliefs[1].arguments)
"""
    expected = ['1 0.5 [home,room(kitchen,2)] ["kitchen",2]', '2 0.5 [home,room(kitchen,2)] ["kitchen",2]']
    mas2j = 'MAS m { agents: painter painter.py [speed=0.5, beliefs="home, room(kitchen, 2)"] #2; }'
    jcm = (
        "mas m { agent painter: painter.py { instances: 2  speed: 0.5\n beliefs: home, room(kitchen, 2)\n } }"
    )
    for files in ({"m_mas2j": mas2j}, {"m_jcm": jcm}):
        result = run(tmp_path, **files, painter_py=code)
        assert [line.partition("painter")[2].partition("painter")[2] for line in result.lines] == [
            each.replace('"kitchen"', "kitchen") for each in expected
        ]
        assert result.errors == []


TWO = """
class PaintBrush(PythonAgent):
    async def run(self):
        self.print("brush")

class Other(PaintBrush):
    async def run(self):
        self.print("other")
"""


def test_the_class_of_several_is_that_with_the_agents_name_or_the_one_that_is_named(tmp_path: Path) -> None:
    for declared in ("paint_brush two.py", "x two.py [class=PaintBrush]", "x two.py agentClass PaintBrush"):
        assert run(tmp_path, m_mas2j=f"MAS m {{ agents: {declared}; }}", two_py=TWO).lines[0][-5:] == "brush"
    for key in ("class", "ag-class"):
        jcm = f"mas m {{ agent x: two.py {{ {key}: Other }} }}"
        assert run(tmp_path, m_jcm=jcm, two_py=TWO).lines == ["[x] other"]


@pytest.mark.parametrize(
    ("code", "agent", "told"),
    [
        ("x = 1", "a a.py", "a.py has no class derived from jacaros.PythonAgent"),
        (TWO, "a a.py", "has several classes of agents, and none has the name of agent 'a'"),
        (
            TWO,
            "a a.py",
            "name one of PaintBrush, Other: [class=...] in a .mas2j file, class: ... in a .jcm file",
        ),
        (TWO, "a a.py [class=Othr]", "did you mean Other?"),
        (TWO, "a a.py [class=Xyz]", "it has PaintBrush, Other"),
        (
            "class A(PythonAgent):\n    def run(self): ...",
            "a a.py",
            "a.py:2: TypeError: A.run is no coroutine: write async def run",
        ),
        ("class A(PythonAgent):\n    def __init__(self): 1/0", "a a.py", "a.py:3, in __init__)"),
        ("class A(PythonAgent:", "a a.py", "a.py:2: "),
        ("import nowhere", "a a.py", "a.py:2: ModuleNotFoundError: No module named 'nowhere'"),
        (TWO, "a b.py", "the program of agent 'a' is not found: b.py"),
        (TWO, "df a.py [class=Other]", "the directory facilitator 'df' cannot be"),
    ],
)
def test_what_is_wrong_with_the_file_is_told_before_anything_runs(
    tmp_path: Path, code: str, agent: str, told: str
) -> None:
    result = run(tmp_path, m_mas2j=f"MAS m {{\n  agents: {agent};\n}}", a_py=code)
    assert result.exit_code == 1
    assert told in result.errors[0]
    assert result.errors[0].startswith(f"{tmp_path}/m.mas2j:2:1")
    assert result.lines == []


def test_what_has_no_effect_is_told(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_jcm="mas m { agent a: a.py { instances: 2 goals: g  events: discard  ag-arch: X ag-bb-class: Y } }",
        a_py="class A(PythonAgent):\n    pass\n",
    )
    told = [line.partition(": ")[2].partition("\n")[0] for line in result.errors]
    assert told == [
        f"warning: {what} of agent 'a' has no effect: the agent is written in Python"
        for what in ("the option 'events'", "'goals'", "the architecture class", "the belief base class")
    ]


def test_its_file_may_stand_in_a_folder_and_import_others(tmp_path: Path) -> None:
    (tmp_path / "src" / "agt").mkdir(parents=True)
    (tmp_path / "src" / "agt" / "shapes.py").write_text("SIDES = 4\n", encoding="utf-8")
    (tmp_path / "src" / "agt" / "a.py").write_text(
        "import shapes\nfrom jacaros import PythonAgent\nclass A(PythonAgent):\n"
        "    async def run(self):\n        self.print(shapes.SIDES)\n",
        encoding="utf-8",
    )
    assert run(tmp_path, m_mas2j="MAS m { agents: a a.py; b src/agt/a.py; }").of("a") == ["4"]
    assert run(tmp_path, m_mas2j='MAS m { agents: b "src/agt/a.py"; }').lines == ["[b] 4"]


def test_what_it_is_to_focus_may_come_later(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        m_jcm="""mas m {
            agent a: a.py { focus: w.counter, w.other }
            agent bob { join: w }
            workspace w { artifact other: Counter(7) }
        }""",
        a_py="""
class A(PythonAgent):
    async def run(self):
        self.print(self.value("count"))
        await self.until(lambda: self.has_property("count", 5))
        self.print(self.clock.now() % 100)
""",
        bob_asl='!go. +!go <- .wait(1000); makeArtifact(counter, "Counter", [5]).',
    )
    assert result.lines == ["[a] 7", "[a] 1"]
    assert all("error" not in line for line in result.errors)


class Echo(PythonAgent):
    async def run(self) -> None:
        async for message in self.messages():
            if message.performative == "tell":
                self.send(message.sender, "tell", Literal("heard", (message.content.functor,)))
            else:
                raise ValueError(message.performative)


def test_it_is_added_to_a_system_in_a_python_program(tmp_path: Path) -> None:
    (tmp_path / "lone.py").write_text(
        "from jacaros import PythonAgent\nclass Lone(PythonAgent): ...\n", encoding="utf-8"
    )
    lines: list[str] = []

    async def main() -> None:
        async with Mas(folder=tmp_path, on_log=lambda text, level: lines.append(text)) as mas:
            echo = mas.add_agent("echo", Echo)
            mas.add_agent("lone", tmp_path / "lone.py")
            box = mas.mailbox("tester")
            box.send("echo", "tell", "hello(1)")
            assert str((await box.get(timeout=1)).content) == 'heard("hello")'
            await mas.until_idle()
            with pytest.raises(UsageError, match="agent echo is written in Python"):
                echo.achieve("x")
            box.send("echo", "achieve", "hello(1)")
            await mas.until_idle()
            assert echo.ended
            assert [agent.name for agent in mas.agents] == ["lone"]

    jacaros.run(main(), clock="fast")
    assert len(lines) == 1
    assert lines[0].startswith("[echo] error: the agent has ended: ValueError: achieve")


def test_it_may_be_ended_before_its_first_step(tmp_path: Path) -> None:
    async def main() -> None:
        async with Mas(folder=tmp_path) as mas:
            mas.add_agent("echo", Echo).kill()
            assert mas.agents == ()

    jacaros.run(main(), clock="fast")


def test_who_does_not_accept_its_end_is_told_of_and_ended(tmp_path: Path) -> None:
    body = """
async def run(self):
    import asyncio
    while True:
        try:
            await self.sleep(1)
        except asyncio.CancelledError:
            self.print("no")
"""
    result = alone(tmp_path, body, seconds=3, idle=False)
    assert result.lines == ["[a] no"]
    assert result.errors[0] == "[a] warning: the agent did not end within 5 s of its cancellation"


def test_what_it_may_not_do_in_its_constructor_is_told(tmp_path: Path) -> None:
    result = alone(tmp_path, "def __init__(self):\n    self.print(1)")
    assert (
        "A cannot be made: JacarosError: A does not live yet: it can do this in run, not in __init__"
        in result.errors[0]
    )
    assert f"({tmp_path}/a.py:4, in __init__)" in result.errors[0]
    result = alone(tmp_path, "async def run(self):\n    self.prin(12345)")
    assert "AttributeError: A has no attribute 'prin'" in result.errors[0]


def test_who_is_killed_has_five_seconds(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    try:
        await self.receive()
    finally:
        await self.sleep(1)
        self.print("one")
        await self.sleep(10)
        self.print("eleven")
        await self.sleep(1)
        self.print("twelve")
""",
        "!go. +!go <- .kill_agent(a).",
    )
    assert result.lines == ["[a] one"]
    assert result.errors == ["[a] warning: the agent did not end within 5 s of its cancellation"]


def test_an_error_when_it_is_asked_whether_it_may_be_killed_is_told(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    await self.receive()

def accept_kill(self, killer):
    return self.friends
""",
        "!go. +!go <- .kill_agent(a); .all_names(L); .print(L).",
    )
    assert result.lines == ["[bob] [bob]"]
    assert result.errors == [
        f"[a] error: accept_kill: AttributeError: A has no attribute 'friends' ({tmp_path}/a.py:7, in accept_kill)"
    ]


def test_all_kinds_of_contents_are_heard(tmp_path: Path) -> None:
    result = talk(
        tmp_path,
        """
async def run(self):
    async for message in self.messages():
        self.print(message.performative, " ", repr(message.content))
        if message.performative == "askHow":
            message.reply(["+!g(X) <- .print(X)."])
""",
        """!go. +!go <- .send(a, tellHow, {+!g(X) : p(X) <- .print(x)}); .send(a, untellHow, "l1");
            .send(a, askHow, {+!g(_)}, P); .print(P); .send(a, signal, s(1)); .send(a, unachieve, g(2));
            .send(a, tell, [1, "text", b]); .send(a, tell, "text"); .send(a, tell, 7); .send(a, unknown, ~n::f(3)).""",
    )
    assert result.of("bob") == ['["+!g(X) <- .print(X)."]']
    assert result.of("a") == [
        "tellHow '{ +!g(X) : p(X) <- .print(x) }'",
        "untellHow 'l1'",
        "askHow '{ +!g(_1) }'",
        "signal Literal(functor='s', arguments=(1,), annotations=(), negated=False, namespace=None)",
        "unachieve Literal(functor='g', arguments=(2,), annotations=(), negated=False, namespace=None)",
        "tell [1, 'text', Literal(functor='b', arguments=(), annotations=(), negated=False, namespace=None)]",
        "tell 'text'",
        "tell 7",
        "unknown Literal(functor='f', arguments=(3,), annotations=(), negated=True, namespace='n')",
    ]
