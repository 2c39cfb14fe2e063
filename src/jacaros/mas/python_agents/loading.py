"""Load agents written in Python: from the file that a project names to the object of the user's class."""

from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.python.python_agent import PythonAgent
from jacaros.files.python_modules import UNSEEN, ModuleUnreadable, ProjectModules
from jacaros.files.texts import suggestion
from jacaros.mas.agent_host import Run
from jacaros.mas.console import place_of_fault
from jacaros.mas.deployment import AgentSpec, ProjectError
from jacaros.mas.directory import NAME as DIRECTORY_NAME
from jacaros.mas.python_agents.host import PythonAgentHost

_OF_MINDS: Final = (
    "events",
    "intBels",
    "nrcbp",
    "rule_depth",
    "goal_depth",
    "urgency",
    "tro",
)
"""Options of a mind, which a Python agent does not have."""


def agent_class(modules: ProjectModules, spec: AgentSpec) -> type[PythonAgent]:
    """Return the class of an agent: the one in its file, the one that the project names, or the one with the agent's name.

    Raises:
        ProjectError: the file has no such class, or several, or cannot be imported.
    """
    if spec.python_class is not None:
        return spec.python_class
    module = _module(modules, spec)
    found = _classes(module)
    wanted = spec.options.get("class") or spec.agent_class
    file = spec.source_path
    if not found or (wanted is not None and wanted.rpartition(".")[2] not in found):
        for name in [name for name, value in vars(module).items() if value is UNSEEN] or [""]:
            modules.require_seen(module, name)
    if not found:
        raise _wrong(spec, f"no subclass of jacaros.PythonAgent in {file}")
    if wanted is not None:
        if wanted.rpartition(".")[2] in found:
            return found[wanted.rpartition(".")[2]]
        help = suggestion(wanted, found, f"it has {', '.join(found)}")
        raise _wrong(spec, f"no subclass `{wanted}` of jacaros.PythonAgent in {file}", help)
    if len(found) == 1:
        return next(iter(found.values()))
    for name in (spec.declared_name, spec.name, file.stem):
        meant = [each for each in found if each.lower() == name.replace("_", "").lower()]
        if len(meant) == 1:
            return found[meant[0]]
    raise _wrong(
        spec,
        f"ambiguous class of agent `{spec.declared_name}`: {file} has several, and none has the agent's name",
        f"name one of {', '.join(found)}: `[class=...]` in a .mas2j file, `class: ...` in a .jcm file",
    )


def _module(modules: ProjectModules, spec: AgentSpec) -> ModuleType:
    path = spec.source_path.resolve()
    for folder in modules.folders:
        if path.is_relative_to(folder):
            name = ".".join(path.relative_to(folder).with_suffix("").parts)
            if modules.place(name) == path:
                try:
                    return modules.load(name)[0]
                except ModuleUnreadable as wrong:
                    raise _wrong(spec, str(wrong)) from wrong
    raise _wrong(spec, f"cannot import {spec.source_path}: its folders do not have valid Python names")


def _classes(module: ModuleType) -> dict[str, type[PythonAgent]]:
    """Return the agent classes that a module defines or, without any, those that it imports."""
    known = {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type) and issubclass(value, PythonAgent) and value is not PythonAgent
    }
    own = {name: value for name, value in known.items() if value.__module__ == module.__name__}
    return own or known


def check(modules: ProjectModules, spec: AgentSpec, warn: Callable[[Diagnostic], object]) -> None:
    """Check the class of an agent, and warn about options without effect.

    Raises:
        ProjectError: the class cannot be found.
    """
    for what in _without_effect(spec):
        message = f"{what} of agent `{spec.declared_name}` has no effect: it is a Python agent"
        warn(Diagnostic("warning", message, spec.span))
    if spec.name == DIRECTORY_NAME:
        raise _wrong(spec, "the directory facilitator `df` cannot be a Python agent")
    agent_class(modules, spec)


def _without_effect(spec: AgentSpec) -> Sequence[str]:
    found = [f"the option `{option}`" for option in _OF_MINDS if option in spec.options]
    if spec.goals.strip():
        found.append("`goals`")
    if any(focus.namespace for focus in spec.focus):
        found.append("the namespace of a focus")
    return found


def make(modules: ProjectModules, spec: AgentSpec, run: Run, seed: str) -> PythonAgentHost:
    """Return the host of an agent written in Python, not yet started.

    Raises:
        ProjectError: the class cannot be found, or its constructor fails.
    """
    kind = agent_class(modules, spec)
    try:
        agent = kind()
    except Exception as error:
        message = f"cannot create {kind.__name__}: {type(error).__name__}: {error}{place_of_fault(error)}"
        raise _wrong(spec, message) from error
    return PythonAgentHost(agent, spec, run, seed)


def _wrong(spec: AgentSpec, message: str, help: str | None = None) -> ProjectError:
    return ProjectError([Diagnostic("error", message, spec.span, help)])
