"""Agents whose class, belief base or architecture a project file names."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.nodes import Program
from jacaros.bdi.mind import Mind
from jacaros.bdi.state.options import Options
from jacaros.bdi.state.plan_library import ProgramPlans
from jacaros.errors import JacarosError
from jacaros.mas.agent_host import AgentHost, Run
from jacaros.mas.deployment import AgentSpec, ProjectError
from jacaros.mas.python_code import PythonCode
from jacaros.project_modules import NotImported, ProjectModules

if TYPE_CHECKING:
    from jacaros.extension.agent import Agent, AgentArch
    from jacaros.extension.belief_base import BeliefBase
    from jacaros.extension.classes import Made

    _Objects = tuple[Made[Agent] | None, Made[BeliefBase] | None, list[Made[AgentArch]]]

T = TypeVar("T")

_KNOWN_ARCHITECTURES = ("jaca.", "c4jason.")
"""Packages of architectures of other systems whose work JaCaROS does itself."""

_DEFAULTS = frozenset(
    {"jason.asSemantics.Agent", "jason.architecture.AgArch", "jason.bb.DefaultBeliefBase", ""}
)


def is_own_architecture(written: str) -> bool:
    """Return whether an ``agentArchClass`` is user-defined, rather than one whose work JaCaROS does itself."""
    return written not in _DEFAULTS and not written.startswith(_KNOWN_ARCHITECTURES)


class AgentClasses:
    """Creates the hosts and minds of agents, including those of user-defined classes.

    Args:
        modules: the project's Python code.
        folder: folder of the project.
        warn: takes a warning.
    """

    def __init__(self, modules: ProjectModules, folder: Path, warn: Callable[[Diagnostic], None]) -> None:
        self._modules, self._folder, self._warn = modules, folder, warn
        self._warned: set[str] = set()

    def check(self, agents: Iterable[AgentSpec]) -> None:
        """Find all classes, to report errors before anything runs.

        Raises:
            ProjectError: all errors.
        """
        wrong: list[Diagnostic] = []
        for spec in agents:
            try:
                if spec.is_python:
                    from jacaros.mas.python_agents import loading  # here: most projects have none

                    loading.check(self._modules, spec, self._warn_once)
                else:
                    self._objects(spec)
            except NotImported:
                continue
            except JacarosError as error:
                found = error.diagnostics if isinstance(error, ProjectError) else ()
                wrong += [d for d in found if d not in wrong]
        if wrong:
            raise ProjectError(wrong)

    def make(
        self,
        spec: AgentSpec,
        program: Program,
        run: Run,
        seed: str,
        options: Options,
        code: PythonCode,
        plans: ProgramPlans,
    ) -> AgentHost:
        """Return the host of an agent, with its mind.

        Raises:
            ProjectError: a class cannot be found or instantiated.
        """
        if spec.is_python:
            from jacaros.mas.python_agents import loading

            return loading.make(self._modules, spec, run, seed)
        objects = self._objects(spec)
        if any(objects):
            return self._custom(spec, program, run, seed, options, code, plans, objects)
        host = AgentHost(spec.name, run, seed)
        mind = Mind(spec.name, program, host, options, code.actions, plans)  # pyright: ignore[reportArgumentType]
        code.serve(mind)
        host.mind = mind
        return host

    def _custom(
        self,
        spec: AgentSpec,
        program: Program,
        run: Run,
        seed: str,
        options: Options,
        code: PythonCode,
        plans: ProgramPlans,
        objects: "_Objects",
    ) -> AgentHost:
        # Imported on demand: most projects have no user-defined classes.
        from jacaros.extension.agent import agent_of
        from jacaros.extension.belief_base import install
        from jacaros.extension.customising import CustomMind
        from jacaros.mas.custom_host import CustomHost

        face, base, architectures = objects
        host = CustomHost(spec.name, run, seed)
        mind = CustomMind(spec.name, program, host, options, code.actions, plans)
        code.serve(mind)
        host.mind = mind
        try:
            if face is not None:
                mind.begin_as(face.made)
            if base is not None:
                install(mind, base.made, self._folder, base.arguments)
                host.at_end(base.made.stop)
            if face is not None:
                face.made.init(*face.arguments)
            host.take([each.made for each in architectures])
            for each in architectures:
                each.made.agent = agent_of(mind)
                each.made.init(*each.arguments)
                host.at_end(each.made.stop)
        except JacarosError as error:
            raise self._project_error(spec, str(error)) from error
        except Exception as error:
            from jacaros.extension.calling import crash_text

            message = crash_text(f"agent {spec.name}", type(self)._custom, error)
            raise self._project_error(spec, message) from error
        return host

    def _objects(self, spec: AgentSpec) -> "_Objects":
        """Return objects for the agent class, the belief base and the architectures.

        The last declared architecture comes first.
        """
        if not _names_classes(spec):
            return None, None, []
        from jacaros.extension.agent import Agent, AgentArch
        from jacaros.extension.belief_base import BeliefBase
        from jacaros.extension.classes import base_of, object_of

        try:
            face = self._object(spec, spec.agent_class, Agent, object_of)
            base = self._object(spec, spec.belief_base_class, BeliefBase, base_of)
            found = [
                self._object(spec, written, AgentArch, object_of)
                for written in reversed(spec.architecture_classes)
                if is_own_architecture(written)
            ]
        except (ProjectError, NotImported):
            raise
        except JacarosError as error:
            raise self._project_error(spec, str(error)) from error
        return face, base, [made for made in found if made is not None]

    def _object(
        self,
        spec: AgentSpec,
        written: str | None,
        kind: type[T],
        make: "Callable[[ProjectModules, str, type[T]], Made[T] | None]",
    ) -> "Made[T] | None":
        name = (written or "").partition("(")[0].strip()
        if written is None or name in _DEFAULTS:
            return None
        made = make(self._modules, written, kind)
        if made is None and name not in self._warned:
            self._warned.add(name)
            module, _, last = name.rpartition(".")
            file = f"{module.replace('.', '/')}.py"
            own = bool(module) and not name.startswith("jason.")
            help = f"write `class {last}(jacaros.{kind.__name__})` in {file}" if own else None
            self._warn(Diagnostic("warning", f"the Java class `{name}` has no effect", spec.span, help))
        return made

    def _warn_once(self, warning: Diagnostic) -> None:
        if warning.message not in self._warned:
            self._warned.add(warning.message)
            self._warn(warning)

    def _project_error(self, spec: AgentSpec, message: str) -> ProjectError:
        return ProjectError([Diagnostic("error", message, spec.span)])


def _names_classes(spec: AgentSpec) -> bool:
    return bool(spec.agent_class or spec.belief_base_class or spec.architecture_classes)
