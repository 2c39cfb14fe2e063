"""Agents, artifacts and robots inside a Python program."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.bdi.snapshot import restore
from jacaros.errors import UsageError
from jacaros.mas.agent_lifecycle import begin
from jacaros.mas.deployment import AgentSpec, Deployment, FocusSpec
from jacaros.mas.embedding.errors import UnknownAgent
from jacaros.mas.embedding.run import EmbeddedRun
from jacaros.mas.embedding.running_agent import RunningAgent
from jacaros.mas.embedding.stream import OnLog, OnPrint, PrintedLine, Stream
from jacaros.mas.loading import load_deployment, mapped
from jacaros.mas.options import RunOptions

if TYPE_CHECKING:
    from jacaros.env.artifact import Artifact
    from jacaros.env.environment import Environment
    from jacaros.env.ids import ArtifactId
    from jacaros.env.ports import Workspace
    from jacaros.env.session.session import Session
    from jacaros.extension.python_agent import PythonAgent
    from jacaros.mas.embedding.mailbox import Mailbox, PythonMailboxes
    from jacaros.mas.environment import RunEnvironment
    from jacaros.ros.backend import Backend
    from jacaros.sim import World

_PYTHON = "python"
"""Who messages come from whose sender is not given."""


class Mas(EmbeddedRun):
    """A multi-agent system in a Python program.

    It runs inside ``async with``, on the event loop that the program runs on: whenever the program awaits something, the
    agents have their turns::

        async def main() -> None:
            async with Mas(seed=1) as mas:
                bob = mas.add_agent("bob", "+!greet(X) <- .print(hello, X).")
                await bob.achieve("greet(world)")

        jacaros.run(main())

    At the end of the block the run is ended, whatever has happened in it: operations are cancelled, robots stand still,
    artifacts are disposed.  Everything is for the loop's own thread; another thread uses `asyncio.run_coroutine_threadsafe`
    and ``loop.call_soon_threadsafe``.  Several systems can live on one loop; they share nothing but the clock.

    Args:
        project: a project file (``.mas2j``, ``.jcm``) or a program (``.asl``), or what one declares; an empty system
            without.
        options: how to run it; the clock is that of the event loop, or with ``ros_clock`` that of the ROS graph.
        name: of an empty system.
        folder: of an empty system: where programs, included files and Python modules are looked for; the current folder
            unless given.
        on_print: called with agent and text whenever an agent prints; the standard output gets ``[agent] text`` without.
        on_log: called with a line for people and its level; the standard error output gets it without.
        changes: single fields of `RunOptions` in place of those of *options*, such as ``seed=1, world="patrol"``.

    Raises:
        ProjectError: the project file or a mapping file is wrong.
        TypeError: `RunOptions` has no such field.
        UsageError: options that cannot go together.
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
        architectures: Sequence[str] = (),
        belief_base: str | None = None,
        stored: Mapping[str, Any] | None = None,
    ) -> RunningAgent:
        """Make an agent, and let it begin; it has its first turn when the caller awaits something.

        Args:
            name: of the agent; or all that is known of it, as project files declare it.
            program: its program as text; or the path of a file (``.asl`` or ``.py``), the one called ``NAME.asl`` unless
                given; or the class of an agent written in Python.
            beliefs: further initial beliefs, as text, separated by commas.
            goals: further initial goals, likewise.
            join: workspaces that it joins, by path or name.
            focus: artifacts that it focuses before its goals begin: names (looked for in all workspaces), paths or ids.
            options: settings such as ``verbose`` and ``events``, as in project files.
            agent_class, architectures, belief_base: Python classes of the project, as in project files.
            stored: what `RunningAgent.stored` returned for an agent with the same program, in this process or another one.
                The agent continues where that one was: it adopts no initial beliefs and goals.  It perceives anew what it
                focuses.  An action that was under way fails with ``env_failure_reason(interrupted)``.

        Raises:
            ValueError: *stored* has another format, or the program lacks a plan or belief that is used there.
            AslError: the program is wrong; the text shows each mistake in its line.
            UsageError: there is an agent of that name; the name is empty or has spaces or control characters; or the
                caller is not in the thread of the run's loop.
            OperationFailed: a workspace or an artifact is not there.
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
                architecture_classes=tuple(architectures),
                belief_base_class=belief_base,
                python_class=python_class,
            )
        if not spec.name.isprintable() or not spec.name or " " in spec.name:
            raise UsageError(
                f"invalid agent name {spec.name!r}: it must not be empty or have spaces or control characters"
            )
        if spec.name in system.directory.names():
            raise UsageError(f"duplicate agent name {spec.name}")
        if spec.join or spec.focus:
            spec = _placed(spec, self._run_environment.environment)
        tree = system.lifecycle.programs.load(spec, written)
        host = system.lifecycle.add(spec, tree)
        agent = self.agent(spec.name)
        if stored is None:
            begin(host, spec, tree)
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
            return self._open.lifecycle.programs.find(wanted)
        except FileNotFoundError:
            folders = ", ".join(map(str, self._open.lifecycle.programs.folders))
            raise UsageError(f"program not found: {wanted} in {folders}") from None

    def agent(self, name: str) -> RunningAgent:
        """The agent of that name.

        Raises:
            UnknownAgent: there is none; the text has names that may have been meant.
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
        """All agents, in the order of their making."""
        return tuple(self.agent(host.name) for host in self._running[0].directory)

    # ---- messages and output

    def send(self, receiver: str, performative: str, content: object, sender: str = _PYTHON) -> None:
        """Send a message to an agent: ``mas.send("bob", "achieve", "clean(kitchen)")``.

        Args:
            receiver: its name.
            performative: ``tell``, ``achieve``, ``untell``, ``signal`` …
            content: a term in the syntax of the language, as text; or a plain value (see `jacaros.env.values`).
            sender: whom it is from, as the agent is told; answers reach a `mailbox` of that name, if there is one.

        Raises:
            UnknownAgent: nobody of that name takes part.
            AslError: the text is no term.
        """
        from jacaros.mas.embedding.mailbox import Mailbox

        known = self._mailboxes.find(sender) if self._mailboxes is not None else None
        system, waits = self._open, self._running[1]
        (known or Mailbox(sender, system.deliver, system.agent_names, waits)).send(
            receiver, performative, content
        )

    def mailbox(self, name: str) -> "Mailbox":
        """The mailbox of Python code under that name, made when it is first asked for; agents can send to it then.

        Raises:
            UsageError: there is an agent of that name.
        """
        from jacaros.mas.embedding.mailbox import Mailbox, PythonMailboxes

        system, waits = self._open, self._running[1]
        if self._mailboxes is None:
            self._mailboxes = PythonMailboxes()
            system.directory.join(self._mailboxes)  # pyright: ignore[reportArgumentType]
        known = self._mailboxes.find(name)
        if known is None:
            if name in system.directory.names():
                raise UsageError(f"the name {name} belongs to an agent; give the mailbox another name")
            known = Mailbox(name, system.deliver, system.agent_names, waits)
            self._mailboxes.add(known)
        return known

    def output(self, agent: str | None = None) -> Stream[PrintedLine]:
        """What agents print from now on, as an asynchronous iterator that ends with the run.

        Args:
            agent: only what this one prints.
        """
        _, waits = self._running
        stream: Stream[PrintedLine] = Stream(waits, f"{agent or 'no agent'} printed nothing")

        def put(printing: str, text: str) -> None:
            if agent in (None, printing):
                stream.put(PrintedLine(printing, text))

        self._console.listen(put)
        return stream

    def on_print(self, told: OnPrint) -> Callable[[], None]:
        """Call *told* with agent and text of everything that is printed from now on; gives what ends that.

        It is called in the middle of the agent's step: it may note the line, and give beliefs, percepts and messages.
        """
        return self._console.listen(told)

    # ---- robots

    @property
    def ros(self) -> "Backend":
        """The system's node in the ROS graph, for publishers, subscriptions and services of Python code."""
        return self._open.ros.backend()

    @property
    def world(self) -> "World | None":
        """The embedded robot world, which knows what truly happens (`jacaros.sim.World`); None on a real graph.

        It is made when the first artifact asks for a robot, or this is first asked for.
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
        """Let agents make artifacts of these classes, by their names; they come before all others of the name."""
        self._run_environment.types.given.update({each.__name__: each for each in types})

    def create_workspace(self, path: str) -> str:
        """Make a workspace; its full path.

        Args:
            path: full, or from ``/main``.

        Raises:
            OperationFailed: it is there already, or the workspace above it is not.
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
        """Make an artifact, and wait until its ``init`` has ended.

        Args:
            name: unique in the workspace.
            artifact_type: the class, or the name of one: of the project, of JaCaROS, or given by `add_artifact_types`.
            arguments: plain values for ``init``.
            workspace: where, by path or name.

        Raises:
            OperationFailed: it cannot be made; with message and reason.
        """
        place = _workspace(self.environment, workspace)
        return await place.make_artifact(name, artifact_type, arguments)

    def session(self, name: str, workspace: str = "/main") -> "Session":
        """A working session: Python code that uses artifacts itself, see `jacaros.env.session.session.Session`.

        It is closed at the end of the run at the latest.

        Args:
            name: who works.
            workspace: where it begins, by path or name.

        Raises:
            OperationFailed: there is no such workspace.
        """
        from jacaros.env.session.session import Session
        from jacaros.mas.embedding.session_account import SessionAccount

        environment = self.environment
        system = self._open
        account = SessionAccount(system.activity, system.idleness)
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
        declared = Deployment(name, folder, artifact_environment=True, source_paths=(folder,))
    return mapped(declared, mappings)


def _focus(wanted: "str | FocusSpec | ArtifactId") -> FocusSpec:
    if isinstance(wanted, FocusSpec):
        return wanted
    if isinstance(wanted, str):
        workspace, _, name = wanted.rpartition("/")
        return FocusSpec(name, workspace or None)
    return FocusSpec(wanted.name, wanted.workspace)


def _placed(spec: AgentSpec, environment: "Environment") -> AgentSpec:
    """The same agent with the full paths of what it joins and focuses.

    Raises:
        OperationFailed: one is not there.
    """
    from jacaros.mas.environment import artifact_of, path_of

    join = tuple(path_of(environment, path) for path in spec.join)
    found = [(artifact_of(environment, each), each.namespace) for each in spec.focus]
    focus = tuple(FocusSpec(artifact.name, artifact.workspace, namespace) for artifact, namespace in found)
    return replace(spec, join=join, focus=focus)


def _workspace(environment: "Environment", name: str) -> "Workspace":
    from jacaros.mas.environment import path_of

    return environment.workspace(path_of(environment, name))
