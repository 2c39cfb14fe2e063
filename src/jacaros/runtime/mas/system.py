"""A running multi-agent system, composed of minds, bodies, environment, ROS graph and clock."""

import asyncio
import mmap
from collections.abc import Awaitable, Callable, Mapping, Sequence
from contextlib import AsyncExitStack
from functools import partial
from random import Random
from typing import TYPE_CHECKING, Any

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.language.nodes import Program
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import Activity, Services
from jacaros.runtime.clock import Clock, of_run
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.agents.lifecycle import AgentLifecycle
from jacaros.runtime.mas.agents.programs import Programs, asks_why
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.console import HeardConsole, RunConsole
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, has_own_artifacts
from jacaros.runtime.mas.directory import NAME as DIRECTORY_NAME
from jacaros.runtime.mas.directory import Directory, Mailboxes, ServiceDirectory
from jacaros.runtime.mas.endless_loops import EndlessLoops
from jacaros.runtime.mas.never_met import never_met
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph
from jacaros.runtime.mas.scheduler import AgentTimer, Idleness, Scheduler

if TYPE_CHECKING:
    from jacaros.artifacts.env.environment import Environment
    from jacaros.look.why.explanation import Explanation
    from jacaros.runtime.input import LineInput
    from jacaros.runtime.mas.debugging.debugger import Debugger
    from jacaros.runtime.mas.environment import RunEnvironment
    from jacaros.runtime.mas.fleet import Fleet
    from jacaros.runtime.mas.history.history import History
    from jacaros.runtime.trace import Tracer


Join = Callable[["System"], Awaitable[Callable[[], Awaitable[None]]]]
"""Joins a system to a fleet. Returns a function that leaves it."""
OUT_OF_MEMORY = 137
"""Exit code of a run that ended for lack of memory: that of a process killed by the kernel."""
RESERVE = 32 << 20
"""Bytes of address space that are released at the first `MemoryError`. They are never written, so they use no memory."""


