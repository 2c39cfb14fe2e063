"""Python agents beside others: turns and creation."""

from pathlib import Path

import pytest
from python_agents_lab import Echo, Ran

from jacaros import Mas
from jacaros.runtime.errors import UsageError


def test_time_is_virtual_and_numbers_are_seeded(alone: Ran) -> None:
    body = """
async def run(self):
    await self.sleep(3600)
    self.print(self.random.random())
"""
    first, second = alone(body, seconds=None), alone(body, seconds=None)
    assert first.lines == second.lines
    assert first.seconds == 3600


def test_a_run_is_idle_when_its_agents_wait_for_each_other(run: Ran) -> None:
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
        await asyncio.gather(self.until(lambda: self.value("count") > 5), self.receive())
"""
    result = run(
        seconds=100,
        m_jcm="mas m { agent a: a.py { join: w } workspace w { artifact counter: Counter } }",
        a_py=body,
    )
    assert result.errors == []
    assert result.seconds == 5


def test_an_agent_that_waits_for_something_else_is_not_idle(alone: Ran) -> None:
    body = """
async def run(self):
    import asyncio
    await asyncio.sleep(5)
    self.print(await asyncio.to_thread(lambda: "done"))
"""
    result = alone(body)
    assert result.lines == ["[a] done"]
    assert result.seconds == 5


def test_it_lets_others_have_their_turn(run: Ran) -> None:
    result = run(
        idle=False,
        m_jcm="mas m { agent a: a.py   agent bob   workspace w { artifact counter: Counter  agents: a } }",
        a_py="class A(PythonAgent):\n    async def run(self):\n        while True:\n            await self.act('inc')\n",
        bob_asl="!go. +!go <- .wait(1); .print(here); .stopMAS.",
    )
    assert result.lines == ["[bob] here"]
    assert result.errors == []


def test_it_creates_and_ends_agents_and_the_run(run: Ran) -> None:
    result = run(
        idle=False,
        a_py="""
from jacaros.runtime.errors import JacarosError

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
        "cannot create agent d; see the log for the reason",
        "after",
    ]
    assert result.of("e") == ["e"]
    assert result.exit_code == 3


async def test_it_is_added_to_a_system_in_a_python_program(tmp_path: Path, logs: list[str]) -> None:
    lone = tmp_path / "lone.py"
    lone.write_text("from jacaros import PythonAgent\nclass Lone(PythonAgent): ...\n", encoding="utf-8")
    async with Mas(folder=tmp_path, on_log=lambda text, level: logs.append(text)) as mas:
        echo = mas.add_agent("echo", Echo)
        mas.add_agent("lone", lone)
        box = mas.mailbox("tester")
        box.send("echo", "tell", "hello(1)")
        assert str((await box.get(timeout=1)).content) == 'heard("hello")'
        await mas.until_idle()
        with pytest.raises(UsageError, match="agent echo is a Python agent"):
            echo.achieve("x")
        box.send("echo", "achieve", "hello(1)")
        await mas.until_idle()
        assert echo.ended
        assert [agent.name for agent in mas.agents] == ["lone"]
    assert len(logs) == 1
    assert logs[0].startswith("[echo] error: the agent was ended by ValueError: achieve")
