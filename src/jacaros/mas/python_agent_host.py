"""What runs an agent written in Python: its tasks, its messages, its place in the environment."""

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Mapping
from functools import partial
from inspect import isawaitable
from typing import Any

from jacaros.asl.nodes import Literal as LiteralNode
from jacaros.bdi.act import Completion, Percept
from jacaros.bdi.options import Options
from jacaros.bdi.speech_act import SpeechAct, message_id
from jacaros.clock import Clock
from jacaros.env.errors import WorkspaceError
from jacaros.env.session import Session
from jacaros.errors import JacarosError
from jacaros.extension.conversation import ReceivedMessage
from jacaros.extension.errors import UnknownAgent
from jacaros.extension.literal import Literal
from jacaros.extension.python_agent import PythonAgent, overridden
from jacaros.mas.activity import AgentTimer
from jacaros.mas.agent_host import AgentHost, Run
from jacaros.mas.attendance import Attendance
from jacaros.mas.coroutines import without_exit
from jacaros.mas.inbox import Inbox
from jacaros.mas.python_faults import fault_lines
from jacaros.terms.values import Term

_PATIENCE = 5.0
"""Seconds that an agent has at the end of a run to put its things in order."""


class PythonAgentHost(AgentHost):
    """Runs one agent written in Python; it has a task where other agents have a mind that makes cycles.

    Args:
        agent: the object of the user's class.
        name: of the agent.
        run: the run that it belongs to.
        seed: of the agent's own generator of random numbers.
        mind_options: how much it tells.
        options: those of the project file.
        beliefs: those of the project file.
    """

    def __init__(
        self,
        agent: PythonAgent,
        name: str,
        run: Run,
        seed: str,
        mind_options: Options,
        options: Mapping[str, str],
        beliefs: tuple[Literal, ...],
    ) -> None:
        super().__init__(name, run, seed)
        self.options, self.beliefs = options, beliefs
        self.open_session: Callable[[], Session] | None = None
        self.attendance = Attendance(run.activity, self._settled)
        self.inbox = Inbox()
        self.mind = _Task(self, mind_options)
        self._agent = agent
        self._handlers = _Handlers(self, agent)
        self._session: Session | None = None
        self._tasks: dict[asyncio.Task[Any], None] = {}
        self._messages = 0
        self._leaving = False
        agent._host = self

    @property
    def agent(self) -> PythonAgent:
        """The object of the user's class."""
        return self._agent

    # ---- its life

    def begin(self) -> None:
        """Let the agent begin, in the next turn of the loop."""
        if self._leaving:
            return
        if self._handlers.wanted:
            self.start(self._handlers.serve())
        self.start(self._main(self._handlers.wanted))

    async def _main(self, stays: bool) -> None:
        await self._agent.run()
        if not stays:
            self.start(self._when_all_is_over())

    async def _when_all_is_over(self) -> None:
        """Refuse messages as soon as nothing of the agent is left to read them."""
        own = asyncio.current_task()
        with self.attendance.waiting():
            while others := [task for task in self._tasks if task is not own]:
                await asyncio.wait(others)
        self.inbox.close(self._refuse)

    def start(self, work: Coroutine[Any, Any, Any]) -> "asyncio.Task[Any]":
        """Run a coroutine of the agent; its exception ends the agent."""
        if self._leaving:
            work.close()
            raise JacarosError(f"agent {self.name} is ending, and starts nothing any more")
        task = asyncio.get_running_loop().create_task(without_exit(work), name=f"agent {self.name}")
        self._tasks[task] = None
        self.attendance.add(task)
        # A task that is cancelled before its first step never came to await the coroutine.
        task.add_done_callback(lambda _: work.close())
        task.add_done_callback(self._done)
        return task

    def _done(self, task: "asyncio.Task[Any]") -> None:
        self._tasks.pop(task, None)
        error = None if task.cancelled() else task.exception()
        if error is not None:
            self._failed(error)
        if self._leaving and not self._tasks and self._session is not None:
            self._session.close()
        self._settled()

    def _failed(self, error: BaseException) -> None:
        for line in fault_lines(error):
            self._run.console.log(f"[{self.name}] {line}", "error")
        if not self._leaving:
            self._run.end_agent(self.name)

    def run(self, fuel: int) -> bool:
        """Nothing: the loop gives its tasks their turns."""
        return False

    def _settled(self) -> None:
        """Have it looked whether the run is idle, as after the turn of any agent."""
        self._run.scheduler.make_ready(self)

    def halt(self) -> None:
        """Cancel its tasks and operations; ``finally`` blocks run, and may still act and print."""
        if self._leaving:
            return
        super().halt()
        self._leaving = True
        for task in tuple(self._tasks):
            task.cancel()
        if self._session is not None:
            self._session.cancel_operations()

    def end(self) -> None:
        """Leave the environment; when it has tasks, as soon as they are over."""
        super().end()
        if self._session is not None and not self._tasks:
            self._session.close()

    async def close(self) -> None:
        """Wait until its tasks have put their things in order."""
        await super().close()
        if self._tasks:
            _, left = await asyncio.wait(tuple(self._tasks), timeout=_PATIENCE)
            if left:
                told = (
                    f"[{self.name}] warning: the agent did not end within {_PATIENCE:g} s of its cancellation"
                )
                self._run.console.log(told, "warning")
        if self._session is not None:
            self._session.close()

    # ---- time

    @property
    def clock(self) -> Clock:
        """The run's clock."""
        return self._run.clock

    async def sleep(self, seconds: float) -> None:
        """Wait on the run's clock."""
        with self.attendance.under_way():
            await self._run.clock.sleep(seconds)
        self._run.clock.busy(1)

    async def turn(self) -> None:
        """Let others have their turn; it counts as a reasoning cycle, so that a virtual clock moves on."""
        self._run.clock.busy(1)
        with self.attendance.under_way():
            await asyncio.sleep(0)

    # ---- the environment

    @property
    def session(self) -> Session:
        """The agent's session in the environment.

        Raises:
            WorkspaceError: the project has no environment.
        """
        if self._session is None:
            if self.open_session is None:
                raise WorkspaceError(
                    "the project has no environment (a line `environment: jacaros.Environment` in the project "
                    "file gives it one)"
                )
            self._session = self.open_session()
            self._handlers.listen(self._session)
        return self._session

    # ---- people

    def print(self, text: str) -> None:
        """Show a line of output; also while the agent is ending."""
        if self._tasks or not self._ended:
            self._show(text)

    # ---- messages

    def say(self, receiver: str, performative: str, content: Term, reply: str | None = None) -> None:
        """Send a message.

        Raises:
            UnknownAgent: there is no such agent.
        """
        self._say(receiver, performative, content, self._next_id(), reply)

    def _next_id(self) -> str:
        self._messages += 1
        return message_id(self._messages, self.name)

    def _say(self, receiver: str, performative: str, content: Term, id: str, reply: str | None) -> None:
        target = self.name if receiver == "self" else receiver
        sender = "self" if target == self.name else self.name
        if not self.send(SpeechAct(performative, sender, target, content, id, reply)):
            raise UnknownAgent(receiver, self.agent_names())

    async def ask(self, receiver: str, performative: str, content: Term, timeout: float | None) -> SpeechAct:
        """Send a question and wait for the answer.

        Raises:
            UnknownAgent: there is no such agent.
            TimeoutError: no answer came within *timeout* seconds.
        """
        id = self._next_id()
        answer = self.inbox.ask(id)
        try:
            self._say(receiver, performative, content, id, None)
            await self._wait_for(answer, timeout, f"no answer from {receiver}")
            if answer.result().performative == "undelivered":
                raise UnknownAgent(receiver, self.agent_names())
            return answer.result()
        finally:
            self.inbox.forget(id)

    async def next_message(self, timeout: float | None) -> ReceivedMessage:
        """Wait for the next message.

        Raises:
            TimeoutError: none came within *timeout* seconds.
        """
        while (message := self.inbox.take()) is None:
            if timeout is None:
                with self.attendance.waiting():
                    await self.inbox.arrival()
            else:
                arrival = asyncio.ensure_future(self.inbox.arrival())
                try:
                    await self._wait_for(arrival, timeout, "no message")
                finally:
                    arrival.cancel()
        return ReceivedMessage(message, self._answer)

    async def _wait_for(self, future: "asyncio.Future[Any]", timeout: float | None, what: str) -> None:
        if timeout is None:
            with self.attendance.waiting():
                await future
            return
        over = asyncio.get_running_loop().create_future()
        timer = AgentTimer(self._run.clock, self._run.activity, timeout, lambda: over.set_result(None))
        try:
            with self.attendance.waiting():
                await asyncio.wait((future, over), return_when=asyncio.FIRST_COMPLETED)
        finally:
            timer.cancel()
            over.cancel()
        if not future.done():
            raise TimeoutError(f"{what} within {timeout:g} s")

    def _answer(self, question: SpeechAct, performative: str, content: Term) -> None:
        receiver = question.sender
        self._say(receiver, performative, content, self._next_id(), question.id)

    def _refuse(self, message: SpeechAct) -> None:
        """Answer what nobody reads any more: a question has no answer."""
        received = ReceivedMessage(message, self._answer)
        if received.is_question:
            try:
                received.reply(None)
            except UnknownAgent:
                return


