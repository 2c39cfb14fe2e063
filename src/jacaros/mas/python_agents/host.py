"""The host of a Python agent: its tasks, messages and session."""

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from jacaros.agents.language.loader import parse_literals
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.language.nodes import Literal as LiteralNode
from jacaros.agents.mind.state.act import Completion, SpeechAct
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.python.agent import Literal, literal_of
from jacaros.agents.python.python_agent import PythonAgent
from jacaros.agents.terms.values import Term
from jacaros.artifacts.env.errors import WorkspaceError
from jacaros.artifacts.kernel.faults import error_text
from jacaros.artifacts.presence.presence import OperationObserver
from jacaros.artifacts.presence.session import Session
from jacaros.errors import JacarosError
from jacaros.mas.agent_host import AgentHost, Run
from jacaros.mas.agent_options import mind_options
from jacaros.mas.coroutines import without_exit
from jacaros.mas.deployment import AgentSpec
from jacaros.mas.python_agents.faults import fault_lines, place_of_fault
from jacaros.mas.python_agents.handlers import Handlers
from jacaros.mas.python_agents.messaging import Messaging
from jacaros.mas.python_agents.task_activity import TaskActivity
from jacaros.runtime.clock import Clock

_PATIENCE = 5.0
"""Seconds that an agent has for its clean-up at the end of a run."""


class PythonAgentHost(AgentHost):
    """Runs one Python agent. It has tasks where other agents have a mind with cycles.

    Args:
        agent: object of the user's class.
        spec: its declaration in the project.
        run: its run.
        seed: seed of the agent's random numbers.
    """

    def __init__(self, agent: PythonAgent, spec: AgentSpec, run: Run, seed: str) -> None:
        super().__init__(spec.name, run, seed)
        name, self.options = spec.name, spec.options
        self.beliefs = _beliefs(spec)
        self.open_session: Callable[[], Session] | None = None
        self.task_activity = TaskActivity(run.activity, self._settled)
        self.mail = Messaging(name, self.send, run.agent_names, run.clock, run.activity, self.task_activity)
        self.mind = _Task(self, mind_options(spec.options))
        self._agent = agent
        self._handlers = Handlers(agent, self.mail, self.task_activity, self.start)
        self._session: Session | None = None
        self._observer: OperationObserver | None = None
        self._tasks: dict[asyncio.Task[Any], None] = {}
        self._leaving = self._closed = False
        agent._host = self  # pyright: ignore[reportAttributeAccessIssue] - `send` is a field that holds a function

    @property
    def agent(self) -> PythonAgent:
        """Object of the user's class."""
        return self._agent

    def observe(self, observer: OperationObserver) -> None:
        """Report to *observer*, from now on, the agent's ``run``, its operations, and the state of its trees."""
        self._observer = observer
        if self._session is not None:
            self._session.observer = observer

    # ---- lifecycle

    def begin(self) -> None:
        """Start the agent in the next turn of the event loop."""
        if self._leaving:
            return
        if self._handlers.wanted:
            self.start(self._handlers.serve())
        self.start(self._main(self._handlers.wanted))

    async def _main(self, stays: bool) -> None:
        with self._observed():
            await self._agent.run()
        if not stays and not self._leaving:
            self.start(self._when_all_is_over())

    @contextmanager
    def _observed(self) -> Iterator[None]:
        tell, told = self._observer, f"{type(self._agent).__name__}.run"
        if tell is None:
            yield
            return
        tell("executing", told, self, "")
        try:
            yield
        except asyncio.CancelledError:
            tell("dropped", told, self, "")
            raise
        except BaseException as error:
            tell("failed", told, self, error_text(error))
            raise
        tell("achieved", told, self, "")

    async def _when_all_is_over(self) -> None:
        """Refuse messages as soon as no task of the agent is left to read them."""
        own = asyncio.current_task()
        with self.task_activity.waiting():
            while others := [task for task in self._tasks if task is not own]:
                await asyncio.wait(others)
        self.mail.close()

    def start(self, work: Coroutine[Any, Any, Any]) -> "asyncio.Task[Any]":
        """Run a coroutine of the agent. An exception in it ends the agent."""
        if self._leaving:
            work.close()
            raise JacarosError(f"agent {self.name} is shutting down and cannot start tasks")
        task = asyncio.get_running_loop().create_task(without_exit(work), name=f"agent {self.name}")
        self._tasks[task] = None
        self.task_activity.add(task)
        # A task that is cancelled before its first step has not awaited the coroutine.
        task.add_done_callback(lambda _: work.close())
        task.add_done_callback(self._done)
        return task

    def _done(self, task: "asyncio.Task[Any]") -> None:
        self._tasks.pop(task, None)
        error = None if task.cancelled() else task.exception()
        # Ctrl+C ends the run, wherever it is raised.
        if error is not None and not self._closed and not isinstance(error, KeyboardInterrupt):
            self._failed(error)
        if self._leaving and not self._tasks:
            self._shut()
        self._settled()

    def _failed(self, error: BaseException) -> None:
        self.system.goal_lost()
        for line in fault_lines(error):
            self.system.console.log(f"[{self.name}] {line}", "error")
        if not self._leaving:
            self.system.end_agent(self.name)

    def run(self, fuel: int) -> bool:
        """Do nothing: the event loop runs its tasks."""
        return False

    def _settled(self) -> None:
        """Check whether the run is idle, as after the turn of any agent."""
        self.system.scheduler.make_ready(self)

    def halt(self) -> None:
        """Cancel its tasks and operations. Their ``finally`` blocks run, and may still act and print."""
        if self._leaving:
            return
        super().halt()
        self._leaving = True
        for task in tuple(self._tasks):
            task.cancel()
        if self._session is not None:
            self._session.cancel_operations()

    def end(self) -> None:
        """Leave the environment, after its tasks have ended."""
        super().end()
        if self._tasks:
            self.system.clock.call_later(_PATIENCE, self._shut)
        else:
            self._shut()

    async def close(self) -> None:
        """Wait until its tasks have finished their clean-up."""
        await super().close()
        if self._tasks:
            await asyncio.wait(tuple(self._tasks), timeout=_PATIENCE)
        self._shut()

    def _shut(self) -> None:
        if self._closed:
            return
        self._closed = True
        if self._tasks:
            what = f"the agent did not end within {_PATIENCE:g} s of its cancellation"
            self.system.console.log(f"[{self.name}] warning: {what}", "warning")
        if self._session is not None:
            self._session.close()

    def _check(self) -> None:
        """Stop an agent that would continue after its end.

        Raises:
            JacarosError: everything is closed.
        """
        if self._closed:
            raise JacarosError(f"agent {self.name} has ended")

    # ---- time

    @property
    def clock(self) -> Clock:
        """The run's clock."""
        return self.system.clock

    async def sleep(self, seconds: float) -> None:
        """Wait on the run's clock."""
        self._check()
        with self.task_activity.under_way():
            await self.system.clock.sleep(seconds)
        self.system.clock.busy(1)

    async def turn(self) -> None:
        """Let other tasks run. It counts as a reasoning cycle, so that a virtual clock advances."""
        self._check()
        self.system.clock.busy(1)
        with self.task_activity.under_way():
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
                    "the project has no environment (add the line `environment: jacaros.Environment` to the project "
                    "file)"
                )
            self._session = self.open_session()
            self._session.observer = self._observer
            self._handlers.listen(self._session)
        return self._session

    # ---- output

    def print(self, text: str) -> None:
        """Print a line of output, also while the agent is ending."""
        if not self._closed and (self._tasks or not self._ended):
            self.system.console.print(self.name, text)


