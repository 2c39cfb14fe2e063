"""The nodes of a project: the processes that run it together, on one computer or several."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, NodeSpec, WorkspaceSpec
from jacaros.runtime.mas.project.declarations import WrittenName

_MAIN: Final = "/main"
_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,47}")
"""As for members of a fleet."""


class Nodes:
    """The names of the declared nodes.

    Attributes:
        first: the node of everything that names none; None without nodes.
        problems: errors and warnings about nodes.
    """

    def __init__(self, declared: Sequence[NodeSpec]) -> None:
        self._declared = {node.name: node for node in declared}
        self.first = next(iter(self._declared), None)
        self.problems = [
            Diagnostic(
                "error",
                f"invalid name of a node: `{node.name}`",
                node.span,
                "use up to 48 letters, digits, `_` and `-`, beginning with a letter or digit",
            )
            for node in declared
            if _NAME.fullmatch(node.name) is None
        ]

    def named(self, written: WrittenName | None) -> str | None:
        """Return a name as written; None without one, or after reporting that it is unknown."""
        if written is None:
            return None
        name, span = written
        if name in self._declared:
            return name
        help = suggestion(name, self._declared, f"declare it in the project: `node {name}`")
        self.problems.append(Diagnostic("error", f"unknown node `{name}`", span, help))
        return None

    def warn_of_unused(self, specs: Iterable[AgentSpec | WorkspaceSpec]) -> None:
        """Report nodes at which nothing runs."""
        used = {spec.node or self.first for spec in specs}
        self.problems += [
            Diagnostic(
                "warning",
                f"nothing runs at node `{name}`",
                node.span,
                f"declare an agent or a workspace with `node: {name}`",
            )
            for name, node in self._declared.items()
            if name not in used
        ]


def at_node(deployment: Deployment, name: str) -> Deployment:
    """Return the part of a deployment that runs at one of its nodes: the agents and workspaces that are there.

    Agents join workspaces of other nodes later, at the path that these have here. The name is unique, because processes of
    one name would end each other in a ROS graph.
    """
    first = deployment.nodes[0].name
    away = {
        path: f"{_MAIN}@{spec.node or first}" if path == _MAIN else path
        for path, spec in _by_path(deployment.workspaces).items()
        if (spec.node or first) != name
    }
    return replace(
        deployment,
        name=f"{deployment.name}_{name}",
        agents=tuple(_seen_from(each, away) for each in deployment.agents if (each.node or first) == name),
        workspaces=tuple(each for each in deployment.workspaces if (each.node or first) == name),
    )


def _by_path(workspaces: Iterable[WorkspaceSpec]) -> dict[str, WorkspaceSpec]:
    """Return declared workspaces by full path."""
    found: dict[str, WorkspaceSpec] = {}
    for spec in workspaces:
        above = _MAIN if spec.parent is None else _path_of(spec.parent, found)
        found[_MAIN if spec.name == "main" and spec.parent is None else f"{above}/{spec.name}"] = spec
    return found


def _path_of(name: str, paths: Iterable[str]) -> str:
    """Return the full path of a workspace, named by its path or by a name that only one path ends with."""
    return next((path for path in paths if path == name or path.endswith(f"/{name}")), name)


def _seen_from(agent: AgentSpec, away: dict[str, str]) -> AgentSpec:
    """Return an agent that joins workspaces of other nodes later. *away* are their paths there and here."""

    def here(name: str) -> str:
        return away.get(_path_of(name, away), name)

    join = tuple(map(here, agent.join))
    focus = tuple(replace(each, workspace=here(each.workspace or _MAIN)) for each in agent.focus)
    later = [path for path in join if path in away.values() or path in agent.join_later]
    return replace(agent, join=join, focus=focus, join_later=tuple(later))
