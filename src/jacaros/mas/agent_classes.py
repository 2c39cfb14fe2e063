"""Agents whose class a project file names."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.language.nodes import Program
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.errors import JacarosError
from jacaros.files.python_modules import NotImported, ProjectModules
from jacaros.mas.agent_host import AgentHost, Run
from jacaros.mas.deployment import AgentSpec, ProjectError
from jacaros.mas.python_code import PythonCode

if TYPE_CHECKING:
    from jacaros.agents.python.customising import Made

_DEFAULTS = ("", "jason.asSemantics.Agent")


class AgentClasses:
    """Creates the hosts and minds of agents, including those of user-defined classes.

    Args:
        modules: the project's Python code.
        warn: takes a warning.
    """

    def __init__(self, modules: ProjectModules, warn: Callable[[Diagnostic], None]) -> None:
        self._modules, self._warn = modules, warn
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
                    self._object(spec)
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
        made = self._object(spec)
        host = AgentHost(spec.name, run, seed)
        kind = Mind
        if made is not None:
            from jacaros.agents.python.customising import CustomMind  # here: most projects have no classes

            kind = CustomMind
        mind = kind(spec.name, program, host, options, code.actions, plans)  # pyright: ignore[reportArgumentType]
        code.serve(mind)
        host.mind = mind
        if made is not None:
            self._begin_as(spec, mind, made)
        return host

    def _begin_as(self, spec: AgentSpec, mind: Mind, face: "Made") -> None:
        from jacaros.agents.python.customising import begin_as

        try:
            begin_as(mind, face.made)
            face.made.init(*face.arguments)
        except JacarosError as error:
            raise self._project_error(spec, str(error)) from error
        except Exception as error:
            from jacaros.agents.python.declaring import crash_text

            message = crash_text(f"agent {spec.name}", face.made.init, error)
            raise self._project_error(spec, message) from error

    def _object(self, spec: AgentSpec) -> "Made | None":
        """Return an object of the agent's class; None, with a warning, if the project does not have the class."""
        written = spec.agent_class or ""
        name = written.partition("(")[0].strip()
        if name in _DEFAULTS:
            return None
        from jacaros.agents.python.customising import object_of

        try:
            made = object_of(self._modules, written)
        except (ProjectError, NotImported):
            raise
        except JacarosError as error:
            raise self._project_error(spec, str(error)) from error
        if made is None:
            self._warn_once(_java_class(spec, name))
        return made

    def _warn_once(self, warning: Diagnostic) -> None:
        if warning.message not in self._warned:
            self._warned.add(warning.message)
            self._warn(warning)

    def _project_error(self, spec: AgentSpec, message: str) -> ProjectError:
        return ProjectError([Diagnostic("error", message, spec.span)])


def _java_class(spec: AgentSpec, name: str) -> Diagnostic:
    module, _, last = name.rpartition(".")
    own = bool(module) and not name.startswith("jason.")
    help = f"write `class {last}(jacaros.Agent)` in {module.replace('.', '/')}.py" if own else None
    return Diagnostic("warning", f"the Java class `{name}` has no effect", spec.span, help)
