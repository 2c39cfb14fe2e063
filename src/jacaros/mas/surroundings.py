"""The environment of a run: workspaces and artifacts of the project, made in the order of the file."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.asl.diagnostics import Diagnostic
from jacaros.body.body import AgentBody
from jacaros.body.percepts import PerceptWriter
from jacaros.body.values import References
from jacaros.clock import Clock
from jacaros.env.environment import Environment
from jacaros.env.errors import OperationFailed
from jacaros.env.ports import Workspace
from jacaros.mas.activity import Activity
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.console import Console
from jacaros.mas.deployment import (
    AgentSpec,
    ArtifactSpec,
    Deployment,
    FocusSpec,
    ProjectError,
    WorkspaceSpec,
    has_own_artifacts,
)
from jacaros.project_modules import ProjectModules

if TYPE_CHECKING:
    from jacaros.env.artifact import Artifact
    from jacaros.env.ids import ArtifactId


class Resources(Mapping[str, object]):
    """What a run lends to artifacts; each thing is made when it is first asked for."""

    def __init__(self, makers: Mapping[str, Callable[[], object]]) -> None:
        self._makers = makers

    def __getitem__(self, name: str) -> object:
        return self._makers[name]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


class TypeFinder:
    """Finds artifact classes for type names.

    A project's own artifacts are read at the start, so that a mistake in them is told before anything runs;
    those that come with JaCaROS are imported when the first artifact is made.
    """

    def __init__(self, folder: Path, modules: ProjectModules) -> None:
        self._modules = modules
        self._find: Callable[[str], type[Artifact]] | None = None
        if has_own_artifacts(folder):
            self._prepare()

    def __call__(self, type_name: str) -> "type[Artifact]":
        """The class of that name; raises `UnknownArtifactType`."""
        return (self._find or self._prepare())(type_name)

    def _prepare(self) -> "Callable[[str], type[Artifact]]":
        from jacaros.artifacts.registry import type_finder

        self._find = type_finder(self._modules)
        return self._find


class Surroundings:
    """The environment of a run, and the bodies of its agents in it.

    A module of its own, so that a program that does nothing in an environment need not import one.

    Args:
        deployment: what the project declares.
        modules: its Python files.
        clock: of the run.
        resources: what artifacts are lent.
        console: for what artifacts log.
        activity: told of the operations under way for agents.
        on_internal_error: told of defects of JaCaROS itself.

    Attributes:
        environment: all workspaces and artifacts.

    Raises:
        ModuleUnreadable: the project's own artifacts have a mistake.
    """

    def __init__(
        self,
        deployment: Deployment,
        modules: ProjectModules,
        clock: Clock,
        resources: Mapping[str, object],
        console: Console,
        activity: Activity,
        on_internal_error: Callable[[BaseException], None],
    ) -> None:
        find_type = TypeFinder(deployment.base_path, modules)
        self.environment = Environment(clock, resources, find_type, console.log, on_internal_error)
        self._console = console
        self._activity = activity
        self._references = References()
        self._writer = PerceptWriter(self._references, self.environment.workspace)

    def make_body(self, host: AgentHost) -> AgentBody:
        """A body for an agent, in ``/main``."""
        return AgentBody(
            host.name, host.mind, self.environment, self._references, self._writer, host.print, self._activity
        )

    def situated_body(self, host: AgentHost, spec: AgentSpec) -> AgentBody:
        """A body that has joined and focused what the project says; what is not there is told in the log."""
        body = self.make_body(host)
        body.enter()
        try:
            for workspace in spec.join:
                body.join(path_of(self.environment, workspace))
            for focus in spec.focus:
                body.focus(artifact_of(self.environment, focus), focus.namespace)
        except OperationFailed as failure:
            self._console.log(f"[{spec.name}] error: {failure.message}", "error")
        return body

    async def furnish(self, deployment: Deployment) -> None:
        """Make the workspaces and artifacts that the project declares.

        Raises:
            ProjectError: one cannot be made.
        """
        for spec in deployment.workspaces:
            workspace = _workspace(self.environment, spec)
            for artifact in spec.artifacts:
                await _make(workspace, artifact)


def _workspace(environment: Environment, spec: WorkspaceSpec) -> Workspace:
    above = environment.workspace(path_of(environment, spec.parent)) if spec.parent else None
    path = f"{above.path if above is not None else '/main'}/{spec.name}"
    if spec.name == "main" and above is None:
        return environment.workspace("/main")
    try:
        return environment.create_workspace(path)
    except OperationFailed as failure:
        raise ProjectError([Diagnostic("error", failure.message, spec.span)]) from failure


async def _make(workspace: Workspace, spec: ArtifactSpec) -> None:
    try:
        await workspace.make_artifact(spec.name, spec.type_name, spec.arguments)
    except OperationFailed as failure:
        raise ProjectError([Diagnostic("error", failure.message, spec.span)]) from failure


def path_of(environment: Environment, name: str) -> str:
    """The full path of a workspace that the project calls *name*.

    Raises:
        UnknownWorkspace: there is none.
    """
    for workspace in environment.workspaces():
        if name in (workspace.name, workspace.path):
            return workspace.path
    return environment.workspace(name if name.startswith("/") else f"/main/{name}").path


def artifact_of(environment: Environment, focus: FocusSpec) -> "ArtifactId":
    """The artifact that an agent of the project is to focus.

    Raises:
        OperationFailed: there is none.
    """
    if focus.workspace is not None:
        return environment.workspace(path_of(environment, focus.workspace)).lookup(focus.artifact)
    for workspace in environment.workspaces():
        for artifact in workspace.artifacts():
            if artifact.name == focus.artifact:
                return artifact
    return environment.workspace("/main").lookup(focus.artifact)
