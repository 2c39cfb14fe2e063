"""The lifecycle of agents in a run: create, clone, end."""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import Program
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.mind.storage import copy_mind
from jacaros.errors import JacarosError
from jacaros.mas.agent_classes import begin_as, check_classes, object_of_class
from jacaros.mas.agent_host import AgentHost, Run
from jacaros.mas.agent_options import mind_options
from jacaros.mas.deployment import AgentSpec
from jacaros.mas.directory import Directory
from jacaros.mas.idleness import AgentTimer
from jacaros.mas.programs import Programs
from jacaros.mas.project.declarations import class_without_effect
from jacaros.mas.python_code import PythonCode


class AgentLifecycle:
    """Creates and ends the agents of a run.

    Args:
        run: port of the run for their hosts.
        directory: the directory of agents.
        programs: reads programs.
        code: the project's Python code.
        seed: seed of the run.
        plain: run plans without generated code.
        situate: gives each agent its place in the environment: a body, or a function that creates one.
        when_made: called with every agent before it begins.

    Attributes:
        programs: reads programs.
        when_ended: called with every agent that ends before the run does.
    """

    def __init__(
        self,
        run: Run,
        directory: Directory[AgentHost],
        programs: Programs,
        code: PythonCode,
        seed: int,
        plain: bool,
        situate: Callable[[AgentHost, AgentSpec], None],
        when_made: Callable[[AgentHost], None] | None = None,
    ) -> None:
        self.programs = programs
        self._run = run
        self._directory = directory
        self._code = code
        self._seed = seed
        self._plain = plain
        self._situate = situate
        self._when_made = when_made
        self.when_ended: Callable[[str], None] = lambda name: None
        self._warned: set[str] = set()
        self._specs: dict[str, AgentSpec] = {}
        self._plans: dict[int, ProgramPlans] = {}
        self._uncompiled: deque[ProgramPlans] = deque()

    def check(self, agents: Iterable[AgentSpec]) -> None:
        """Find the classes of agents, to report errors before anything runs.

        Raises:
            ProjectError: all errors.
        """
        check_classes(self._code.modules, agents, self._warn)

    def _warn(self, warning: Diagnostic) -> None:
        if warning.message not in self._warned:
            self._warned.add(warning.message)
            self._run.console.log(warning.render(), "warning")

    def add(self, spec: AgentSpec, program: Program) -> AgentHost:
        """Create an agent. To start it, call `begin`.

        Raises:
            ProjectError: its class cannot be found or instantiated.
        """
        self._specs[spec.name] = spec
        host = self._make(spec, program)
        self._directory.add(spec.name, host)
        self._situate(host, spec)
        if self._when_made is not None:
            self._when_made(host)
        return host

    def _make(self, spec: AgentSpec, program: Program) -> AgentHost:
        """Return the host of an agent, with its mind."""
        seed = f"{self._seed}/{spec.name}"
        if spec.is_python:
            from jacaros.mas.python_agents import loading  # here: most projects have none

            return loading.make(self._code.modules, spec, self._run, seed)
        made = object_of_class(self._code.modules, spec, self._warn)
        host = AgentHost(spec.name, self._run, seed)
        kind = Mind
        if made is not None:
            from jacaros.agents.python.customising import CustomMind  # here: most projects have no classes

            kind = CustomMind
        options = replace(mind_options(spec.options), plans_from_others=not self._code.restricted)
        # The goals of a situated agent come later: see `AgentHost.begin`.
        initial = replace(program, goals=()) if spec.is_situated else program
        plans = self.plans_of(program)
        mind = kind(spec.name, initial, host, options, self._code.actions, plans)  # pyright: ignore[reportArgumentType]
        self._code.serve(mind)
        host.set_mind(mind)
        if made is not None:
            begin_as(spec, mind, made)
        return host

    def begin(self, host: AgentHost, program: Program) -> None:
        """Start an agent."""
        host.begin(program.goals if self._specs[host.name].is_situated else None)

    def plans_of(self, program: Program) -> ProgramPlans:
        """Return the plans of a program. Agents with the same program share them, compiled."""
        made = self._plans.get(id(program.plans))
        if made is None:
            made = ProgramPlans(program.plans, new_engine(self._code.actions, self._plain))
            self._plans[id(program.plans)] = made
            self._uncompiled.append(made)
        return made

    def spec(self, name: str) -> AgentSpec | None:
        """Return the declaration of an agent, or None if the run has created no agent of this name."""
        return self._specs.get(name)

    def compile_ahead(self) -> bool:
        """Compile plans that no event has needed yet, for a few milliseconds. Return False when none is left."""
        while self._uncompiled:
            plans = self._uncompiled[0]
            if plans.engine.compile_ahead(plans):
                return True
            self._uncompiled.popleft()
        return False

    def create(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Create and start an agent for another one. Return its final name, or None after logging the reason."""
        wanted = source if source is not None else f"{name}.asl"
        log = self._run.console.log
        try:
            path = self.programs.path.find(wanted)
            free = self._directory.free_name(name)
            spec = AgentSpec(free, path, name, agent_class=classes.get("agentClass"))
            program = self.programs.load(spec)
            host = self.add(spec, program)
        except FileNotFoundError as missing:
            log(f"error: agent {name}: program not found: {wanted}; {missing}", "error")
            return None
        except JacarosError as wrong:
            log(str(wrong), "error")
            return None
        for key, written in classes.items():
            found = None if key == "agentClass" else class_without_effect(key, written)
            if found is not None:
                topic, what = found
                log(f"warning: {what} of agent {name} has no effect: {topic.why}; {topic.help}", "warning")
        self.begin(host, program)
        return host.name

    def clone(self, original: str, name: str) -> str | None:
        """Create an agent with a copy of the mind of *original*.

        Return its final name, or None after logging the reason.
        """
        host = self._directory.find(original)
        spec = self._specs.get(original)
        if host is None or spec is None or host.mind is None:
            message = f"error: agent {name}: cannot clone unknown agent `{original}`"
            self._run.console.log(message, "error")
            return None
        copy = self.add(replace(spec, name=self._directory.free_name(name)), host.mind.program)
        assert copy.mind is not None
        copy_mind(host.mind, copy.mind)
        return copy.name

    def kill(self, name: str, delay: float, killer: str) -> bool:
        """Kill an agent on behalf of another, *delay* seconds after announcing it.

        Return False if it is unknown or refuses.
        """
        host = self._directory.find(name)
        if host is None or not host.accept_kill(killer):
            return False
        if delay > 0:
            host.shut_down_in(delay)
            AgentTimer(self._run.clock, self._run.activity, delay, lambda: self.end(host))
        else:
            self.end(host)
        return True

    def end(self, host: AgentHost) -> None:
        """End an agent."""
        if self._directory.find(host.name) is host:
            self._directory.remove(host.name)
        host.halt()
        host.end()
        self.when_ended(host.name)
