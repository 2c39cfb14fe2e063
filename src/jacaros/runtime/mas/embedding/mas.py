"""Agents, artifacts and robots in a Python program."""

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar

from jacaros.agents.mind.storage import restore
from jacaros.artifacts.kernel.faults import error_text
from jacaros.look.why.explanation import Explanation
from jacaros.runtime.clock import Clock, VirtualClock, VirtualEventLoop, WallClock, clock_of, new_event_loop
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.agents.programs import source_folders
from jacaros.runtime.mas.console import StandardConsole, entered, place_of_fault
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, FocusSpec
from jacaros.runtime.mas.embedding.given import by_position
from jacaros.runtime.mas.embedding.log_records import log_record, logging_configured
from jacaros.runtime.mas.embedding.notebook import system_html
from jacaros.runtime.mas.embedding.running_agent import RunningAgent
from jacaros.runtime.mas.embedding.waits import RunEnded, RunWaits, UnknownAgent
from jacaros.runtime.mas.launch import chosen_clock, in_fleet, load_deployment, mapped
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import Join, System

if TYPE_CHECKING:
    from jacaros.agents.python.python_agent import PythonAgent
    from jacaros.artifacts.env.artifact import Artifact
    from jacaros.artifacts.env.environment import Environment
    from jacaros.artifacts.env.errors import ArtifactId
    from jacaros.artifacts.env.ports import Workspace
    from jacaros.artifacts.presence.session import Session
    from jacaros.robots.ros.backend import Backend
    from jacaros.robots.world import World
    from jacaros.runtime.mas.debugging.debugger import Debugger
    from jacaros.runtime.mas.embedding.mailbox import Mailbox, PythonMailboxes
    from jacaros.runtime.mas.environment import RunEnvironment

T = TypeVar("T")
_PYTHON = "python"
"""Default sender of messages."""


OnPrint = Callable[[str, str], None]
"""Called with the name of an agent and its output."""

OnLog = Callable[[str, str], None]
"""Called with a line of the log and its level: ``debug``, ``info``, ``warning`` or ``error``."""


