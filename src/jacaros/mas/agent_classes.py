"""Agents whose class a project file names."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.mind.mind import Mind
from jacaros.errors import JacarosError
from jacaros.files.python_modules import NotImported, ProjectModules
from jacaros.mas.deployment import AgentSpec, ProjectError

if TYPE_CHECKING:
    from jacaros.agents.python.customising import Made

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
                from jacaros.mas.python_agents import loading  # here: most projects have none

                loading.check(modules, spec, warn)
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
