"""The lifecycle of agents in a run: create, clone, end; and agents whose class a project file names."""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import Program
from jacaros.agents.mind.mind import Mind, new_engine
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.mind.storage import copy_mind
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.python_modules import NotImported, ProjectModules
from jacaros.runtime.mas.agents.host import AgentHost, Run
from jacaros.runtime.mas.agents.options import mind_options
from jacaros.runtime.mas.agents.programs import Programs
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import AgentSpec, ProjectError
from jacaros.runtime.mas.directory import Directory
from jacaros.runtime.mas.project.declarations import class_without_effect
from jacaros.runtime.mas.scheduler import AgentTimer

if TYPE_CHECKING:
    from jacaros.agents.python.customising import Made


@dataclass(eq=False)
class AgentLifecycle:
    """Creates and ends the agents of a run.

    Attributes:
        run: port of the run for their hosts.
        directory: the directory of agents.
        programs: reads programs.
        code: the project's Python code.
        seed: seed of the run.
        plain: run plans without generated code.
        situate: gives each agent its place in the environment: a body, or a function that creates one.
        when_made: called with every agent before it begins.
        when_ended: called with every agent that ends before the run does.
    """

    run: Run
    directory: Directory
    programs: Programs
    code: PythonCode
    seed: int
    plain: bool
    situate: Callable[[AgentHost, AgentSpec], None]
    when_made: Callable[[AgentHost], None] | None = None
    when_ended: Callable[[str], None] = lambda name: None
    _warned: set[str] = field(default_factory=set)
    _specs: dict[str, AgentSpec] = field(default_factory=dict)
    _plans: dict[int, ProgramPlans] = field(default_factory=dict)
    _uncompiled: deque[ProgramPlans] = field(default_factory=deque)

    def check(self, agents: Iterable[AgentSpec]) -> None:
        """Find the classes of agents, to report errors before anything runs.

        Raises:
            ProjectError: all errors.
        """
        check_classes(self.code.modules, agents, self._warn)

    def _warn(self, warning: Diagnostic) -> None:
        if warning.message not in self._warned:
            self._warned.add(warning.message)
            self.run.console.log(warning.render(), "warning")

    def add(self, spec: AgentSpec, program: Program) -> AgentHost:
        """Create an agent. To start it, call `begin`.

        Raises:
            ProjectError: its class cannot be found or instantiated.
        """
        self._specs[spec.name] = spec
        host = self._make(spec, program)
        self.directory.add(spec.name, host)
        self.situate(host, spec)
        if self.when_made is not None:
            self.when_made(host)
        return host

    def _make(self, spec: AgentSpec, program: Program) -> AgentHost:
        seed = f"{self.seed}/{spec.name}"
        if spec.is_python:
            from jacaros.runtime.mas.agents.python_agents import (
                make_python_agent,  # here: most projects have none
            )

            return make_python_agent(self.code.modules, spec, self.run, seed)
        made = object_of_class(self.code.modules, spec, self._warn)
        host = AgentHost(spec.name, self.run, seed)
        kind = Mind
        if made is not None:
            from jacaros.agents.python.customising import CustomMind  # here: most projects have no classes

            kind = CustomMind
        options = replace(mind_options(spec.options), plans_from_others=not self.code.restricted)
        # The goals of a situated agent come later: see `AgentHost.begin`.
        initial = replace(program, goals=()) if spec.is_situated else program
        plans = self.plans_of(program)
        mind = kind(spec.name, initial, host, options, self.code.actions, plans)  # pyright: ignore[reportArgumentType]
        self.code.serve(mind)
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
            made = ProgramPlans(program.plans, new_engine(self.code.actions, self.plain))
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
        log = self.run.console.log
        try:
            path = self.programs.path.find(wanted)
            free = self.directory.free_name(name)
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
        host = self.directory.find(original)
        spec = self._specs.get(original)
        if host is None or spec is None or host.mind is None:
            message = f"error: agent {name}: cannot clone unknown agent `{original}`"
            self.run.console.log(message, "error")
            return None
        copy = self.add(replace(spec, name=self.directory.free_name(name)), host.mind.program)
        assert copy.mind is not None
        copy_mind(host.mind, copy.mind)
        return copy.name

    def kill(self, name: str, delay: float, killer: str) -> bool:
        """Kill an agent on behalf of another, *delay* seconds after announcing it.

        Return False if it is unknown or refuses.
        """
        host = self.directory.find(name)
        if host is None or not host.accept_kill(killer):
            return False
        if delay > 0:
            host.shut_down_in(delay)
            AgentTimer(self.run.clock, self.run.activity, delay, lambda: self.end(host))
        else:
            self.end(host)
        return True

    def end(self, host: AgentHost) -> None:
        """End an agent."""
        if self.directory.find(host.name) is host:
            self.directory.remove(host.name)
        host.halt()
        host.end()
        self.when_ended(host.name)


_DEFAULTS = ("", "jason.asSemantics.Agent")

Warn = Callable[[Diagnostic], object]
"""Takes a warning."""


def check_classes(modules: ProjectModules, agents: Iterable[AgentSpec], warn: Warn) -> None:
    """Find the classes of agents, to report errors before anything runs.

    Raises:
        ProjectError: all errors.
    """
    wrong: list[Diagnostic] = []
    for spec in agents:
        try:
            if spec.is_python:
                from jacaros.runtime.mas.agents.python_agents import check_python_agent  # here: see `_make`

                check_python_agent(modules, spec, warn)
            else:
                object_of_class(modules, spec, warn)
        except NotImported:
            continue
        except ProjectError as error:
            wrong += [d for d in error.diagnostics if d not in wrong]
    if wrong:
        raise ProjectError(wrong)


def object_of_class(modules: ProjectModules, spec: AgentSpec, warn: Warn) -> "Made | None":
    """Return an object of the class of an agent; None, with a warning, if the project does not have the class.

    Raises:
        ProjectError: the class cannot be instantiated.
    """
    written = spec.agent_class or ""
    name = written.partition("(")[0].strip()
    if name in _DEFAULTS:
        return None
    from jacaros.agents.python.customising import object_of  # here: most projects have no classes

    try:
        made = object_of(modules, written)
    except (ProjectError, NotImported):
        raise
    except JacarosError as error:
        raise _project_error(spec, str(error)) from error
    if made is None:
        warn(_java_class(spec, name))
    return made


def begin_as(spec: AgentSpec, mind: Mind, face: "Made") -> None:
    """Connect a mind to an object of a class.

    Raises:
        ProjectError: its ``init`` fails.
    """
    from jacaros.agents.python import customising
    from jacaros.agents.python.declaring import crash_text

    try:
        customising.begin_as(mind, face.made)
        face.made.init(*face.arguments)
    except JacarosError as error:
        raise _project_error(spec, str(error)) from error
    except Exception as error:
        message = crash_text(f"agent {spec.name}", face.made.init, error)
        raise _project_error(spec, message) from error


def _project_error(spec: AgentSpec, message: str) -> ProjectError:
    return ProjectError([Diagnostic("error", message, spec.span)])


def _java_class(spec: AgentSpec, name: str) -> Diagnostic:
    module, _, last = name.rpartition(".")
    own = bool(module) and not name.startswith("jason.")
    help = f"write `class {last}(jacaros.Agent)` in {module.replace('.', '/')}.py" if own else None
    return Diagnostic("warning", f"the Java class `{name}` has no effect", spec.span, help)
