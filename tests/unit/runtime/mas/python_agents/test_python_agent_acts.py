"""Python agents act and perceive, in projects with others."""

from pathlib import Path

from python_agents_lab import Ran


def test_it_acts_and_sees_the_result(alone: Ran) -> None:
    result = alone("""
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
""")
    assert result.of("a") == [
        "3 [3] 3",
        "true 1 counter",
        "no artifact of workspace /main has an operation fly/0",
    ]
    assert result.errors == []


def test_it_shares_artifacts_with_an_agent_in_agentspeak(run: Ran) -> None:
    result = run(
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
    def on_signal(self, signal):
        if signal.arguments == (17,):
            self.print(signal.name, signal.arguments, " ", signal.artifact.path)
""",
        bob_asl="""!go.
            +!go <- .wait(100); inc(1); .wait({+count(16)}); .print("sixteen"); .wait(100); inc(1).
            +tick(N) <- .print("tick ", N).""",
    )
    assert result.of("painter") == ['10 ["/main","/main/lab"]', "tick[17] /main/lab/counter"]
    assert result.of("bob") == ["tick 11", "sixteen", "tick 16", "tick 17"]
    assert result.errors == []


def test_its_name_counts_as_that_of_the_caller(alone: Ran) -> None:
    assert alone('async def run(self):\n    await self.act("println", "x ", 1)').lines == ["[a] x 1"]


def test_it_waits_for_an_artifact(run: Ran) -> None:
    result = run(
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


def test_without_an_environment_it_cannot_act(tmp_path: Path, run: Ran) -> None:
    result = run(
        m_mas2j="MAS m { agents: a a.py; }",
        a_py='class A(PythonAgent):\n    async def run(self):\n        await self.act("inc")\n',
    )
    assert result.errors[0].startswith(
        "[a] error: the agent was ended by WorkspaceError: the project has no environment"
    )
    assert result.errors[0].endswith(f"({tmp_path}/a.py:4, in run)")
