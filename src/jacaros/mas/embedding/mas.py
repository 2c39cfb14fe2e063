"""Agents, artifacts and robots in a Python program."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.agents.mind.storage import restore
from jacaros.errors import UsageError
from jacaros.mas.agents.programs import source_folders
from jacaros.mas.deployment import AgentSpec, Deployment, FocusSpec
from jacaros.mas.embedding.run import EmbeddedRun, OnLog, OnPrint, PrintedLine
from jacaros.mas.embedding.running_agent import RunningAgent
from jacaros.mas.embedding.waits import UnknownAgent
from jacaros.mas.launch import load_deployment, mapped
from jacaros.mas.options import RunOptions

if TYPE_CHECKING:
    from jacaros.agents.python.python_agent import PythonAgent
    from jacaros.artifacts.env.artifact import Artifact
    from jacaros.artifacts.env.environment import Environment
    from jacaros.artifacts.env.errors import ArtifactId
    from jacaros.artifacts.env.ports import Workspace
    from jacaros.artifacts.presence.session import Session
    from jacaros.mas.embedding.mailbox import Mailbox, PythonMailboxes, Stream
    from jacaros.mas.environment import RunEnvironment
    from jacaros.ros.backend import Backend
    from jacaros.sim import World

_PYTHON = "python"
"""Default sender of messages."""


class Mas(EmbeddedRun):
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
        on_log: called with text and level of each line of the log. Default: standard error.
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
        **changes: Any,
    ) -> None:
        options = replace(options or RunOptions(), **changes)
        base = Path(folder) if folder is not None else Path.cwd()
        super().__init__(_deployment(project, name, base, options.mappings), options, on_print, on_log)
        self._agents: dict[str, RunningAgent] = {}
        self._mailboxes: PythonMailboxes | None = None

    # ---- agents

    def add_agent(
        self,
        name: str | AgentSpec,
        program: "str | Path | type[PythonAgent] | None" = None,
        *,
        beliefs: str = "",
        goals: str = "",
        join: Iterable[str] = (),
        focus: "Iterable[str | FocusSpec | ArtifactId]" = (),
        options: Mapping[str, str] | None = None,
        agent_class: str | None = None,
        stored: Mapping[str, Any] | None = None,
    ) -> RunningAgent:
        """Create and start an agent. It has its first turn when the caller awaits something.

        Args:
            name: name of the agent; or its declaration, as in project files.
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
        if isinstance(name, AgentSpec):
            spec, written = name, None
        else:
            python_class = program if isinstance(program, type) else None
            written = program if isinstance(program, str) else None
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
                python_class=python_class,
            )
        if not spec.name.isprintable() or not spec.name or " " in spec.name:
            raise UsageError(
                f"invalid agent name {spec.name!r}: it must not be empty or have spaces or control characters"
            )
        if spec.name in system.directory.names():
            raise UsageError(f"duplicate agent name `{spec.name}`")
        if spec.join or spec.focus:
            spec = _placed(spec, self._run_environment.environment)
        tree = system.lifecycle.programs.load(spec, written)
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

    def send(self, receiver: str, performative: str, content: object, sender: str = _PYTHON) -> None:
        """Send a message to an agent: ``mas.send("bob", "achieve", "clean(kitchen)")``.

        Args:
            receiver: name of the agent.
            performative: ``tell``, ``achieve``, ``untell``, ``signal`` …
            content: a term in the syntax of the language, as text; or a plain value (see `jacaros.artifacts.env.values`).
            sender: name of the sender. Answers reach the `mailbox` with this name, if it exists.

        Raises:
            UnknownAgent: no participant has this name.
            AslError: the text is not a term.
        """
        from jacaros.mas.embedding.mailbox import Mailbox

        known = self._mailboxes.find(sender) if self._mailboxes is not None else None
        system, waits = self._open, self._running[1]
        (known or Mailbox(sender, system.deliver, system.agent_names, waits)).send(
            receiver, performative, content
        )

    def mailbox(self, name: str) -> "Mailbox":
        """Return the mailbox of Python code with this name. It is created on first use; then agents can send to it.

        Raises:
            UsageError: an agent has this name.
        """
        from jacaros.mas.embedding.mailbox import Mailbox, PythonMailboxes

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

    def output(self, agent: str | None = None) -> "Stream[PrintedLine]":
        """Return the output of agents from now on, as an asynchronous iterator that ends with the run.

        Args:
            agent: only the output of this agent.
        """
        from jacaros.mas.embedding.mailbox import Stream

        _, waits = self._running
        stream: Stream[PrintedLine] = Stream(waits, f"{agent or 'no agent'} printed nothing")

        def put(printing: str, text: str) -> None:
            if agent in (None, printing):
                stream.put(PrintedLine(printing, text))

        self._console.listen(put)
        return stream

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
        """The embedded robot world, with its ground truth (`jacaros.sim.World`); None on a real graph.

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
        self._run_environment.types.given.update({each.__name__: each for each in types})

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
        from jacaros.mas.environment import OperationAccount

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


def _focus(wanted: "str | FocusSpec | ArtifactId") -> FocusSpec:
    if isinstance(wanted, FocusSpec):
        return wanted
    if isinstance(wanted, str):
        workspace, _, name = wanted.rpartition("/")
        return FocusSpec(name, workspace or None)
    return FocusSpec(wanted.name, wanted.workspace)


def _placed(spec: AgentSpec, environment: "Environment") -> AgentSpec:
    """Return the declaration with full paths of what the agent joins and focuses.

    Raises:
        OperationFailed: a workspace or an artifact does not exist.
    """
    from jacaros.mas.environment import artifact_of, path_of

    join = tuple(path_of(environment, path) for path in spec.join)
    found = [(artifact_of(environment, each), each.namespace) for each in spec.focus]
    focus = tuple(FocusSpec(artifact.name, artifact.workspace, namespace) for artifact, namespace in found)
    return replace(spec, join=join, focus=focus)


def _workspace(environment: "Environment", name: str) -> "Workspace":
    from jacaros.mas.environment import path_of

    return environment.workspace(path_of(environment, name))
