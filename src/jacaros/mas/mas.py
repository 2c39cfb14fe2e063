"""A running multi-agent system: where minds, bodies, environment, ROS and time are put together."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import jacaros.bdi.stdlib  # noqa: F401 - fills the table of internal actions
from jacaros.asl.nodes import Program
from jacaros.bdi.agent import Agent
from jacaros.bdi.program_plans import ProgramPlans
from jacaros.clock import Clock
from jacaros.errors import JacarosError
from jacaros.mas.activity import Activity, AgentTimer
from jacaros.mas.agent_classes import AgentClasses
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.agent_options import mind_options
from jacaros.mas.console import Console
from jacaros.mas.deployment import AgentSpec, Deployment, has_own_artifacts
from jacaros.mas.directory import Directory
from jacaros.mas.mailboxes import Mailboxes
from jacaros.mas.options import RunOptions
from jacaros.mas.programs import Programs
from jacaros.mas.python_code import PythonCode
from jacaros.mas.ros_graph import RosGraph
from jacaros.mas.scheduler import Scheduler
from jacaros.mas.service_directory import NAME as DIRECTORY_NAME
from jacaros.mas.service_directory import ServiceDirectory
from jacaros.project_modules import ProjectModules
from jacaros.terms import arithmetic
from jacaros.terms.text import text
from jacaros.terms.values import Term

if TYPE_CHECKING:
    from jacaros.env.environment import Environment
    from jacaros.mas.surroundings import Surroundings

_HOPS = 8
"""Turns of the loop that must pass without anything to do before a run counts as idle: a message of a ROS
graph inside the process takes a few to become a belief."""


class Mas:
    """One run of a project; `run` brings it from its start to its end.

    Args:
        deployment: what to run.
        clock: its time; `run` is called on the loop that goes with it.
        console: its outputs.
        options: how to run it.
        prepare: what is run of a program that was read; all of it unless given.
        when_made: called with every agent before it begins.
        when_idle: called whenever no agent has anything to do or to wait for.

    Attributes:
        directory: the agents by name.
        ros: the ROS graph and the embedded world.
        scheduler: gives the agents their turns.
        activity: what the agents wait for.
        deliver: brings a message to its receiver; False when there is none.
        services: the directory facilitator.
    """

    def __init__(
        self,
        deployment: Deployment,
        clock: Clock,
        console: Console,
        options: RunOptions | None = None,
        prepare: Callable[[Program], Program] | None = None,
        when_made: Callable[[AgentHost], None] | None = None,
        when_idle: Callable[[], None] | None = None,
    ) -> None:
        self.deployment = deployment
        self.clock = clock
        self.console = console
        self.options = options or RunOptions()
        self.options.check()
        self.directory: Directory[AgentHost] = Directory()
        self.activity = Activity()
        self.scheduler = Scheduler(clock, self._when_idle, self.fail)
        self._surroundings: Surroundings | None = None
        log = self.console.log
        self.ros = RosGraph(self.options, clock, deployment.name, deployment.world, log)
        self._modules = ProjectModules(deployment.base_path, *deployment.source_paths)
        self._code = PythonCode(self._modules)
        self._programs = Programs(
            deployment.source_paths, lambda text: log(text, "warning"), self._code, prepare
        )
        self._classes = AgentClasses(
            self._modules, deployment.base_path, lambda warning: log(warning.render(), "warning")
        )
        self._when_made = when_made
        self._tell_idle = when_idle or (lambda: self.end(0))
        self._watches_idle = self.options.until_idle or when_idle is not None
        self.deliver = Mailboxes(self.directory.find).deliver
        self.services = ServiceDirectory(self._make_directory_agent, self.deliver)
        self._has_environment = deployment.artifact_environment or bool(deployment.workspaces)
        self._seed = self.options.seed if self.options.seed is not None else Random().getrandbits(64)
        self._specs: dict[str, AgentSpec] = {}
        self._ended: asyncio.Future[int] | None = None
        self._ending = False
        self._error: BaseException | None = None
        self._idle_looks = 0
        self._plans: dict[int, ProgramPlans] = {}

    async def run(self, when_started: Callable[[], None] | None = None) -> int:
        """Run the project until it ends; the exit code.

        Args:
            when_started: called when everything has been made, before the first agent has its turn.

        Raises:
            JacarosError: the project cannot be started; the text tells what is wrong.
            InternalError: a defect of JaCaROS showed itself.
        """
        self._ended = asyncio.get_running_loop().create_future()
        arithmetic.warn = self._warn_of_operand
        try:
            await self._start()
            if when_started is not None:
                when_started()
            code = await self._ended
        finally:
            await self._close()
        if self._error is not None:
            raise self._error
        return code

    def _warn_of_operand(self, what: str, value: Term) -> None:
        self.console.log(f"warning: {what} is no number: {text(value)}", "warning")

    @property
    def environment(self) -> "Environment | None":
        """Workspaces and artifacts; None while nobody has needed them."""
        return self._surroundings.environment if self._surroundings is not None else None

    # ---- the start

    async def _start(self) -> None:
        for diagnostic in self.deployment.ignored:
            self.console.log(diagnostic.render(), "warning")
        programs = self._programs.load_all(self.deployment.agents)
        self._classes.check(self.deployment.agents)
        await self.ros.start()
        if self._has_environment and self._is_furnished():
            await self.surroundings().furnish(self.deployment)
        agents = list(zip(self.deployment.agents, programs, strict=True))
        hosts = [self._add(spec, program) for spec, program in agents]
        for host, (spec, program) in zip(hosts, agents, strict=True):
            _begin(host, spec, program)
        if self.options.seconds is not None:
            self.clock.call_later(self.options.seconds, lambda: self.end(0))
        self._when_idle()

    def _is_furnished(self) -> bool:
        """Whether the environment is made at the start, also to tell mistakes in the project's own artifacts."""
        declared = self.deployment.environment or self.deployment.workspaces
        return bool(declared) or has_own_artifacts(self.deployment.base_path)

    def surroundings(self) -> "Surroundings":
        """The environment, opened when it is first asked for."""
        if self._surroundings is None:
            from jacaros.mas.surroundings import Resources, Surroundings

            random = Random(f"{self._seed}/artifacts")
            resources = Resources(
                {"ros": self.ros.backend, "console": lambda: self.console.print, "random": lambda: random}
            )
            self._surroundings = Surroundings(
                self.deployment, self._modules, self.clock, resources, self.console, self.activity, self.fail
            )
        return self._surroundings

    def _add(self, spec: AgentSpec, program: Program) -> AgentHost:
        name = spec.name
        self._specs[name] = spec
        seed = f"{self._seed}/{name}"
        options = mind_options(spec.options)
        plans = self._plans_of(program)
        host = self._classes.make(spec, _initial(spec, program), self, seed, options, self._code, plans)
        self.directory.add(name, host)
        if self._has_environment:
            host.make_body = lambda: self.surroundings().make_body(host)
        if self._surroundings is not None:
            host.body = self._surroundings.situated_body(host, spec)
        if self._when_made is not None:
            self._when_made(host)
        return host

    def _plans_of(self, program: Program) -> ProgramPlans:
        """The plans of a program: agents that run the same one share them, compiled."""
        made = self._plans.get(id(program.plans))
        if made is None:
            made = ProgramPlans(program.plans, self._code.actions)
            self._plans[id(program.plans)] = made
        return made

    def _make_directory_agent(self) -> Agent:
        """The agent of the directory facilitator; an agent of the project that has its name takes its place."""
        host = self.directory.find(DIRECTORY_NAME)
        if host is None:
            host = AgentHost(DIRECTORY_NAME, self, f"{self._seed}/{DIRECTORY_NAME}")
            host.mind = Agent(DIRECTORY_NAME, Program(), host)
            self.directory.add(DIRECTORY_NAME, host)
        mind = host.mind
        assert isinstance(mind, Agent)
        return mind

    # ---- the end

    def end(self, exit_code: int) -> None:
        """End the run: no agent has another turn, no line is printed any more."""
        if self._ending:
            return
        self._ending = True
        self.scheduler.stop()
        for host in self.directory:
            host.halt()
        if self._ended is not None and not self._ended.done():
            self._ended.set_result(exit_code)

    def fail(self, error: BaseException) -> None:
        """End the run because of a defect of JaCaROS itself."""
        if self._error is None:
            self._error = error
        self.end(1)

    async def _close(self) -> None:
        self.end(1)
        for host in self.directory:
            host.end()
        for host in self.directory:
            await host.close()
        if self._surroundings is not None:
            await self._surroundings.environment.close()
        await self.ros.close()

    def _when_idle(self) -> None:
        if self._watches_idle and not self._ending:
            self._idle_looks += 1
            self._look_again(self._idle_looks, _HOPS)

    def _look_again(self, look: int, hops: int) -> None:
        if look != self._idle_looks or self.activity.pending or not self.scheduler.idle or self._ending:
            return
        if hops == 0:
            self._tell_idle()
            return
        asyncio.get_running_loop().call_soon(self._look_again, look, hops - 1)

    # ---- what agents ask for

    def agent_names(self) -> Sequence[str]:
        """Names of all agents, in the order of their making."""
        return self.directory.names()

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds; the agents are told that it will."""
        if delay > 0:
            for host in self.directory:
                host.mind.shut_down_in(delay * 1000)
            AgentTimer(self.clock, self.activity, delay, lambda: self.end(exit_code))
        else:
            self.end(exit_code)

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Make and start an agent; its final name, or None with the reason logged."""
        wanted = source if source is not None else f"{name}.asl"
        try:
            path = self._programs.find(wanted)
            spec = _spec(self.directory.free_name(name), name, path, classes)
            program = self._programs.load(spec)
            host = self._add(spec, program)
        except FileNotFoundError:
            folders = ", ".join(str(folder) for folder in self.deployment.source_paths)
            self.console.log(f"error: agent {name}: there is no program {wanted} in {folders}", "error")
            return None
        except JacarosError as wrong:
            self.console.log(str(wrong), "error")
            return None
        _begin(host, spec, program)
        return host.name

    def clone_agent(self, original: str, name: str) -> str | None:
        """Make an agent with a copy of the mind of *original*; its final name, or None with the reason logged."""
        host = self.directory.find(original)
        spec = self._specs.get(original)
        if host is None or spec is None or not isinstance(host.mind, Agent):
            self.console.log(f"error: agent {name}: there is no agent {original} to be cloned", "error")
            return None
        empty = replace(host.mind.program, beliefs=(), goals=())
        copy = self._add(replace(spec, name=self.directory.free_name(name)), empty)
        assert isinstance(copy.mind, Agent)
        copy.mind.copy_mind_of(host.mind)
        return copy.name

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        """End an agent after *delay* seconds, of which it is told, on behalf of another one.

        False when there is none of that name, or it does not accept its end.
        """
        host = self.directory.find(name)
        if host is None or not host.mind.accept_kill(killer):
            return False
        if delay > 0:
            host.mind.shut_down_in(delay * 1000)
            AgentTimer(self.clock, self.activity, delay, lambda: self._kill(host))
        else:
            self._kill(host)
        return True

    def _kill(self, host: AgentHost) -> None:
        if self.directory.find(host.name) is host:
            self.directory.remove(host.name)
        host.halt()
        host.end()

    def list_files(self, folder: str) -> Sequence[str]:
        """The files in a folder and in the folders in it, as paths that begin with *folder*, sorted.

        Raises:
            OSError: when it cannot be read.
        """
        return self._programs.list_files(folder, self.deployment.base_path)

    def write_file(self, path: str, text: str) -> None:
        """Write a text file; a path that is not absolute is one of the project's folder.

        Raises:
            OSError: when it cannot be written.
        """
        (self.deployment.base_path / path).write_text(text, encoding="utf-8")

    def read_program(self, path: str) -> tuple[str, str]:
        """Name and text of a program file.

        Raises:
            FileNotFoundError: there is none.
        """
        return self._programs.include(path, str(self.deployment.base_path / "."))


def _spec(name: str, declared: str, path: Path, classes: Mapping[str, str]) -> AgentSpec:
    """An agent that is made at run time."""
    architecture = classes.get("agentArchClass")
    return AgentSpec(
        name,
        path,
        declared,
        agent_class=classes.get("agentClass"),
        architecture_classes=(architecture,) if architecture is not None else (),
        belief_base_class=classes.get("beliefBaseClass"),
    )


def _is_situated(spec: AgentSpec) -> bool:
    """Whether an agent begins with workspaces joined or artifacts focused."""
    return bool(spec.join or spec.focus)


def _initial(spec: AgentSpec, program: Program) -> Program:
    """What the mind begins with; the goals of a situated agent come later, see `_begin`."""
    return replace(program, goals=()) if _is_situated(spec) else program


def _begin(host: AgentHost, spec: AgentSpec, program: Program) -> None:
    """Let a mind begin: as in JaCaMo, what it focuses is noticed before it adopts its goals."""
    host.mind.start()
    if _is_situated(spec):
        host.mind.run(1)
        host.mind.adopt(program.goals)
