"""From declarations to agents and workspaces: names are resolved, programs found, and agents expanded to instances."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from jacaros.agents.language.diagnostics import AslError, Diagnostic, Span
from jacaros.agents.language.loader import parse_literals
from jacaros.artifacts.env.errors import resolve_path
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.mas.agents.options import check_option
from jacaros.runtime.mas.agents.programs import SourcePath
from jacaros.runtime.mas.deployment import AgentSpec, FocusSpec, WorkspaceSpec
from jacaros.runtime.mas.project.declarations import (
    AgentPart,
    FocusPart,
    JoinPart,
    ProjectPart,
    Unsupported,
    WorkspacePart,
    WrittenName,
)
from jacaros.runtime.mas.project.nodes import Nodes

_MAIN = "/main"
_DEFAULT_NAMES = frozenset({"workspace", "blackboard", "console", "manrepo", "system"})
_FLEET = "fleet"
"""The artifact in ``/main`` of each member of a fleet, unless the project declares another one of this name."""
"""The standard artifacts of every workspace."""


class Resolver:
    """Resolves the names of a project. Several instances of an agent report each diagnostic only once.

    A workspace is named by its name, by its path below ``/main``, or by its full path.

    Args:
        part: the declarations of the project.
        diagnostics: those found so far; more are added.

    Attributes:
        nodes: names of the nodes.
    """

    def __init__(self, part: ProjectPart, diagnostics: list[Diagnostic]) -> None:
        self._part, self.diagnostics = part, diagnostics
        self.nodes = Nodes(part.nodes)
        self._paths: dict[str, WorkspacePart | None] = {_MAIN: None}
        for workspace in part.workspaces:
            self._add_workspace(workspace)

    def error(self, message: str, span: Span | None, help: str | None = None) -> None:
        self.add(Diagnostic("error", message, span, help))

    def warn(self, message: str, span: Span | None, help: str | None = None) -> None:
        self.add(Diagnostic("warning", message, span, help))

    def add(self, diagnostic: Diagnostic) -> None:
        if diagnostic not in self.diagnostics:
            self.diagnostics.append(diagnostic)

    def repeated(self, names: Iterable[tuple[str, Span | None]], what: str) -> None:
        """Report names that occur twice."""
        seen: dict[str, Span | None] = {}
        for name, span in names:
            if name in seen:
                first = seen[name]
                help = None if first is None else f"the first one is at {first.file.name}:{first.line}"
                self.error(f"duplicate {what} `{name}`", span, help)
            seen.setdefault(name, span)

    # what is declared

    def _add_workspace(self, workspace: WorkspacePart) -> None:
        """Compute the full path of a workspace, and add it and the workspaces above it."""
        path = self._path(workspace, ())
        if self._paths.get(path) is not None:
            self.error(f"duplicate workspace `{workspace.name}`", workspace.span)
            return
        above = path
        while (above := above.rpartition("/")[0]) and above not in self._paths:
            self._paths[above] = None
        self._paths[path] = workspace

    def _path(self, workspace: WorkspacePart, below: tuple[str, ...]) -> str:
        name, parent = workspace.name, _MAIN
        if workspace.parent is not None:
            parent = self._path_of_parent(workspace, workspace.parent, (*below, name))
        if name in ("main", _MAIN):
            return _MAIN
        return name if name.startswith("/") else resolve_path(parent, name)

    def _path_of_parent(self, workspace: WorkspacePart, wanted: str, below: tuple[str, ...]) -> str:
        if wanted in ("main", _MAIN) or wanted.startswith(f"{_MAIN}/"):
            return resolve_path("/", wanted)
        for other in self._part.workspaces:
            if other.name == wanted or other.name.endswith(f"/{wanted}"):
                if other.name in below:
                    self.error(f"workspace `{workspace.name}` is its own ancestor", workspace.span)
                    return _MAIN
                return self._path(other, below)
        help = suggestion(wanted, sorted({each.name for each in self._part.workspaces})) or None
        self.error(f"unknown workspace `{wanted}`", workspace.parent_span, help)
        return _MAIN

    def specs(self) -> tuple[WorkspaceSpec, ...]:
        """Return the workspaces in the order of the file, but each after its parent."""
        known = {name for agent in self._part.agents for name in (agent.name, *agent.instance_names())}
        for workspace in self._part.workspaces:
            self._check(workspace, known)
        ordered: dict[str, None] = {}
        for path in self._paths:
            parts = path.split("/")
            ordered |= dict.fromkeys("/".join(parts[:length]) for length in range(2, len(parts) + 1))
        # Without a declaration, `main` exists in any case.
        return tuple(
            self._spec(path, self._paths[path])
            for path in ordered
            if path != _MAIN or self._paths[path] is not None
        )

    def _spec(self, path: str, part: WorkspacePart | None) -> WorkspaceSpec:
        above, _, name = path.rpartition("/")
        parent = self._shortest(above) if above not in ("", _MAIN) else None
        node = self._node_of(path)
        if part is None:
            return WorkspaceSpec(name, parent=parent, node=node)
        artifacts = tuple(artifact.spec for artifact in part.artifacts if artifact.spec.type_name)
        agents = tuple(agent for agent, _ in part.agents)
        return WorkspaceSpec(name, artifacts, agents, parent, node, part.span)

    def _node_of(self, path: str) -> str | None:
        """Return the node of a workspace: the one it names, or that of the workspace around it."""
        part = self._paths.get(path)
        if part is None and path != _MAIN:
            # Only workspaces below it are declared.
            part = next(
                (each for below, each in self._paths.items() if each and below.startswith(f"{path}/")), None
            )
        if part is not None and part.node is not None:
            return self.nodes.named(part.node)
        above = path.rpartition("/")[0]
        return None if above in ("", _MAIN) else self._node_of(above)

    def _is_at(self, path: str, node: str | None) -> bool:
        """Return whether a workspace is at a node. None is the first node."""
        return (self._node_of(path) or self.nodes.first) == (node or self.nodes.first)

    def _check(self, workspace: WorkspacePart, known: set[str]) -> None:
        artifacts = [(artifact.spec.name, artifact.spec.span) for artifact in workspace.artifacts]
        focused_by = [(name, span) for each in workspace.artifacts for name, _, span in each.focused_by]
        for name, agent_span in (*workspace.agents, *focused_by):
            self._check_agent(name, agent_span, known)
        self.repeated(artifacts, "artifact")
        self._check_node(workspace)
        for name, span in artifacts:
            if name in _DEFAULT_NAMES:
                message = f"`{name}` is a standard artifact of every workspace"
                self.error(message, span, "choose another name")

    def _check_node(self, workspace: WorkspacePart) -> None:
        """Report a workspace at another node than the workspace around it."""
        path = next((path for path, part in self._paths.items() if part is workspace), _MAIN)
        above = path.rpartition("/")[0]
        if above in ("", _MAIN) or self._is_at(above, self._node_of(path)):
            return
        node = self._node_of(above) or self.nodes.first
        message = f"the workspace around `{workspace.name}` is at another node: `{node}`"
        span = workspace.span if workspace.node is None else workspace.node[1]
        self.error(message, span, f"write `node: {node}`, or declare `{workspace.name}` outside of it")

    def _check_agent(self, name: str, span: Span, known: set[str]) -> None:
        if name != "*" and name not in known:
            self.error(f"unknown agent `{name}`", span, suggestion(name, sorted(known)) or None)

    # what names lead to

    def _shortest_name(self, workspace: WorkspacePart) -> str:
        """Return the name of a declared workspace, or its full path if the name is ambiguous."""
        return next((self._shortest(path) for path, part in self._paths.items() if part is workspace), _MAIN)

    def _shortest(self, path: str) -> str:
        name = path.rpartition("/")[2]
        return name if sum(each.endswith(f"/{name}") for each in self._paths) == 1 else path

    def _lookup(self, name: str, span: Span) -> str | None:
        """Return the full path of workspace *name*, or None after reporting that it is unknown or ambiguous."""
        full = name if name.startswith("/") else f"{_MAIN}/{name}"
        if full in self._paths:
            return full
        found = [path for path in self._paths if path.endswith(f"/{name}")]
        if len(found) == 1:
            return found[0]
        if found:
            what, help = "ambiguous", f"write {' or '.join(f'`{path}`' for path in found)}"
        else:
            names = {path.rpartition("/")[2] for path in self._paths}
            what = "unknown"
            help = suggestion(name, sorted(names), f"declare it in the project: `workspace {name}`")
        self.error(f"{what} workspace `{name}`", span, help)
        return None

    def _named(self, name: str, span: Span, node: WrittenName | None) -> str | None:
        """Return the full path of a workspace that an agent uses, or None after reporting what is wrong.

        A workspace of a given node need not be declared: agents may create it.
        """
        at = self.nodes.named(node)
        if self._is_of_organisation(name, span):
            return None
        if node is not None and not self._is_declared(name):
            return name if name.startswith("/") else f"{_MAIN}/{name}"
        path = self._lookup(name, span)
        if path is not None and at is not None and not self._is_at(path, at):
            actual = self._node_of(path) or self.nodes.first
            help = f"write `{name}@{actual}`, or `node: {at}` in the workspace"
            self.error(f"workspace `{name}` is not at node `{at}`", span, help)
        return path

    def _join(self, wanted: JoinPart) -> str | None:
        """Return the workspace that an agent joins, or None if it is not in this run."""
        path = self._named(wanted.workspace, wanted.span, wanted.node)
        return None if path is None else self._shortest(path)

    def _focus(self, wanted: FocusPart) -> FocusSpec | None:
        """Return the artifact *wanted* with its workspace. Without a workspace, search all of them."""
        if wanted.workspace is None:
            return self._focus_anywhere(wanted)
        path = self._named(wanted.workspace, wanted.span, wanted.node)
        if path is None:
            return None
        known = self._declared(path) | _DEFAULT_NAMES | ({_FLEET} if path == _MAIN else set())
        if path in self._paths and wanted.artifact not in known:
            self.warn(
                f"artifact `{wanted.artifact}` is not declared in workspace `{wanted.workspace}`",
                wanted.span,
                suggestion(wanted.artifact, sorted(known), "the agent focuses it as soon as it is created"),
            )
        return FocusSpec(wanted.artifact, self._shortest(path), wanted.namespace)

    def _focus_anywhere(self, wanted: FocusPart) -> FocusSpec | None:
        at = self.nodes.named(wanted.node)
        paths = [path for path in self._paths if at is None or self._is_at(path, at)]
        found = [path for path in paths if wanted.artifact in self._declared(path)]
        if not found and wanted.artifact == _FLEET and at is None:
            return FocusSpec(_FLEET, self._shortest(_MAIN), wanted.namespace)
        if not found:
            every = {name for path in paths for name in self._declared(path)}
            created = f"if an agent creates it, name its workspace, too: `workspace.{wanted.artifact}`"
            help = suggestion(wanted.artifact, sorted(every), created)
            where = "" if at is None else f" at node `{at}`"
            self.error(f"unknown artifact `{wanted.artifact}`{where}", wanted.span, help)
            return None
        if len(found) > 1:
            self.warn(
                f"ambiguous artifact `{wanted.artifact}`: it is in {len(found)} workspaces, and the first one is used",
                wanted.span,
                f"write `{self._shortest(found[0])}.{wanted.artifact}`",
            )
        return FocusSpec(wanted.artifact, self._shortest(found[0]), wanted.namespace)

    def _declared(self, path: str) -> set[str]:
        part = self._paths.get(path)
        return set() if part is None else {artifact.spec.name for artifact in part.artifacts}

    def _is_declared(self, name: str) -> bool:
        return any(path.endswith(f"/{name.removeprefix('/')}") for path in self._paths)

    def _is_of_organisation(self, name: str, span: Span) -> bool:
        """Return whether *name* is an organisation, which is also a workspace in JaCaMo. Record it as unsupported."""
        topic = self._part.organisations.get(name)
        if self._is_declared(name) or topic is None:
            return False
        found = Unsupported(topic, f"the workspace of `{name}`", span)
        if found not in self._part.unsupported:
            self._part.unsupported.append(found)
        return True

    # agents

    def instances(self, agent: AgentPart) -> list[AgentSpec]:
        """Return one agent for each instance."""
        for option, value in agent.options.items():
            found = check_option(option, value, agent.option_places.get(option))
            if found is not None:
                self.add(found)
        first = AgentSpec(
            name=agent.name,
            source_path=self._source(agent),
            declared_name=agent.name,
            options=dict(agent.options),
            beliefs=self._literals(agent.beliefs, "belief"),
            goals=self._literals(agent.goals, "goal"),
            agent_class=agent.agent_class,
            node=self.nodes.named(agent.node),
            span=agent.span,
        )
        return [self._situated(replace(first, name=name), agent) for name in agent.instance_names()]

    def _source(self, agent: AgentPart) -> Path:
        written = agent.source or agent.name
        try:
            return SourcePath(agent.folders).find(written)
        except FileNotFoundError as missing:
            file = written if written.endswith((".asl", ".py")) else f"{written}.asl"
            message = f"program of agent `{agent.name}` not found: {file}"
            self.error(message, agent.source_span or agent.span, str(missing))
            return (agent.folders or (Path(),))[0] / file

    def _literals(self, written: list[WrittenName], what: str) -> str:
        """Return the literals, joined. Report what is not a literal."""
        for text, span in written:
            try:
                parse_literals(_literal(text))
            except AslError as error:
                first, _, rest = text.partition("\n")
                shown = f"{first.rstrip()} ..." if rest else first
                help = "write rules in the agent's program" if ":-" in text else None
                self.error(f"invalid {what} `{shown}`: {error.diagnostics[0].message}", span, help)
            else:
                if text.startswith("!") and what == "belief":
                    help = f"write `goals: {text[1:]}`"
                    self.error(f"expected a belief, found the goal `{text}`", span, help)
        return ", ".join(_literal(text) for text, _ in written)

    def _situated(self, agent: AgentSpec, part: AgentPart) -> AgentSpec:
        """Return the instance *agent* of *part* with the workspaces it joins and the artifacts it focuses."""
        join = [self._join(wanted) for wanted in part.join]
        focus = [self._focus(wanted) for wanted in part.focus]
        for workspace in self._part.workspaces:
            name = self._shortest_name(workspace)
            if any(_means(written, agent) for written, _ in workspace.agents):
                join.append(name)
            for artifact in workspace.artifacts:
                focus += [
                    FocusSpec(artifact.spec.name, name, namespace)
                    for written, namespace, _ in artifact.focused_by
                    if _means(written, agent)
                ]
        join += [wanted.workspace for wanted in focus if wanted is not None]
        joined = tuple(dict.fromkeys(name for name in join if name is not None))
        return replace(
            agent,
            join=joined,
            join_later=tuple(name for name in joined if name.startswith("/") and name not in self._paths),
            focus=tuple(dict.fromkeys(wanted for wanted in focus if wanted is not None)),
        )


def _literal(text: str) -> str:
    return text.strip().rstrip(".,")


def _means(name: str, agent: AgentSpec) -> bool:
    return name in ("*", agent.name, agent.declared_name)
