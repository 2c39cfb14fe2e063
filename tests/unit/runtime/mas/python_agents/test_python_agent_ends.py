"""How Python agents end: with the run, when they are killed, by an exception of their own."""

from pathlib import Path

import pytest
from python_agents_lab import BOTH, Echo, Ran

from jacaros import Mas


@pytest.mark.parametrize("end", [".stopMAS", ".kill_agent(a)"])
def test_at_its_end_its_operations_are_cancelled_and_finally_runs(end: str, run: Ran) -> None:
    result = run(
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


def test_an_exception_ends_this_agent_only(tmp_path: Path, talk: Ran) -> None:
    result = talk("""
async def run(self):
    try:
        await self.sleep(1)
        self.compute(0)
    finally:
        self.print("finally")

def compute(self, x):
    return 1 / x
# bob
!go. +!go <- .wait(2000); .all_names(L); .print(L).
""")
    assert result.lines == ["[a] finally", "[bob] [bob]"]
    assert result.errors == [
        f"[a] error: the agent was ended by ZeroDivisionError: division by zero ({tmp_path}/a.py:11, in compute)",
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
            "UnknownProperty: unknown observable property `count`: no artifact is focused",
        ),
        ("self.send('x', 'tell', 'p')", "UnknownAgent: unknown agent `x`; agents: a"),
        ("await self.act('x')", "OperationFailed: no artifact of workspace /main has an operation x/0"),
        (
            "A.on_message = print; self.messages()",
            "JacarosError: A has on_message, which receives all messages, so none can be awaited",
        ),
        ("self.focus('x')", "UnknownArtifact: unknown artifact `x` in workspace /main"),
        ("self.join('x')", "UnknownWorkspace: unknown workspace `/main/x`; did you mean `/main`?"),
    ],
)
def test_an_exception_is_logged_with_its_location(tmp_path: Path, code: str, told: str, alone: Ran) -> None:
    result = alone(f"async def run(self):\n    {code}")
    assert result.errors[0].startswith(f"[a] error: the agent was ended by {told}")
    assert result.errors[0].endswith(f" ({tmp_path}/a.py:4, in run)")
    assert len(result.errors) == 1
    assert result.exit_code == 0


def test_an_exception_in_a_started_task_or_a_handler_ends_the_agent(tmp_path: Path, talk: Ran) -> None:
    result = talk("""
async def run(self):
    self.start(self.other())
    await self.receive()

async def other(self):
    await self.sleep(1)
    raise KeyError("other")
# bob

""")
    assert result.errors == [
        f"[a] error: the agent was ended by KeyError: 'other' ({tmp_path}/a.py:9, in other)"
    ]
    result = talk(
        "def on_message(self, message):\n    message.x" + "\n# bob\n" + "!g. +!g <- .send(a, tell, p)."
    )
    assert "AttributeError" in result.errors[0]
    assert f"({tmp_path}/a.py:4, in on_message)" in result.errors[0]


def test_failing_tasks_of_a_group_are_logged(tmp_path: Path, alone: Ran) -> None:
    result = alone("""
async def run(self):
    import asyncio
    async with asyncio.TaskGroup() as group:
        group.create_task(self.fail())

async def fail(self):
    raise KeyError("x")
""")
    assert result.errors[1:] == [f"[a]   KeyError: 'x' ({tmp_path}/a.py:9, in fail)"]


def test_it_may_refuse_to_be_killed(talk: Ran) -> None:
    result = talk("""
def accept_kill(self, killer):
    return killer != "bob"

async def run(self):
    await self.receive()
    self.print("alive")
# bob
!go. +!go <- .kill_agent(a); .send(a, tell, p). -!go <- .print(refused); .send(a, tell, p).
""")
    assert result.of("a") == ["alive"]


async def test_it_may_be_ended_before_its_first_step(tmp_path: Path) -> None:
    async with Mas(folder=tmp_path) as mas:
        mas.add_agent("echo", Echo).kill()
        assert mas.agents == ()


def test_an_agent_that_ignores_its_cancellation_is_reported_and_ended(alone: Ran) -> None:
    body = """
async def run(self):
    import asyncio
    while True:
        try:
            await self.sleep(1)
        except asyncio.CancelledError:
            self.print("no")
"""
    result = alone(body, seconds=3, idle=False)
    assert result.lines == ["[a] no"]
    assert result.errors[0] == "[a] warning: the agent did not end within 5 s of its cancellation"


def test_forbidden_calls_in_its_constructor_are_reported(tmp_path: Path, alone: Ran) -> None:
    result = alone("def __init__(self):\n    self.print(1)")
    assert (
        "cannot create A: JacarosError: A has not started yet: do this in run, not in __init__"
        in result.errors[0]
    )
    assert f"({tmp_path}/a.py:4, in __init__)" in result.errors[0]
    result = alone("async def run(self):\n    self.prin(12345)")
    assert "AttributeError: A has no attribute 'prin'" in result.errors[0]


def test_a_killed_agent_has_five_seconds(talk: Ran) -> None:
    result = talk("""
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
# bob
!go. +!go <- .kill_agent(a).
""")
    assert result.lines == ["[a] one"]
    assert result.errors == ["[a] warning: the agent did not end within 5 s of its cancellation"]


def test_an_error_in_accept_kill_is_logged(tmp_path: Path, talk: Ran) -> None:
    result = talk("""
async def run(self):
    await self.receive()

def accept_kill(self, killer):
    return self.friends
# bob
!go. +!go <- .kill_agent(a); .all_names(L); .print(L).
""")
    assert result.lines == ["[bob] [bob]"]
    assert result.errors == [
        f"[a] error: accept_kill: AttributeError: A has no attribute 'friends' ({tmp_path}/a.py:7, in accept_kill)"
    ]
