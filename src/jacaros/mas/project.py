"""Project files: from a `.mas2j`, `.jcm` or `.asl` file to what is to be run."""

from dataclasses import replace
from pathlib import Path
from typing import Final

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.errors import AslError
from jacaros.asl.loader import parse_literals
from jacaros.asl.source import SourceFile, Span
from jacaros.asl.spelling import close_matches
from jacaros.mas.agent_options import check_option
from jacaros.mas.deployment import (
    CARTAGO_ENVIRONMENTS,
    AgentSpec,
    Deployment,
    FocusSpec,
    ProjectError,
    WorkspaceSpec,
)
from jacaros.mas.programs import TEST_LIBRARY, library_file
from jacaros.mas.project_cursor import ProjectCursor
from jacaros.mas.project_parts import AgentPart, FocusPart, ProjectPart, WorkspacePart, Written
from jacaros.mas.source_text import source_text

_USUAL_PATHS: Final = (".", "src/agt", "src/agt/inc", "src/asl", "asl", "agents")


def read_project(path: Path) -> tuple[Deployment, list[Diagnostic]]:
    """What can be made of a `.mas2j` or `.jcm` file, and what is wrong in it, in the order of the text.

    Raises:
        ProjectError: the file cannot be read at all.
    """
    diagnostics: list[Diagnostic] = []
    part = _read(path, diagnostics, [])
    deployment = _Resolver(path, part, diagnostics).deployment()
    diagnostics.sort(key=_place)
    return deployment, diagnostics


def _read(path: Path, diagnostics: list[Diagnostic], using: list[Path]) -> ProjectPart:
    """The declarations of one file and, before its own, of the files it uses."""
    try:
        text = source_text(path)
    except FileNotFoundError:
        raise ProjectError([Diagnostic("error", f"{path} is not found")]) from None
    except (OSError, UnicodeError) as error:
        raise ProjectError([Diagnostic("error", f"{path} cannot be read: {error}")]) from error
    cursor = ProjectCursor(SourceFile(str(path), text), diagnostics)
    part = _read_part(path.suffix, cursor)
    for file, span in part.uses:
        used = path.parent / file
        if used.suffix != ".jcm" or not used.is_file():
            cursor.report(f"the project '{file}' is not found", span)
        elif used.resolve() in using:
            cursor.report(f"the project '{file}' uses itself", span)
        else:
            _import(part, _read(used, diagnostics, [*using, path.resolve()]))
    return part


def _read_part(suffix: str, cursor: ProjectCursor) -> ProjectPart:
    # Imported here: a lone program starts sooner without them.
    if suffix == ".jcm":
        from jacaros.mas.jcm import read_jcm

        return read_jcm(cursor)
    from jacaros.mas.mas2j import read_mas2j

    return read_mas2j(cursor)


def _import(part: ProjectPart, used: ProjectPart) -> None:
    part.agents[:0] = used.agents
    part.workspaces[:0] = used.workspaces
    part.source_paths += used.source_paths
    part.infrastructure = part.infrastructure or used.infrastructure
    part.world = part.world or used.world