class System:
    """One run of a project. Call `run` for the whole run, or `start` and `close`.

    Args:
        deployment: the project.
        clock: its clock. `run` must be called on its event loop.
        console: its outputs.
        options: run options.
        prepare: returns the part of a program to run. Default: all of it.
        when_made: called with every agent before it begins.
        when_idle: called whenever the run has become idle.
        join: joins a fleet, when the environment has been created and no agent has begun.

    Attributes:
        directory: agents by name, and other participants.
        ros: the ROS graph and the embedded world.
        scheduler: gives the agents their turns.
        activity: counts what the agents wait for.
        idleness: detects when the run is idle.
        lifecycle: creates and ends agents.
        mailboxes: delivers messages between agents.
        deliver, agent_names, create_agent, clone_agent, kill_agent: requests of agents.
        input: the standard input, from which a person answers questions of agents; None: it is not read.
        lost_goals: number of failed goals without a plan for their failure, and of Python agents that an exception ended.
        exit_code: exit code of the run; None while it is running.
        error: the defect of JaCaROS that ended the run, or None.
        listen_to_log: calls a function with text and level of each line that is logged from now on. Returns a function that
            ends this.
        listen_to_prints: the same for agent and text of each line that agents print.
        services: the directory facilitator. May be replaced before the run starts.
        tracer: creates the causes; None while nothing observes the run.
        fleet: the fleet that the system has joined, or None.
        service: what its agents offer to callers outside (`jacaros.serving.service.service_of`); None before its first use.
    """

    def __init__(
        self,
        deployment: Deployment,
        clock: Clock,
        console: RunConsole,
        options: RunOptions | None = None,
        prepare: Callable[[Program, PythonCode], Program] | None = None,
        when_made: Callable[[AgentHost], None] | None = None,
        when_idle: Callable[[], None] | None = None,
        join: "Join | None" = None,
    ) -> None:
        self.deployment = deployment
        self.clock = clock
        self.options = options = options or RunOptions()
        options.check()
        if options.wants_rosout:
            from jacaros.runtime.mas.rosout import RosoutConsole  # here: only for runs on a real graph

            console = RosoutConsole(console, lambda: self.ros.joined)
        self.console: RunConsole = HeardConsole(console)
        self.listen_to_log, self.listen_to_prints = self.console.listen, self.console.listen_to_prints
        self.directory: Directory = Directory()
        self.activity = Activity()
        self.idleness = Idleness(self.activity)
        self.scheduler = Scheduler(clock, self.idleness.look, self.fail, idle_work=self._compile_ahead)
        self.scheduler.busy_for_long = EndlessLoops(lambda text: self.console.log(text, "warning")).look
        self.idleness.turns = self.scheduler
        self._run_environment: RunEnvironment | None = None
        self.tracer: Tracer | None = None
        self.fleet: Fleet | None = None
        self.service: object = None
        self._situated: list[Callable[[Environment], None]] = []
        self._closers: list[Callable[[], Awaitable[None]]] = []
        self._join = join
        self._leave: Callable[[], Awaitable[None]] = _stay
        self._history: History | None = None
        self._keeps_history = False
        self._debugger: Debugger | None = None
        source, span, log = deployment.world, deployment.world_span, self.console.log
        self.ros = RosGraph(options, clock, deployment.name, source, log, self.scheduler.hurry, span)
        self._modules = ProjectModules(deployment.base_path, *deployment.source_paths)
        if options.until_idle or when_idle is not None:
            self.idleness.watch(when_idle or (lambda: self.end(0)))
        self.mailboxes = Mailboxes(self.directory.find, self.directory.find_other)
        self.deliver, self.agent_names = self.mailboxes.deliver, self.directory.names
        self.services: Services = ServiceDirectory(self._make_directory_agent, self.deliver)
        self._has_environment = deployment.artifact_environment or bool(deployment.workspaces)
        self._seed = options.seed if options.seed is not None else Random().getrandbits(64)
        code = PythonCode(self._modules, options.restricted)
        programs = Programs(deployment.source_paths, lambda text: log(text, "warning"), code, prepare)
        self.lifecycle = AgentLifecycle(
            self, self.directory, programs, code, self._seed, options.plain, self._situate, when_made
        )
        self.create_agent, self.clone_agent = self.lifecycle.create, self.lifecycle.clone
        self.kill_agent = self.lifecycle.kill
        self.input: LineInput | None = None
        self._reserve: mmap.mmap | None = mmap.mmap(-1, RESERVE)
        self._ended: asyncio.Future[int] | None = None
        self.lost_goals = 0
        self.exit_code: int | None = None
        self.error: BaseException | None = None

    def _compile_ahead(self) -> bool:
        return self.lifecycle.compile_ahead()

    async def run(self, when_started: Callable[[], None] | None = None) -> int:
        """Run the project until it ends. Return the exit code.

        Args:
            when_started: called when everything has been created, before the first agent has its turn.

        Raises:
            JacarosError: the project cannot start. The text says why.
            InternalError: a defect of JaCaROS.
        """
        try:
            await self.start()
            if when_started is not None:
                when_started()
            code = await self.ended()
        finally:
            await self.close()
        if self.error is not None:
            raise self.error
        return code

    @property
    def has_environment(self) -> bool:
        """Whether agents of the project use artifacts."""
        return self._has_environment

    @property
    def environment(self) -> "Environment | None":
        """Workspaces and artifacts; None before their first use."""
        return self._run_environment.environment if self._run_environment is not None else None

    def trace(self, tracer: "Tracer | None") -> None:
        """Pass the causes of events to *tracer* from now on: messages, operations, properties, actions. None ends this."""
        self.tracer = tracer
        self.ros.trace(tracer)
        if self.fleet is not None:
            self.fleet.traced(tracer is not None)
        if self._run_environment is not None:
            self._run_environment.environment.tracer = tracer

    def when_situated(self, callback: "Callable[[Environment], None]") -> Callable[[], None]:
        """Call *callback* with the environment, now or when it is created. Return a function that ends this."""
        self._situated.append(callback)
        if self._run_environment is not None:
            callback(self._run_environment.environment)

        return lambda: self._situated.remove(callback) if callback in self._situated else None

    @property
    def debugger(self) -> "Debugger":
        """Pauses and steps the run. Created on first use."""
        if self._debugger is None:
            from jacaros.runtime.mas.debugging.debugger import Debugger  # here: most runs are not debugged

            self._debugger = Debugger(self)
            self._debugger.listen(lambda _: self._history.look() if self._history is not None else None)
        return self._debugger

    def history(self) -> "History":
        """Return the history of the run, for recordings, views and explanations. Created on first use."""
        if self._history is None:
            from jacaros.runtime.mas.history.history import History  # here: most runs are not observed

            self._history = History(self)
        return self._history

    def keep_history(self) -> "History":
        """Observe the run from now on, until its end."""
        history = self.history()
        if not self._keeps_history:
            self._keeps_history = True
            history.start()
        return history

    def answer(
        self, question: str, at: float | None = None, agent: str = "", robot: str = ""
    ) -> "Explanation":
        """Answer a question about the run so far. See `jacaros.look.why.why.explain`.

        What happened before the first question is unknown, unless the option ``explain`` is set.

        Raises:
            UsageError: the question is not understood.
        """
        from jacaros.look.why.why import explain  # here: few runs are asked

        return explain(self.keep_history().all(), question, at, agent, robot)

    def explain(self, question: str, agent: str) -> Mapping[str, Any]:
        """Answer a question of an agent about itself, as plain data."""
        return self.answer(question, agent=agent).data()

    # ---- the start

    async def start(self) -> None:
        """Create everything that the project declares. Call `close` afterwards, even if this fails.

        Raises:
            JacarosError: the project cannot start. The text says why.
        """
        with of_run():
            await self._start()

    async def _start(self) -> None:
        self._ended = asyncio.get_running_loop().create_future()
        for diagnostic in self.deployment.ignored:
            self.console.log(diagnostic.render(), "warning")
        lifecycle = self.lifecycle
        programs = lifecycle.programs.load_all(self.deployment.agents)
        lifecycle.check(self.deployment.agents)
        await self.ros.start()
        if self._has_environment and self._has_workspace_setup():
            await self.run_environment().set_up(self.deployment)
        if self._join is not None:
            self._leave = await self._join(self)
        await self.ros.guard()
        hosts = list(map(lifecycle.add, self.deployment.agents, programs))
        if self.options.explain or any(map(asks_why, programs)):
            self.keep_history()
        for host, program in zip(hosts, programs, strict=True):
            lifecycle.begin(host, program)
        if self.options.seconds is not None:
            self.clock.call_later(self.options.seconds, lambda: self.end(0))
        self.ros.watch_parameters()
        self.idleness.look()
        if self.clock.virtual and (files := self._modules.loaded_files()):
            from jacaros.runtime.mas.agents.python_code import readings  # here: few projects have Python code

            for warning in readings(files):
                self.console.log(warning.render(), "warning")

    def _has_workspace_setup(self) -> bool:
        """Return whether the environment is created at the start, also to report errors in the project's own artifacts."""
        declared = self.deployment.environment or self.deployment.workspaces
        situated = any(agent.is_situated for agent in self.deployment.agents)
        return bool(declared) or situated or has_own_artifacts(self.deployment.base_path)

    def run_environment(self) -> "RunEnvironment":
        """Return the environment, created on first use."""
        if self._run_environment is None:
            from jacaros.runtime.mas.environment import Resources, RunEnvironment

            random = Random(f"{self._seed}/artifacts")
            resources = Resources(
                {
                    "ros": self.ros.backend,
                    "graph_unused": lambda: self.ros.joined is None,
                    "console": lambda: self.console.print,
                    "random": lambda: random,
                    "input": lambda: self.input,
                    "restricted": lambda: self.options.restricted,
                    "stop": lambda: partial(self.stop_system, 0.0, 0),
                }
            )
            self._run_environment = RunEnvironment(
                self.deployment, self._modules, self.clock, resources, self.console, self.activity, self.fail
            )
            self._run_environment.environment.tracer = self.tracer
            for callback in tuple(self._situated):
                callback(self._run_environment.environment)
        return self._run_environment

    def _situate(self, host: AgentHost, spec: AgentSpec) -> None:
        if spec.is_python:
            if self._has_environment:
                from jacaros.runtime.mas.agents.python_agents import (
                    PythonAgentHost,  # here: most projects have none
                )

                assert isinstance(host, PythonAgentHost)
                host.situate(spec, self.run_environment())
            return
        if self._has_environment:
            host.make_body = lambda: self.run_environment().make_body(host)
        if self._run_environment is not None:
            host.body = body = self._run_environment.make_body(host)
            body.enter()
            self._run_environment.situate(body, spec)

    def _make_directory_agent(self) -> Mind:
        """Create the agent of the directory facilitator. An agent of the project with its name replaces it."""
        host = self.directory.find(DIRECTORY_NAME)
        if host is None:
            host = AgentHost(DIRECTORY_NAME, self, f"{self._seed}/{DIRECTORY_NAME}")
            host.set_mind(Mind(DIRECTORY_NAME, Program(), host))  # pyright: ignore[reportArgumentType]
            self.directory.add(DIRECTORY_NAME, host)
        assert host.mind is not None
        return host.mind

    # ---- the end

    def end(self, exit_code: int) -> None:
        """End the run: no agent has another turn, and nothing more is printed.

        With the option ``fail_on_lost_goal``, exit code 0 becomes 1 if a goal was lost.
        """
        if self.exit_code is not None:
            return
        if exit_code == 0 and self.options.fail_on_lost_goal and self.lost_goals:
            exit_code = 1
            goals = "1 goal was" if self.lost_goals == 1 else f"{self.lost_goals} goals were"
            self.console.log(f"error: {goals} lost (--fail-on-lost-goal)", "error")
        self._tell_what_was_never_met()
        self.ros.ending()
        self.exit_code = exit_code
        self.scheduler.stop()
        self.idleness.stop()
        for host in self.directory:
            host.halt()
        if self._debugger is not None:
            self._debugger.run_ended()
        if self._history is not None:
            self._history.run_ended(exit_code)
        if self._ended is not None and not self._ended.done():
            self._ended.set_result(exit_code)

    def _tell_what_was_never_met(self) -> None:
        for host in self.directory:
            try:
                lines = [] if host.mind is None else list(never_met(host.mind))
            except Exception:
                continue  # a message in a log must never make the run fail
            for line in lines:
                self.console.log(f"[{host.name}] warning: {line}", "warning")

    def when_ended(self, callback: Callable[[int], None]) -> None:
        """Call *callback* with the exit code soon after the end of the run."""
        assert self._ended is not None, "the run has not been started"
        self._ended.add_done_callback(lambda ended: callback(ended.result()))

    async def ended(self) -> int:
        """Wait for the end of the run. Return the exit code."""
        assert self._ended is not None, "the run has not been started"
        return await asyncio.shield(self._ended)

    def goal_lost(self) -> None:
        """Count a failed goal without a plan for its failure."""
        self.lost_goals += 1

    def out_of_memory(self, name: str = "") -> None:
        """End the run after a `MemoryError`, in the step of an agent or elsewhere.

        Releasing the reserve makes room for stopping the robots, closing and the message.
        """
        if self._reserve is None:
            return
        self._reserve.close()
        self._reserve = None
        self.end(OUT_OF_MEMORY)
        agent = f"[{name}] " if name else ""
        self.console.log(
            f"{agent}error: out of memory; the run ends\n"
            "  = help: limit what grows with the agent options belief_limit, event_limit, intention_limit and "
            "mailbox_limit",
            "error",
        )

    def fail(self, error: BaseException) -> None:
        """End the run because of a defect of JaCaROS itself, or for lack of memory."""
        if isinstance(error, MemoryError):
            self.out_of_memory()
            return
        if self.error is None:
            self.error = error
        self.end(1)

    def close_last(self, closer: Callable[[], Awaitable[None]]) -> None:
        """Await *closer* at the end of `close`, when the robots have stopped."""
        self._closers.append(closer)

    async def close(self) -> None:
        """Release everything: cancel operations, stop robots.

        A failing step does not prevent the later ones, in particular the last one, in which the graph stops the robots.
        """
        self.end(1)
        hosts = list(self.directory)
        async with AsyncExitStack() as steps:  # runs in reverse order
            for closer in self._closers:
                steps.push_async_callback(closer)
            steps.push_async_callback(self.ros.close)
            if self._run_environment is not None:
                steps.push_async_callback(self._run_environment.environment.close)
            for host in reversed(hosts):
                steps.push_async_callback(host.close)
            for host in reversed(hosts):
                steps.callback(host.end)
            steps.push_async_callback(self._leave)
            # A signal may just have stopped the robots. The in-process graph delivers that in the next turn.
            steps.push_async_callback(asyncio.sleep, 0.0)

    # ---- requests of agents

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds, after announcing it to the agents."""
        if delay > 0:
            for host in self.directory:
                host.shut_down_in(delay)
            AgentTimer(self.clock, self.activity, delay, lambda: self.end(exit_code))
        else:
            self.end(exit_code)

    def end_agent(self, name: str) -> None:
        """End an agent immediately, without asking it. Unknown names have no effect."""
        host = self.directory.find(name)
        if host is not None:
            self.lifecycle.end(host)

    def list_files(self, folder: str) -> Sequence[str]:
        """Return the files below a folder, sorted, as paths that begin with *folder*.

        Raises:
            OSError: the folder cannot be read.
        """
        return self.lifecycle.programs.list_files(folder, self.deployment.base_path)

    def write_file(self, path: str, text: str) -> None:
        """Write a text file. A relative path is relative to the project's folder.

        Raises:
            OSError: the file cannot be written.
        """
        (self.deployment.base_path / path).write_text(text, encoding="utf-8", newline="\n")

    def read_program(self, path: str) -> tuple[str, str]:
        """Return name and text of a program file.

        Raises:
            FileNotFoundError: it does not exist.
        """
        return self.lifecycle.programs.path.include(path, str(self.deployment.base_path / "."))


async def _stay() -> None:
    """Leave no fleet."""