class _Task:
    """Replaces a mind, for the run."""

    def __init__(self, host: PythonAgentHost, options: Options) -> None:
        self.stopped = False
        self.options = options
        self._host = host

    def start(self) -> None:
        """Start the agent."""
        self._host.begin()

    def post_goal(self, goal: Term) -> None:
        """Do nothing: it has no goals."""

    def adopt(self, goals: Iterable[LiteralNode]) -> None:
        """Do nothing: it has no goals."""

    def run(self, fuel: int) -> bool:
        """Do nothing: it has no cycles."""
        return False

    def receive(self, message: SpeechAct) -> None:
        """Receive a message."""
        self._host.mail.inbox.put(message)

    def accept_kill(self, killer: str) -> bool:
        """Return whether another agent may kill this one."""
        try:
            return bool(self._host.agent.accept_kill(killer))
        except Exception as error:
            self._host.log("error", f"accept_kill: {error_text(error)}{place_of_fault(error)}")
            return True

    def complete(self, act_id: int, completion: Completion) -> None:
        """Do nothing: it acts through its session."""

    def shut_down_in(self, milliseconds: float) -> None:
        """Do nothing: it is cancelled at the end."""


def _beliefs(spec: AgentSpec) -> tuple[Literal, ...]:
    if not spec.beliefs.strip():
        return ()
    return tuple(
        literal_of(lower_value(node))
        for node in parse_literals(spec.beliefs, f"the declaration of {spec.name}")
    )