class _Resolver:
    """Finds the files and names of a project and spreads agents over their instances."""

    def __init__(self, path: Path, part: ProjectPart, diagnostics: list[Diagnostic]) -> None:
        self.path = path
        self.base = path.parent
        self.part = part
        self.diagnostics = diagnostics
        self.source_paths = self._source_paths()

    def deployment(self) -> Deployment:
        """The whole system."""
        part = self.part
        agents = [instance for agent in part.agents for instance in self._instances(agent)]
        self._check_repeated([(agent.name, agent.span) for agent in agents], "agents")
        self._check_repeated(
            [(workspace.name, workspace.span) for workspace in part.workspaces], "workspaces"
        )
        world = part.world
        if world is not None and (self.base / world).exists():
            world = str(self.base / world)
        return Deployment(
            name=part.name,
            base_path=self.base,
            agents=tuple(agents),
            workspaces=tuple(self._workspace(workspace) for workspace in self._parents_first()),
            environment=part.environment,
            artifact_environment=self.path.suffix == ".jcm" or self._cartago(),
            infrastructure=tuple(part.infrastructure),
            world=world,
            source_paths=self.source_paths,
        )

    def _cartago(self) -> bool:
        return (self.part.environment or "").partition("(")[0] in CARTAGO_ENVIRONMENTS

    def _report(self, message: str, span: Span | None, hint: str | None = None) -> None:
        self.diagnostics.append(Diagnostic("error", message, span, hint))

    def _warn(self, message: str, span: Span | None, hint: str | None = None) -> None:
        """Record a warning; once, also when several instances of an agent lead to it."""
        warning = Diagnostic("warning", message, span, hint)
        if warning not in self.diagnostics:
            self.diagnostics.append(warning)

    def _check_repeated(self, names: list[tuple[str, Span | None]], what: str) -> None:
        seen: set[str] = set()
        for name, span in names:
            if name in seen:
                self._report(f"two {what} have the name '{name}'", span)
            seen.add(name)

    # programs

    def _source_paths(self) -> tuple[Path, ...]:
        """The declared folders, then the usual ones."""
        declared = [self.base / path for path in self.part.source_paths]
        usual = [self.base / path for path in _USUAL_PATHS]
        return tuple(dict.fromkeys([*declared, *(path for path in usual if path.is_dir())]))

    def _source(self, agent: AgentPart) -> Path:
        file = agent.source or agent.name
        if not file.endswith(".asl"):
            file += ".asl"
        for folder in self.source_paths:
            if (folder / file).is_file():
                return folder / file
        if Path(file).name in TEST_LIBRARY:
            return library_file(Path(file).name)
        self._report(
            f"the program of agent '{agent.name}' is not found: {file}",
            agent.span,
            "it is looked for in " + ", ".join(str(folder) for folder in self.source_paths),
        )
        return self.base / file

    # agents

    def _instances(self, agent: AgentPart) -> list[AgentSpec]:
        if isinstance(agent.instances, list):
            names = agent.instances
        elif agent.instances is None or agent.instances == 1:
            names = [agent.name]
        else:
            names = [f"{agent.name}{number}" for number in range(1, agent.instances + 1)]
        for option, value in agent.options.items():
            found = check_option(option, value, agent.option_places.get(option))
            if found is not None:
                self.diagnostics.append(found)
        first = AgentSpec(
            name=agent.name,
            source_path=self._source(agent),
            declared_name=agent.name,
            options=dict(agent.options),
            beliefs=self._literals(agent.beliefs),
            goals=self._literals(agent.goals),
            agent_class=agent.agent_class,
            architecture_classes=tuple(agent.architecture_classes),
            belief_base_class=agent.belief_base_class,
            host=agent.host,
            span=agent.span,
        )
        return [self._situated(replace(first, name=name), agent) for name in names]

    def _literals(self, written: list[Written]) -> str:
        """The pieces joined; each must be literals."""
        for text, span in written:
            try:
                parse_literals(text)
            except AslError as error:
                first = error.diagnostics[0]
                self._report(f"'{text}' is no list of literals: {first.message}", span, first.hint)
        return ", ".join(text.strip().rstrip(".,") for text, _ in written)

    def _situated(self, agent: AgentSpec, part: AgentPart) -> AgentSpec:
        """The instance *agent* of *part* with its workspaces and focused artifacts."""
        join = [name for name, span in part.join if self._known_workspace(name, span)]
        focus = [self._focus(wanted) for wanted in part.focus]
        for workspace in self.part.workspaces:
            if any(self._means(name, agent) for name, _ in workspace.agents):
                join.append(workspace.name)
            for artifact in workspace.artifacts:
                focus += [
                    FocusSpec(artifact.spec.name, workspace.name, namespace)
                    for name, namespace, _ in artifact.focused_by
                    if self._means(name, agent)
                ]
        if not join and not focus:
            return agent
        join += [wanted.workspace for wanted in focus if wanted.workspace is not None]
        return replace(agent, join=tuple(dict.fromkeys(join)), focus=tuple(dict.fromkeys(focus)))

    def _means(self, name: str, agent: AgentSpec) -> bool:
        return name in ("*", agent.name, agent.declared_name)

    # workspaces

    def _parents_first(self) -> list[WorkspacePart]:
        """The workspaces in the order of the file, but each behind its parent."""
        waiting = list(self.part.workspaces)
        ordered: list[WorkspacePart] = []
        while waiting:
            names = {workspace.name for workspace in waiting}
            ready = [workspace for workspace in waiting if workspace.parent not in names]
            if not ready:
                self._report("workspaces are each other's parents", waiting[0].span)
                return ordered + waiting
            ordered += ready
            waiting = [workspace for workspace in waiting if workspace not in ready]
        return ordered

    def _workspace(self, workspace: WorkspacePart) -> WorkspaceSpec:
        known = {name for agent in self.part.agents for name in self._names_of(agent)}
        named = [
            *workspace.agents,
            *((name, span) for a in workspace.artifacts for name, _, span in a.focused_by),
        ]
        for name, span in named:
            if name != "*" and name not in known:
                self._warn(f"there is no agent '{name}' in the project", span, _meant(name, known))
        self._check_repeated([(a.spec.name, a.spec.span) for a in workspace.artifacts], "artifacts")
        if workspace.parent is not None:
            self._known_workspace(workspace.parent, workspace.span)
        return WorkspaceSpec(
            workspace.name,
            tuple(artifact.spec for artifact in workspace.artifacts),
            tuple(name for name, _ in workspace.agents),
            workspace.parent,
            workspace.span,
        )

    def _names_of(self, agent: AgentPart) -> list[str]:
        if isinstance(agent.instances, list):
            return [agent.name, *agent.instances]
        return [agent.name, *(f"{agent.name}{number}" for number in range(1, (agent.instances or 0) + 1))]

    def _known_workspace(self, name: str, span: Span) -> bool:
        names = {workspace.name for workspace in self.part.workspaces}
        if name.startswith("/") or name == "main" or name in names:
            return True
        self._warn(f"the workspace '{name}' is not declared in the project", span, _meant(name, names))
        return False

    def _focus(self, wanted: FocusPart) -> FocusSpec:
        """The artifact *wanted* with its workspace; if none is written it is looked up in all of them."""
        places = {
            (workspace.name, artifact.spec.name)
            for workspace in self.part.workspaces
            for artifact in workspace.artifacts
        }
        candidates = [
            workspace.name
            for workspace in self.part.workspaces
            if wanted.workspace in (None, workspace.name) and (workspace.name, wanted.artifact) in places
        ]
        if not candidates:
            where = f" in workspace '{wanted.workspace}'" if wanted.workspace else ""
            hint = _meant(wanted.artifact, {artifact for _, artifact in places})
            self._warn(f"the artifact '{wanted.artifact}' is not declared{where}", wanted.span, hint)
            return FocusSpec(wanted.artifact, wanted.workspace, wanted.namespace)
        if len(candidates) > 1:
            self._warn(
                f"the artifact '{wanted.artifact}' is in {len(candidates)} workspaces; the first is taken",
                wanted.span,
                f"write {candidates[0]}.{wanted.artifact}",
            )
        return FocusSpec(wanted.artifact, candidates[0], wanted.namespace)


def _place(diagnostic: Diagnostic) -> tuple[str, int, int]:
    span = diagnostic.span
    return ("", 0, 0) if span is None else (span.file.name, span.line, span.column)


def _meant(name: str, known: set[str]) -> str | None:
    close = close_matches(name, sorted(known))
    return f"did you mean '{close[0]}'?" if close else None
