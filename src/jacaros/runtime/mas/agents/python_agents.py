"""Agents in Python: the class that a project names, and the host with tasks, handlers, messages and a session."""

import asyncio
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from inspect import isawaitable
from types import ModuleType
from typing import Any

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.loader import parse_literals
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.language.nodes import Literal as LiteralNode
from jacaros.agents.mind.state.act import Activity, SpeechAct
from jacaros.agents.python.agent import Literal, ReceivedMessage, literal_of, overridden
from jacaros.agents.python.python_agent import PythonAgent
from jacaros.artifacts.env.errors import WorkspaceError
from jacaros.artifacts.kernel.faults import error_text
from jacaros.artifacts.presence.presence import OperationObserver
from jacaros.artifacts.presence.session import Session
from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.python_modules import UNSEEN, ModuleUnreadable, ProjectModules
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.mas.agents.gate import Gate
from jacaros.runtime.mas.agents.host import ADD_ENVIRONMENT, PATIENCE, AgentHost, Run, without_exit
from jacaros.runtime.mas.agents.options import mind_options
from jacaros.runtime.mas.console import place_of_fault, places_of_fault
from jacaros.runtime.mas.deployment import AgentSpec, ProjectError
from jacaros.runtime.mas.directory import NAME as DIRECTORY_NAME
from jacaros.runtime.mas.environment import OperationAccount, RunEnvironment
from jacaros.runtime.mas.messaging import Messaging


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
        self.options = spec.options
        self.beliefs = _beliefs(spec)
        self.open_session: Callable[[], Session] | None = None
        self.task_activity = TaskActivity(run.activity, self._settled)
        waiting = self.task_activity.waiting
        self.mail = Messaging(spec.name, self.send, run.agent_names, run.clock, run.activity, waiting)
        self.verbose = mind_options(spec.options).verbose
        self._agent = agent
        self._on_message = overridden(agent, PythonAgent, "on_message")
        self._on_signal = overridden(agent, PythonAgent, "on_signal")
        self._on_property = overridden(agent, PythonAgent, "on_property")
        self._events: asyncio.Queue[Callable[[], Any]] = asyncio.Queue()
        """What its handlers are called with, in the order of events."""
        self._session: Session | None = None
        self._observer: OperationObserver | None = None
        self._tasks: dict[asyncio.Task[Any], None] = {}
        self._leaving = self._closed = False
        self._gate = Gate()
        agent._host = self  # pyright: ignore[reportAttributeAccessIssue] - `send` is a field that holds a function

    @property
    def mind(self) -> None:
        """None: it has tasks instead."""

    def observe(self, observer: OperationObserver) -> None:
        """Report to *observer*, from now on, the agent's ``run``, its operations, and the state of its trees."""
        self._observer = observer
        if self._session is not None:
            self._session.observer = observer

    # ---- lifecycle

    def hold(self) -> None:
        """Hold its tasks before their next steps, and pause its operations, until `release`."""
        self._gate.close()
        if self._session is not None:
            self._session.hold()

    def release(self) -> None:
        """Let it continue."""
        self._gate.open()
        if self._session is not None:
            self._session.release()

    def begin(self, goals: Sequence[LiteralNode] | None) -> None:
        """Start the agent in the next turn of the event loop. It has no goals."""
        del goals
        if self._leaving:
            return
        has_handlers = any((self._on_message, self._on_signal, self._on_property))
        if has_handlers:
            self.start(self._handle_events())
        self.start(self._main(has_handlers))

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
        task = asyncio.get_running_loop().create_task(
            without_exit(self._gate.through(work)), name=f"agent {self.name}"
        )
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
        for line in _fault_lines(error):
            self.system.console.log(f"[{self.name}] {line}", "error")
        if not self._leaving:
            self.system.end_agent(self.name)

    def receive(self, message: SpeechAct) -> None:
        """Receive a message."""
        if not self._ended:
            self.mail.receive(message)

    def accept_kill(self, killer: str) -> bool:
        """Return whether another agent may kill this one."""
        try:
            return bool(self._agent.accept_kill(killer))
        except Exception as error:
            self.log("error", f"accept_kill: {error_text(error)}{place_of_fault(error)}")
            return True

    def shut_down_in(self, seconds: float) -> None:
        """Do nothing: it is cancelled at the end."""

    def _settled(self) -> None:
        """Check whether the run is idle, as after the turn of any agent."""
        self.ready()

    def halt(self) -> None:
        """Cancel its tasks and operations. Their ``finally`` blocks run, and may still act and print."""
        if self._leaving:
            return
        super().halt()
        self._leaving = True
        self._gate.open()
        for task in tuple(self._tasks):
            task.cancel()
        if self._session is not None:
            self._session.cancel_operations()

    def end(self) -> None:
        """Leave the environment, after its tasks have ended."""
        super().end()
        if self._tasks:
            self.system.clock.call_later(PATIENCE, self._shut)
        else:
            self._shut()

    async def close(self) -> None:
        """Wait until its tasks have finished their clean-up."""
        await super().close()
        if self._tasks:
            await asyncio.wait(tuple(self._tasks), timeout=PATIENCE)
        self._shut()

    def _shut(self) -> None:
        if self._closed:
            return
        self._closed = True
        if self._tasks:
            what = f"the agent did not end within {PATIENCE:g} s of its cancellation"
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

    # ---- handlers

    async def _handle_events(self) -> None:
        """Call the handlers, one at a time, until the agent ends."""
        if self._on_message is not None:
            self.start(self._read())
        while True:
            with self.task_activity.waiting():
                handle = await self._events.get()
            done = handle()
            if isawaitable(done):
                await done

    async def _read(self) -> None:
        while True:
            message = await self.mail.next_message(None)
            self._events.put_nowait(partial(self._handle, message))

    async def _handle(self, message: ReceivedMessage) -> None:
        assert self._on_message is not None
        answer = self._on_message(message)
        if isawaitable(answer):
            answer = await answer
        if message.is_question and not message.answered:
            message.reply(answer)

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
            await self._gate.passed()
        self.system.clock.busy(1)

    async def turn(self) -> None:
        """Let other tasks run. It counts as a reasoning cycle, so that a virtual clock advances."""
        self._check()
        self.system.clock.busy(1)
        with self.task_activity.under_way():
            await asyncio.sleep(0)
            await self._gate.passed()  # for tasks that the agent has not started as its own, too

    # ---- the environment

    def situate(self, spec: AgentSpec, where: RunEnvironment) -> None:
        """Give the agent a session, which joins and focuses what the project declares."""
        self.open_session = lambda: Session(where.environment, self.name, account=self.task_activity)
        if spec.join or spec.focus:
            where.situate(self.session.presence, spec)

    @property
    def session(self) -> Session:
        """The agent's session in the environment.

        Raises:
            WorkspaceError: the project has no environment.
        """
        if self._session is None:
            if self.open_session is None:
                raise WorkspaceError(f"the project has no environment ({ADD_ENVIRONMENT})")
            self._session = self.open_session()
            self._session.observer = self._observer
            if (on_signal := self._on_signal) is not None:
                self._session.on_signal(lambda signal: self._events.put_nowait(partial(on_signal, signal)))
            if (on_change := self._on_property) is not None:
                self._session.on_change(lambda change: self._events.put_nowait(partial(on_change, change)))
        return self._session

    # ---- output

    def print(self, text: str) -> None:
        """Print a line of output, also while the agent is ending."""
        if not self._closed and (self._tasks or not self._ended):
            self.system.console.print(self.name, text)