class PrintedConsole:
    """The console of an embedded system.

    Args:
        on_print: prints the output of agents. Default: print ``[agent] text`` to standard output.
        on_log: logs lines. Default: the logger ``jacaros`` if the program has configured it, otherwise standard error.
    """

    def __init__(self, on_print: OnPrint | None, on_log: OnLog | None) -> None:
        # Looks up the standard streams on each write: tests and notebooks replace them.
        self._standard = StandardConsole()
        self._on_print = on_print or self._standard.print
        self._on_log = on_log or (log_record if logging_configured() else self._standard.log)
        self._listeners: list[OnPrint] = []

    def listen(self, callback: OnPrint) -> Callable[[], None]:
        """Also call *callback* with all output from now on. Return a function that ends this."""
        return entered(self._listeners, callback)

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output."""
        for callback in (self._on_print, *self._listeners):
            try:
                callback(agent, text)
            except Exception as error:
                self.log(
                    f"error: an on_print callback raised {error_text(error)}{place_of_fault(error)}",
                    "error",
                )

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        try:
            self._on_log(text, level)
        except Exception as error:
            self._standard.log(text, level)
            self._standard.log(
                f"error: an on_log callback raised {error_text(error)}{place_of_fault(error)}", "error"
            )

    def close(self) -> None:
        """Write what waits for a slow reader."""
        self._standard.close()


class Mas:
    """A multi-agent system in a Python program.

    It runs inside ``async with``, on the event loop of the program. Whenever the program awaits something, the agents
    have their turns::

        async def main() -> None:
            async with Mas(seed=1) as mas:
                bob = mas.add_agent("bob", "+!greet(X) <- .print(hello, X).")
                await bob.achieve("greet(world)")

        jacaros.run(main())

    The end of the block ends the run in any case: operations are cancelled, robots stop, and artifacts are disposed.
    All methods must be called in the thread of the event loop. From another thread, use
    `asyncio.run_coroutine_threadsafe` and ``loop.call_soon_threadsafe``. Several systems can share an event loop; they
    share only the clock.

    Args:
        project: a project file (``.mas2j``, ``.jcm``), a program (``.asl``), or a deployment. Default: an empty system.
        options: run options. The clock is that of the event loop, or with ``ros_clock`` that of the ROS graph.
        name: name of an empty system.
        folder: folder of an empty system, in which programs, included files and Python modules are searched. Default: the
            current folder.
        on_print: called with agent and text whenever an agent prints. Default: print ``[agent] text`` to standard output.
        on_log: called with text and level of each line of the log. Default: the logger ``jacaros`` if the program has
            configured it (see `jacaros.runtime.mas.embedding.log_records`), otherwise standard error.
        join: joins the system to a fleet, see `jacaros.fleet.joining`.
        changes: fields of `RunOptions` that override those of *options*, such as ``seed=1, world="patrol"``.

    Raises:
        ProjectError: the project file or a mapping file has errors.
        TypeError: `RunOptions` has no such field.
        UsageError: options exclude each other.
    """

    def __init__(
        self,
        project: str | Path | Deployment | None = None,
        options: RunOptions | None = None,
        *,
        name: str = "mas",
        folder: str | Path | None = None,
        on_print: OnPrint | None = None,
        on_log: OnLog | None = None,
        join: Join | None = None,
        **changes: Any,
    ) -> None:
        self._options = replace(options or RunOptions(), **changes)
        base = Path(folder) if folder is not None else Path.cwd()
        declared = _deployment(project, name, base, self._options.mappings)
        self._deployment = declared if join is None else in_fleet(declared)
        self._options.check()
        self._console = PrintedConsole(on_print, on_log)
        self._join = join
        self._begun: tuple[System, RunWaits] | None = None
        self._stop_watching: Callable[[], None] = lambda: None
        self._at_end: list[Callable[[], None]] = []
        self._agents: dict[str, RunningAgent] = {}
        self._mailboxes: PythonMailboxes | None = None

    async def __aenter__(self) -> Self:
        """Create what the project declares, and start its agents.

        Raises:
            JacarosError: the system cannot start. The text says why.
        """
        if self._begun is not None:
            raise UsageError("this Mas has already run; create another one")
        loop = asyncio.get_running_loop()
        options = replace(self._options, fast=clock_of(loop).virtual)
        options.check()
        clock = chosen_clock(options, self._console, clock_of(loop))
        system = System(self._deployment, clock, self._console, options, join=self._join)
        waits = RunWaits(clock)
        self._begun = system, waits
        system.lifecycle.when_ended = waits.agent_ended
        try:
            await system.start()
        except BaseException:
            await system.close()
            waits.run_ended("the run could not be started")
            raise
        system.when_ended(lambda code: waits.run_ended(f"the run ended with exit code {code}"))
        if isinstance(loop, VirtualEventLoop):
            self._stop_watching = loop.when_stuck(waits.stuck)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        system, waits = self._running
        self._stop_watching()
        waits.run_ended("the run has ended")
        for close in self._at_end:
            close()
        system.end(0)
        try:
            await system.close()
        finally:
            self._console.close()
        if system.error is not None and (error is None or isinstance(error, RunEnded)):
            raise system.error

    @property
    def _running(self) -> tuple[System, RunWaits]:
        if self._begun is None:
            raise RunEnded("the system is not running: use it inside `async with Mas(...) as mas:`")
        self._begun[1].check_thread()
        return self._begun

    @property
    def system(self) -> System:
        """The run itself, for what this class does not offer. Its interface may change with every version.

        Raises:
            RunEnded: the run has not begun.
        """
        return self._running[0]

    def explain(
        self, question: str, at: float | None = None, agent: str = "", robot: str = ""
    ) -> Explanation:
        """Answer a question about the run, such as ``stopped``, ``+alarm(_)`` or ``plan @low``.

        The history begins with the first question, or with the run if the option ``explain`` is set or a program
        mentions ``.why``.

        Args:
            question: as for `jacaros why`.
            at: seconds since the history began. Default: now.
            agent: restrict the answer to this agent.
            robot: restrict the answer to this robot.

        Raises:
            UsageError: the question is not understood.
            RunEnded: the run has not begun.
        """
        return self._running[0].answer(question, at, agent, robot)

    @property
    def _open(self) -> System:
        """The running system.

        Raises:
            RunEnded: it is not running.
        """
        system, _ = self._running
        if system.exit_code is not None:
            raise RunEnded("the run has ended")
        return system

    def stop(self, exit_code: int = 0) -> None:
        """End the run, as ``.stopMAS`` does. The block continues, but no agent has another turn."""
        self._running[0].end(exit_code)

    async def ended(self) -> int:
        """Wait until the run ends (by ``.stopMAS`` or `stop`). Return its exit code.

        Raises:
            InternalError: a defect of JaCaROS ended it.
        """
        system, _ = self._running
        code = await system.ended()
        if system.error is not None:
            raise system.error
        return code

    @property
    def exit_code(self) -> int | None:
        """The exit code of the run; None while it is running."""
        return self._begun[0].exit_code if self._begun is not None else None

    async def until_idle(self, timeout: float | None = None) -> None:
        """Wait until all agents are idle and no operation is running.

        Worlds, batteries and processes of artifacts do not count: they never end.

        Args:
            timeout: time limit in seconds of the run's clock. None: no limit.

        Raises:
            TimeoutError: agents were still busy after the time limit.
            RunEnded: the run ended first.
        """
        system, waits = self._running
        idle: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        stop = system.idleness.watch(lambda: None if idle.done() else idle.set_result(None))
        if system.scheduler.idle:
            system.idleness.look()
        try:
            await waits.wait(idle, lambda: "the agents did not become idle", timeout)
        finally:
            stop()

    # ---- debugging

    @property
    def debugger(self) -> "Debugger":
        """Pauses and steps the run, and sets breakpoints."""
        return self._open.debugger

    # ---- time

    @property
    def clock(self) -> Clock:
        """The run's clock: that of the event loop, or of the ROS graph (``ros_clock``)."""
        return self._running[0].clock

    async def sleep(self, seconds: float) -> None:
        """Wait for this number of seconds of the run's clock."""
        await self.clock.sleep(seconds)

    def _repr_html_(self) -> str:
        hosts = () if self._begun is None else self._begun[0].directory
        return system_html(repr(self), [(host.name, host.mind) for host in hosts])

    def __repr__(self) -> str:
        if self._begun is None:
            return f"<Mas {self._deployment.name}, not begun>"
        code = self.exit_code
        how = "running" if code is None else f"ended with exit code {code}"
        return f"<Mas {self._deployment.name}, {how}>"

    # ---- agents

    def add_agent(
        self,
        name: str,
        program: "str | Path | type[PythonAgent] | None" = None,
        *,
        beliefs: str = "",
        goals: str = "",
        join: Iterable[str] = (),
        focus: "Iterable[str | ArtifactId]" = (),
        options: Mapping[str, str] | None = None,
        agent_class: str | None = None,
        stored: Mapping[str, Any] | None = None,
    ) -> RunningAgent:
        """Create and start an agent. It has its first turn when the caller awaits something.

        Args:
            name: name of the agent.
            program: its program as text; the path of a file (``.asl`` or ``.py``); or the class of a Python agent.
                Default: the file ``NAME.asl``.
            beliefs: further initial beliefs, as text, separated by commas.
            goals: further initial goals, as text, separated by commas.
            join: workspaces that it joins, by path or name.
            focus: artifacts that it focuses before its goals begin: names (searched in all workspaces), paths or ids.
            options: settings such as ``verbose`` and ``events``, as in project files.
            agent_class: a Python class of the project, as in project files.
            stored: the result of `RunningAgent.stored` for an agent with the same program, in this process or another
                one. The agent continues where that one was, so it adopts no initial beliefs and goals. It perceives
                anew what it focuses. An action that was running fails with ``env_failure_reason(interrupted)``.

        Raises:
            ValueError: *stored* has another format, or the program lacks a plan or belief that it uses.
            AslError: the program has errors. The text shows each with its line.
            UsageError: an agent has this name; the name is empty or has spaces or control characters; or the caller is
                not in the thread of the event loop.
            OperationFailed: a workspace or an artifact does not exist.
            RunEnded: the run has ended.
        """
        system = self._open
        spec = AgentSpec(
            name,
            self._source_of(name, program),
            name,
            options=dict(options or {}),
            beliefs=beliefs,
            goals=goals,
            join=tuple(join),
            focus=tuple(map(_focus, focus)),
            agent_class=agent_class,
            python_class=program if isinstance(program, type) else None,
        )
        if not spec.name.isprintable() or not spec.name or " " in spec.name:
            raise UsageError(
                f"invalid agent name {spec.name!r}: it must not be empty or have spaces or control characters"
            )
        if system.directory.find_here(spec.name) is not None:
            raise UsageError(f"duplicate agent name `{spec.name}`")
        if spec.join or spec.focus:
            spec = _placed(spec, self._run_environment.environment)
        tree = system.lifecycle.programs.load(spec, program if isinstance(program, str) else None)
        host = system.lifecycle.add(spec, tree)
        agent = self.agent(spec.name)
        if stored is None:
            system.lifecycle.begin(host, tree)
        else:
            try:
                restore(agent.mind, dict(stored))
            except (UsageError, ValueError):
                agent.kill()
                raise
        return agent

    def _source_of(self, name: str, program: "str | Path | type[PythonAgent] | None") -> Path:
        if isinstance(program, (str, type)):
            return Path(f"<{name}>")  # as diagnostics show it
        wanted = str(program) if program is not None else f"{name}.asl"
        try:
            return self._open.lifecycle.programs.path.find(wanted)
        except FileNotFoundError as missing:
            raise UsageError(f"program not found: {wanted}; {missing}") from None

    def agent(self, name: str) -> RunningAgent:
        """Return the agent with this name.

        Raises:
            UnknownAgent: it does not exist. The text suggests similar names.
        """
        system, waits = self._running
        host = system.directory.find(name)
        if host is None:
            raise UnknownAgent(name, [each.name for each in system.directory])
        known = self._agents.get(name)
        if known is None or known.ended:
            known = self._agents[name] = RunningAgent(host, waits, system.lifecycle.end)
        return known

    @property
    def agents(self) -> tuple[RunningAgent, ...]:
        """All agents, in the order of creation."""
        return tuple(self.agent(host.name) for host in self._running[0].directory)

    # ---- messages and output

    def send(
        self,
        receiver: str,
        performative: str,
        content: object,
        /,
        *arguments: object,
        sender: str = _PYTHON,
        **values: object,
    ) -> None:
        """Send a message to an agent: ``mas.send("bob", "achieve", "clean(kitchen)")``.

        Answers reach the `mailbox` of the name *sender*, if it exists. For arguments and errors, see `Mailbox.send`.
        """
        from jacaros.runtime.mas.embedding.mailbox import Mailbox

        arguments, sender = by_position(content, arguments, "sender", sender)
        known = self._mailboxes.find(sender) if self._mailboxes is not None else None
        system, waits = self._open, self._running[1]
        (known or Mailbox(sender, system.deliver, system.agent_names, waits)).send(
            receiver, performative, content, *arguments, reply_to=None, **values
        )

    def mailbox(self, name: str) -> "Mailbox":
        """Return the mailbox of Python code with this name. It is created on first use; then agents can send to it.

        Raises:
            UsageError: an agent has this name.
        """
        from jacaros.runtime.mas.embedding.mailbox import Mailbox, PythonMailboxes

        system, waits = self._open, self._running[1]
        if self._mailboxes is None:
            self._mailboxes = PythonMailboxes()
            system.directory.join(self._mailboxes)  # pyright: ignore[reportArgumentType]
        known = self._mailboxes.find(name)
        if known is None:
            if name in system.directory.names():
                raise UsageError(
                    f"duplicate name `{name}`: an agent has it; choose another name for the mailbox"
                )
            known = Mailbox(name, system.deliver, system.agent_names, waits)
            self._mailboxes[name] = known
        return known

    def on_print(self, callback: OnPrint) -> Callable[[], None]:
        """Call *callback* with agent and text of all output from now on. Return a function that ends this.

        It is called in the middle of the agent's step: it may store the line, and add beliefs, percepts and messages.
        """
        return self._console.listen(callback)

    # ---- robots

    @property
    def ros(self) -> "Backend":
        """The system's node in the ROS graph, for publishers, subscriptions and services of Python code."""
        return self._open.ros.backend()

    @property
    def world(self) -> "World | None":
        """The embedded robot world, with its ground truth (`jacaros.robots.world.World`); None on a real graph.

        It is created when the first artifact needs a robot, or on first use of this property.
        """
        system = self._running[0]
        if system.ros.world is None and self._options.ros == "memory" and system.exit_code is None:
            system.ros.backend()
        return system.ros.world

    # ---- the environment

    @property
    def _run_environment(self) -> "RunEnvironment":
        return self._open.run_environment()

    @property
    def environment(self) -> "Environment":
        """All workspaces and artifacts."""
        return self._run_environment.environment

    def add_artifact_types(self, *types: "type[Artifact]") -> None:
        """Let agents create artifacts of these classes, by class name.

        They have precedence over others with the same name.
        """
        self._run_environment.given_types.update({each.__name__: each for each in types})

    def create_workspace(self, path: str) -> str:
        """Create a workspace. Return its full path.

        Args:
            path: full, or relative to ``/main``.

        Raises:
            OperationFailed: it already exists, or its parent workspace does not.
        """
        full = path if path.startswith("/") else f"/main/{path}"
        return self.environment.create_workspace(full).path

    async def make_artifact(
        self,
        name: str,
        artifact_type: "str | type[Artifact]",
        arguments: Sequence[object] = (),
        *,
        workspace: str = "/main",
    ) -> "ArtifactId":
        """Create an artifact, and wait until its ``init`` has ended.

        Args:
            name: unique in the workspace.
            artifact_type: the class, or the name of a type: of the project, of JaCaROS, or added with `add_artifact_types`.
            arguments: plain values for ``init``.
            workspace: its workspace, by path or name.

        Raises:
            OperationFailed: it cannot be created, with message and reason.
        """
        place = _workspace(self.environment, workspace)
        return await place.make_artifact(name, artifact_type, arguments)

    def session(self, name: str, workspace: str = "/main") -> "Session":
        """Return a working session, with which Python code uses artifacts itself. See
        `jacaros.artifacts.presence.session.Session`.

        It is closed at the end of the run at the latest.

        Args:
            name: name of the session.
            workspace: the workspace that it joins first, by path or name.

        Raises:
            OperationFailed: the workspace does not exist.
        """
        from jacaros.artifacts.presence.session import Session
        from jacaros.runtime.mas.environment import OperationAccount

        environment = self.environment
        system = self._open
        account = OperationAccount(system.activity, system.idleness.look)
        session = Session(environment, name, _workspace(environment, workspace).path, account)
        self._at_end.append(session.close)
        return session