class _Task:
    """What stands in the place of a mind, for the run."""

    def __init__(self, host: PythonAgentHost, options: Options) -> None:
        self.stopped = False
        self.options = options
        self._host = host

    def start(self) -> None:
        """Let the agent begin."""
        self._host.begin()

    def post_goal(self, goal: Term) -> None:
        """Nothing: it has no goals."""

    def adopt(self, goals: Iterable[LiteralNode]) -> None:
        """Nothing: it has no goals."""

    def run(self, fuel: int) -> bool:
        """Nothing: it makes no cycles."""
        return False

    def receive(self, message: SpeechAct) -> None:
        """Take a message in."""
        self._host.inbox.put(message)

    def accept_kill(self, killer: str) -> bool:
        """Whether another agent may end this one."""
        try:
            return bool(self._host.agent.accept_kill(killer))
        except Exception as error:
            for line in fault_lines(error):
                self._host.log("error", line)
            return True

    def perceive(self, percepts: list[Percept]) -> None:
        """Nothing: it perceives by its session."""

    def complete(self, act_id: int, completion: Completion) -> None:
        """Nothing: it acts by its session."""

    def shut_down_in(self, milliseconds: float) -> None:
        """Nothing: it is cancelled when the time has come."""


class _Handlers:
    """Calls the handlers that an agent has, one after the other, in the order of what happened."""

    def __init__(self, host: PythonAgentHost, agent: PythonAgent) -> None:
        self._host = host
        self._on_message = overridden(agent, "on_message")
        self._on_signal = overridden(agent, "on_signal")
        self._on_property = overridden(agent, "on_property")
        self._waiting: asyncio.Queue[Callable[[], Any]] = asyncio.Queue()

    @property
    def wanted(self) -> bool:
        """Whether the agent has handlers."""
        return any((self._on_message, self._on_signal, self._on_property))

    async def serve(self) -> None:
        """Call them until the agent ends."""
        if self._on_message is not None:
            self._host.start(self._read())
        while True:
            with self._host.attendance.waiting():
                handle = await self._waiting.get()
            done = handle()
            if isawaitable(done):
                await done

    def listen(self, session: Session) -> None:
        """Note what the session of the agent perceives, from its beginning on."""
        if self._on_signal is not None:
            on_signal = self._on_signal
            session.on_signal(lambda signal: self._waiting.put_nowait(partial(on_signal, signal)))
        if self._on_property is not None:
            on_change = self._on_property
            session.on_change(lambda change: self._waiting.put_nowait(partial(on_change, change)))

    async def _read(self) -> None:
        while True:
            message = await self._host.next_message(None)
            self._waiting.put_nowait(partial(self._handle, message))

    async def _handle(self, message: ReceivedMessage) -> None:
        assert self._on_message is not None
        answer = self._on_message(message)
        if isawaitable(answer):
            answer = await answer
        if message.is_question and not message.answered:
            message.reply(answer)
