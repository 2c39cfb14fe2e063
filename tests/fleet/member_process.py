"""One member of a fleet on Zenoh, in a process of its own, which notes what happens. Orders come from standard input.

Usage: member_process.py FLEET NAME LOG [ROUTER]

An order is a line of JSON: a name and arguments of a method of `Orders`.
"""

import asyncio
import json
import sys
import time
from itertools import count
from typing import ClassVar

import jacaros
from jacaros import Mas
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String
from jacaros.artifacts import Artifact, operation
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.property import Observation
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.fleet.network import Network
from jacaros.fleet.on_zenoh import ZenohCarrier


class Log:
    """Writes events, each with the time."""

    def __init__(self, path: str) -> None:
        self._file = open(path, "a", buffering=1, encoding="utf-8")  # noqa: SIM115 - as long as the process

    def __call__(self, event: str, *data: object) -> None:
        self._file.write(json.dumps([time.time(), event, *data]) + "\n")


class Counter(Artifact):
    """Notes the effects of its operations, and changes a property quickly."""

    book: ClassVar[Log]

    def init(self) -> None:
        self.define_property("count", 0)

    @operation
    def note(self, number: int) -> None:
        self.book("effect", number)
        self.update_property("count", self.value("count") + 1)

    @operation
    async def spin(self, updates: int, size: int) -> None:
        """Change a large property, as a laser scanner does."""
        self.define_property("scan", 0, "")
        for number in range(1, updates + 1):
            self.update_property("scan", number, "x" * size)
            await self.sleep(0.001)


class Agent:
    """Stands for an agent."""

    def __init__(self, name: str, log: Log) -> None:
        self.name, self.agent, self._log = name, name, log
        self.slow = 0.0

    def receive(self, message: SpeechAct) -> None:
        if message.performative == "undelivered":
            self._log(
                "undelivered", message.in_reply_to, text(message.content).rpartition(",")[2].rstrip(")")
            )
        else:
            self._log("received", message.id)
            if self.slow:
                time.sleep(self.slow)  # the fault: its whole process is busy

    def observe(self, seen: Observation) -> None:
        for each in (*(new for _, new in seen.changed), *seen.added):
            self._log("property", each.name, each.values[0])

    def halt(self) -> None: ...

    def end(self) -> None: ...

    async def close(self) -> None: ...


class Orders:
    """What the test can order."""

    def __init__(self, mas: Mas, agent: Agent, log: Log) -> None:
        self._mas, self._agent, self._log = mas, agent, log
        self._numbers = count(1)

    async def send(self, to: str, messages: int, each_second: float, size: int = 1) -> None:
        """Send numbered messages to the agent of a member."""
        begin = time.monotonic()
        for sent in range(messages):
            self._send(to, size)
            ahead = begin + (sent + 1) / each_second - time.monotonic()
            if ahead > 0 or sent % 100 == 99:
                await asyncio.sleep(max(0.0, ahead))
        self._log("sent all")

    def _send(self, to: str, size: int) -> None:
        number = f"{self._agent.name}{next(self._numbers)}"
        message = SpeechAct("tell", self._agent.name, f"agent_{to}@{to}", String("x" * size), number)
        try:
            accepted = self._mas.system.deliver(message)
        except Failure as failure:
            self._log("refused", number, text(failure.annotations[0]))
        else:
            self._log("sent" if accepted else "unknown", number)

    async def operate(self, of: str, operations: int, pause: float) -> None:
        """Run numbered operations of the counter of a member."""
        for _ in range(operations):
            number = next(self._numbers)
            self._run(of, "note", number, number)
            await asyncio.sleep(pause)
        self._log("operated all")

    def _run(self, of: str, operation: str, number: int, *arguments: object) -> None:
        def done(outcome: OperationOutcome) -> None:
            self._log("outcome", number, "ok" if outcome.ok else str(outcome.reason))

        environment = self._mas.environment
        try:
            artifact = environment.workspace(f"/main/lab_{of}").lookup("counter")
        except jacaros.OperationFailed:
            self._log("missing", number)
            return
        self._log("operation", number)
        environment.execute(OperationRequest(artifact, operation, arguments, self._agent.name, None, done))

    async def spin(self, updates: int, size: int) -> None:
        """Change a large property of the own counter quickly."""
        self._run(self._agent.name.removeprefix("agent_"), "spin", 0, updates, size)

    async def focus(self, of: str) -> None:
        """Observe the counter of a member."""
        for _ in range(200):
            if self._knows(of):
                break
            await asyncio.sleep(0.05)
        workspace = self._mas.environment.workspace(f"/main/lab_{of}")
        done = asyncio.get_running_loop().create_future()
        workspace.focus(workspace.lookup("counter"), self._agent, done.set_result)
        self._log("focused", (await done).ok)

    def _knows(self, of: str) -> bool:
        try:
            return bool(self._mas.environment.workspace(f"/main/lab_{of}").lookup("counter"))
        except jacaros.OperationFailed:
            return False

    async def slow(self, seconds: float) -> None:
        """Need this time for each message."""
        self._agent.slow = seconds


async def main(fleet: str, name: str, path: str, *routers: str) -> None:
    """Run the member until the end of its standard input."""
    log = Log(path)
    Counter.book = log
    members: list[Member] = []

    def joined(member: Member) -> None:
        members.append(member)
        for each in member.peers.values():
            if each.is_there and each.picture is not None:
                log("member", each.name, "joined")
        member.watchers.append(lambda who, state: log("member", who, state))

    join = joining(ZenohCarrier(Network(fleet, name, routers=routers)), name, joined=joined)
    try:
        async with Mas(name=name, join=join, on_log=lambda line, level: log("log", level, line)) as mas:
            agent = Agent(f"agent_{name}", log)
            mas.system.directory.add(agent.name, agent)  # type: ignore[arg-type]
            mas.add_artifact_types(Counter)
            await mas.make_artifact("counter", Counter, workspace=mas.create_workspace(f"lab_{name}"))
            log("began", sorted(members[0].peers))
            await _obey(Orders(mas, agent, log), members[0], log)
    except jacaros.JacarosError as error:
        log("failed", str(error))


async def _obey(orders: Orders, member: Member, log: Log) -> None:
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    running = []
    while line := await reader.readline():
        order, *arguments = json.loads(line)
        if order == "backlog":
            log("backlog", max((each.backlog for each in member.peers.values()), default=0))
        else:
            running.append(asyncio.create_task(getattr(orders, order)(*arguments)))
    for each in running:
        each.cancel()


if __name__ == "__main__":
    jacaros.run(main(*sys.argv[1:]))
