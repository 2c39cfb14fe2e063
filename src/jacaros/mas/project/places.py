"""The workspaces and artifacts of a project, found by name."""

from jacaros.agents.language.diagnostics import Span
from jacaros.artifacts.env.errors import resolve_path
from jacaros.files.texts import suggestion
from jacaros.mas.deployment import FocusSpec, WorkspaceSpec
from jacaros.mas.project.parts import FocusPart, JoinPart, ProjectPart, WorkspacePart
from jacaros.mas.project.remarks import Remarks
from jacaros.mas.project.unsupported import INSTITUTIONS, ORGANISATIONS, Unsupported

_MAIN = "/main"
_DEFAULT_NAMES = frozenset({"workspace", "blackboard", "console", "manrepo", "system"})
"""The standard artifacts of every workspace."""


class ProjectPlaces:
    """Resolves the names of workspaces and artifacts in a project.

    A workspace is named by its name, by its path below ``/main``, or by its full path.

    Args:
        part: the declarations of the project.
        remarks: collects diagnostics.
    """

    def __init__(self, part: ProjectPart, remarks: Remarks) -> None:
        self._part, self._remarks = part, remarks
        self._paths: dict[str, WorkspacePart | None] = {_MAIN: None}
        for workspace in part.workspaces:
            self._add(workspace)

    # what is declared

    def _add(self, workspace: WorkspacePart) -> None:
        """Compute the full path of a workspace, and add it and the workspaces above it."""
        path = self._path(workspace, ())
        if self._paths.get(path) is not None:
            self._remarks.error(f"duplicate workspace `{workspace.name}`", workspace.span)
            return
        above = path
        while (above := above.rpartition("/")[0]) and above not in self._paths:
            self._paths[above] = None
        self._paths[path] = workspace

    def _path(self, workspace: WorkspacePart, below: tuple[str, ...]) -> str:
        parent = _MAIN
        if workspace.parent is not None:
            parent = self._path_of_parent(workspace, (*below, workspace.name))
        name = workspace.name
        if name in ("main", _MAIN):
            return _MAIN
        return name if name.startswith("/") else resolve_path(parent, name)

    def _path_of_parent(self, workspace: WorkspacePart, below: tuple[str, ...]) -> str:
        wanted = workspace.parent or ""
        if wanted in ("main", _MAIN) or wanted.startswith(f"{_MAIN}/"):
            return resolve_path("/", wanted)
        for other in self._part.workspaces:
            if other.name == wanted or other.name.endswith(f"/{wanted}"):
                if other.name in below:
                    self._remarks.error(f"workspace `{workspace.name}` is its own ancestor", workspace.span)
                    return _MAIN
                return self._path(other, below)
        names = {each.name for each in self._part.workspaces}
        self._remarks.error(
            f"unknown workspace `{wanted}`",
            workspace.parent_span,
            suggestion(wanted, sorted(names)) or None,
        )
        return _MAIN

    def specs(self) -> tuple[WorkspaceSpec, ...]:
        """Return the workspaces in the order of the file, but each after its parent."""
        known = {name for agent in self._part.agents for name in (agent.name, *agent.instance_names())}
        for workspace in self._part.workspaces:
            self._check(workspace, known)
        for organisation in self._part.organisations:
            for name, span in organisation.agents:
                self._check_agent(name, span, known, is_error=False)
            for name, span in organisation.workspaces:
                self._lookup(name, span)
        ordered: list[str] = []
        for path in self._paths:
            above: list[str] = []
            while path and path not in ordered:
                above.append(path)
                path = path.rpartition("/")[0]
            ordered += reversed(above)
        return tuple(self._spec(path, self._paths[path]) for path in ordered if self._is_made(path))

    def _is_made(self, path: str) -> bool:
        return path != _MAIN or self._paths[path] is not None

    def _spec(self, path: str, part: WorkspacePart | None) -> WorkspaceSpec:
        above, _, name = path.rpartition("/")
        parent = self._shortest(above) if above not in ("", _MAIN) else None
        if part is None:
            return WorkspaceSpec(name, parent=parent)
        artifacts = tuple(artifact.spec for artifact in part.artifacts if artifact.spec.type_name)
        return WorkspaceSpec(name, artifacts, tuple(agent for agent, _ in part.agents), parent, part.span)

    def _check(self, workspace: WorkspacePart, known: set[str]) -> None:
        for name, span in workspace.agents:
            self._check_agent(name, span, known)
        for artifact in workspace.artifacts:
            for name, _, span in artifact.focused_by:
                self._check_agent(name, span, known)
        self._remarks.repeated([(a.spec.name, a.spec.span) for a in workspace.artifacts], "artifact")
        for artifact in workspace.artifacts:
            if artifact.spec.name in _DEFAULT_NAMES:
                message = f"`{artifact.spec.name}` is a standard artifact of every workspace"
                self._remarks.error(message, artifact.spec.span, "choose another name")

    def _check_agent(self, name: str, span: Span, known: set[str], is_error: bool = True) -> None:
        if name != "*" and name not in known:
            report = self._remarks.error if is_error else self._remarks.warn
            report(f"unknown agent `{name}`", span, suggestion(name, sorted(known)) or None)

    # what names lead to

    def shortest_name(self, workspace: WorkspacePart) -> str:
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
            self._remarks.error(
                f"ambiguous workspace `{name}`", span, f"write {' or '.join(f'`{path}`' for path in found)}"
            )
            return None
        names = {path.rpartition("/")[2] for path in self._paths}
        message = f"unknown workspace `{name}`"
        self._remarks.error(
            message, span, suggestion(name, sorted(names), f"declare it in the project: `workspace {name}`")
        )
        return None

    def join(self, wanted: JoinPart) -> str | None:
        """Return the workspace that an agent joins, or None if it is not in this run."""
        if self._is_of_organisation(wanted.workspace, wanted.span):
            return None
        if wanted.elsewhere and not self._is_here(wanted.workspace):
            return None
        path = self._lookup(wanted.workspace, wanted.span)
        return None if path is None else self._shortest(path)

    def focus(self, wanted: FocusPart) -> FocusSpec | None:
        """Return the artifact *wanted* with its workspace. Without a workspace, search all of them."""
        if wanted.workspace is None:
            return self._focus_anywhere(wanted)
        if self._is_of_organisation(wanted.workspace, wanted.span):
            return None
        if wanted.elsewhere and not self._is_here(wanted.workspace):
            return None
        path = self._lookup(wanted.workspace, wanted.span)
        if path is None:
            return None
        known = self._artifacts(path)
        if wanted.artifact not in known:
            self._remarks.warn(
                f"artifact `{wanted.artifact}` is not declared in workspace `{wanted.workspace}`",
                wanted.span,
                suggestion(wanted.artifact, sorted(known), "the agent focuses it as soon as it is created"),
            )
        return FocusSpec(wanted.artifact, self._shortest(path), wanted.namespace)

    def _focus_anywhere(self, wanted: FocusPart) -> FocusSpec | None:
        found = [path for path in self._paths if wanted.artifact in self._artifacts(path, defaults=False)]
        if not found:
            if not wanted.elsewhere:
                every = {name for path in self._paths for name in self._artifacts(path, defaults=False)}
                message = f"unknown artifact `{wanted.artifact}`"
                help = suggestion(wanted.artifact, sorted(every)) or None
                help = (
                    help or f"if an agent creates it, name its workspace, too: `workspace.{wanted.artifact}`"
                )
                self._remarks.error(message, wanted.span, help)
            return None
        if len(found) > 1:
            self._remarks.warn(
                f"ambiguous artifact `{wanted.artifact}`: it is in {len(found)} workspaces, and the first one is used",
                wanted.span,
                f"write `{self._shortest(found[0])}.{wanted.artifact}`",
            )
        return FocusSpec(wanted.artifact, self._shortest(found[0]), wanted.namespace)

    def _artifacts(self, path: str, defaults: bool = True) -> set[str]:
        part = self._paths[path]
        declared = set() if part is None else {artifact.spec.name for artifact in part.artifacts}
        return declared | _DEFAULT_NAMES if defaults else declared

    def _is_here(self, name: str) -> bool:
        return any(path.endswith(f"/{name.removeprefix('/')}") for path in self._paths)

    def _is_of_organisation(self, name: str, span: Span) -> bool:
        """Return whether *name* is an organisation, which is also a workspace in JaCaMo. Record it as unsupported."""
        if self._is_here(name) or all(name != each.name for each in self._part.organisations):
            return False
        is_institution = any(
            one.topic is INSTITUTIONS and one.what == f"the institution `{name}`"
            for one in self._part.unsupported
        )
        topic = INSTITUTIONS if is_institution else ORGANISATIONS
        found = Unsupported(topic, f"the workspace of `{name}`", span)
        if found not in self._part.unsupported:
            self._part.unsupported.append(found)
        return True