def _deployment(
    project: str | Path | Deployment | None, name: str, folder: Path, mappings: Sequence[str | Path]
) -> Deployment:
    if isinstance(project, Deployment):
        declared = project
    elif project is not None:
        declared = load_deployment(project)
    else:
        declared = Deployment(name, folder, artifact_environment=True, source_paths=source_folders(folder))
    return mapped(declared, mappings)


def _focus(wanted: "str | ArtifactId") -> FocusSpec:
    if isinstance(wanted, str):
        workspace, _, name = wanted.rpartition("/")
        return FocusSpec(name, workspace or None)
    return FocusSpec(wanted.name, wanted.workspace)


def _placed(spec: AgentSpec, environment: "Environment") -> AgentSpec:
    """Return the declaration with full paths of what the agent joins and focuses.

    Raises:
        OperationFailed: a workspace or an artifact does not exist.
    """
    from jacaros.runtime.mas.environment import artifact_of, path_of

    join = tuple(path_of(environment, path) for path in spec.join)
    found = [artifact_of(environment, each) for each in spec.focus]
    focus = tuple(FocusSpec(artifact.name, artifact.workspace) for artifact in found)
    return replace(spec, join=join, focus=focus)


def _workspace(environment: "Environment", name: str) -> "Workspace":
    from jacaros.runtime.mas.environment import path_of

    return environment.workspace(path_of(environment, name))


def run(main: Coroutine[Any, Any, T], *, clock: Literal["real", "fast"] = "real") -> T:
    """Run a coroutine to its end, as `asyncio.run` does, on an event loop with its own clock. Return its result.

    Args:
        main: the coroutine, such as ``main()``.
        clock: ``real`` for real time; ``fast`` for the virtual clock, which jumps to the next timer as soon as all tasks
            wait. Then ``asyncio.sleep`` and time limits take no real time either.

    Raises:
        UsageError: an event loop is already running, as in a notebook (``await`` the coroutine there); or the clock is
            unknown.
    """
    wrong = ""
    if clock not in ("real", "fast"):
        wrong = f"unknown clock `{clock}`; expected `real` or `fast`"
    with suppress(RuntimeError):
        asyncio.get_running_loop()
        wrong = "an event loop is already running (a notebook?); await the coroutine instead of calling jacaros.run"
    if wrong:
        main.close()
        raise UsageError(wrong)
    chosen = VirtualClock() if clock == "fast" else WallClock()
    with asyncio.Runner(loop_factory=partial(new_event_loop, chosen)) as runner:
        return runner.run(main)