def _beliefs(spec: AgentSpec) -> tuple[Literal, ...]:
    if not spec.beliefs.strip():
        return ()
    return tuple(
        literal_of(lower_value(node))
        for node in parse_literals(spec.beliefs, f"the declaration of {spec.name}")
    )


def _fault_lines(error: BaseException) -> list[str]:
    if isinstance(error.__cause__, SystemExit):
        error = error.__cause__
    places = places_of_fault(error)
    lines = [f"error: the agent was ended by {error_text(error)}{place_of_fault(error)}"]
    lines += [f"  called from {place}" for place in reversed(places[:-1])]
    for each in error.exceptions if isinstance(error, BaseExceptionGroup) else ():
        lines.append(f"  {error_text(each)}{place_of_fault(each)}")
    return lines


class TaskActivity(OperationAccount):
    """Counts the tasks of one agent. The agent is busy unless all of them wait for others.

    A task waits for others while it is in `waiting`: for a message, a signal, a condition. A task that waits for
    anything else, such as a thread or a socket, is busy. But if it has started tasks that are not the agent's own (with
    ``asyncio.gather`` or a task group), and all of them wait for others, so does it.

    Args:
        activity: activity of the run.
        settled: called whenever the agent may have become idle.
    """

    def __init__(self, activity: Activity, settled: Callable[[], None]) -> None:
        super().__init__(activity, settled)
        self._own: set[asyncio.Task[Any]] = set()
        self._others: set[asyncio.Task[Any]] = set()
        self._waiting: dict[asyncio.Task[Any], int] = {}
        self._counted = False

    @contextmanager
    def under_way(self) -> Iterator[None]:
        """Context of something with an end."""
        self.begin()
        try:
            yield
        finally:
            self.end()

    def add(self, task: "asyncio.Task[Any]") -> None:
        """Add a task of the agent."""
        self._own.add(task)
        task.add_done_callback(self._gone)
        self._count()

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Context of a wait that something else must end."""
        task = asyncio.current_task()
        assert task is not None
        if task not in self._own and task not in self._others:
            self._others.add(task)
            task.add_done_callback(self._gone)
        self._waiting[task] = self._waiting.get(task, 0) + 1
        self._count()
        try:
            yield
        finally:
            self._waiting[task] -= 1
            if not self._waiting[task]:
                del self._waiting[task]
            self._count()

    def _gone(self, task: "asyncio.Task[Any]") -> None:
        self._own.discard(task)
        self._others.discard(task)
        self._count()

    def _count(self) -> None:
        busy = self._is_busy()
        if busy and not self._counted:
            self._activity.begin()
        elif not busy and self._counted:
            self._activity.end()
            self._settled()
        self._counted = busy

    def _is_busy(self) -> bool:
        if any(task not in self._waiting for task in self._others):
            return True
        return not self._others and any(task not in self._waiting for task in self._own)


def agent_class(modules: ProjectModules, spec: AgentSpec) -> type[PythonAgent]:
    """Return the class of an agent: the one in its file, the one that the project names, or the one with the agent's name.

    Raises:
        ProjectError: the file has no such class, or several, or cannot be imported.
    """
    if spec.python_class is not None:
        return spec.python_class
    module = _module(modules, spec)
    found = _classes(module)
    wanted = spec.options.get("class") or spec.agent_class
    file = spec.source_path
    if not found or (wanted is not None and wanted.rpartition(".")[2] not in found):
        for name in [name for name, value in vars(module).items() if value is UNSEEN] or [""]:
            modules.require_seen(module, name)
    if not found:
        raise _wrong(spec, f"no subclass of jacaros.PythonAgent in {file}")
    if wanted is not None:
        if wanted.rpartition(".")[2] in found:
            return found[wanted.rpartition(".")[2]]
        help = suggestion(wanted, found, f"it has {', '.join(found)}")
        raise _wrong(spec, f"no subclass `{wanted}` of jacaros.PythonAgent in {file}", help)
    if len(found) == 1:
        return next(iter(found.values()))
    for name in (spec.declared_name, spec.name, file.stem):
        meant = [each for each in found if each.lower() == name.replace("_", "").lower()]
        if len(meant) == 1:
            return found[meant[0]]
    raise _wrong(
        spec,
        f"ambiguous class of agent `{spec.declared_name}`: {file} has several, and none has the agent's name",
        f"name one of {', '.join(found)}: `[class=...]` in a .mas2j file, `class: ...` in a .jcm file",
    )


def _module(modules: ProjectModules, spec: AgentSpec) -> ModuleType:
    path = spec.source_path.resolve()
    for folder in modules.folders:
        if path.is_relative_to(folder):
            name = ".".join(path.relative_to(folder).with_suffix("").parts)
            if modules.place(name) == path:
                try:
                    return modules.load(name)[0]
                except ModuleUnreadable as wrong:
                    raise _wrong(spec, str(wrong)) from wrong
    raise _wrong(spec, f"cannot import {spec.source_path}: its folders do not have valid Python names")


def _classes(module: ModuleType) -> dict[str, type[PythonAgent]]:
    """Return the agent classes that a module defines or, without any, those that it imports."""
    known = {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type) and issubclass(value, PythonAgent) and value is not PythonAgent
    }
    own = {name: value for name, value in known.items() if value.__module__ == module.__name__}
    return own or known


def check_python_agent(
    modules: ProjectModules, spec: AgentSpec, warn: Callable[[Diagnostic], object]
) -> None:
    """Check the class of an agent, and warn about goals, which have no effect.

    Raises:
        ProjectError: the class cannot be found.
    """
    if spec.goals.strip():
        message = f"`goals` of agent `{spec.declared_name}` has no effect: it is a Python agent"
        warn(Diagnostic("warning", message, spec.span))
    if spec.name == DIRECTORY_NAME:
        raise _wrong(spec, "the directory facilitator `df` cannot be a Python agent")
    agent_class(modules, spec)


def make_python_agent(modules: ProjectModules, spec: AgentSpec, run: Run, seed: str) -> PythonAgentHost:
    """Return the host of an agent written in Python, not yet started.

    Raises:
        ProjectError: the class cannot be found, or its constructor fails.
    """
    kind = agent_class(modules, spec)
    try:
        agent = kind()
    except Exception as error:
        message = f"cannot create {kind.__name__}: {type(error).__name__}: {error}{place_of_fault(error)}"
        raise _wrong(spec, message) from error
    return PythonAgentHost(agent, spec, run, seed)


def _wrong(spec: AgentSpec, message: str, help: str | None = None) -> ProjectError:
    return ProjectError([Diagnostic("error", message, spec.span, help)])
