"""The environment of a run: workspaces and artifacts of the project, created in the order of the file."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from jacaros.agents.body.body import AgentBody
from jacaros.agents.body.values import PerceptWriter, References
from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.agents.mind.state.act import Activity
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import OperationFailed, UnknownArtifactType
from jacaros.artifacts.env.ports import Workspace, ignore_made
from jacaros.artifacts.env.values import Atom
from jacaros.artifacts.kernel.acceptance import Unsuitable
from jacaros.artifacts.kernel.declaration import Parameter
from jacaros.artifacts.presence.presence import Account, Presence
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.python_modules import ModuleUnreadable, NotImported, ProjectModules
from jacaros.runtime.files.texts import close_matches
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.deployment import (
    AgentSpec,
    ArtifactSpec,
    Deployment,
    FocusSpec,
    ProjectError,
    WorkspaceSpec,
    has_own_artifacts,
)

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact
    from jacaros.artifacts.env.errors import ArtifactId

    FindType = Callable[[str], type[Artifact]]


class Resources(Mapping[str, object]):
    """Services of a run for artifacts, each created on first use."""

    def __init__(self, makers: Mapping[str, Callable[[], object]]) -> None:
        self._makers = makers

    def __getitem__(self, name: str) -> object:
        return self._makers[name]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


class OperationAccount(Account):
    """Counts the running operations of Python code. Its waits do not concern the agents.

    Args:
        activity: counts what the agents wait for.
        settled: called whenever an operation has ended.
    """

    def __init__(self, activity: Activity, settled: Callable[[], None]) -> None:
        self._activity, self._settled = activity, settled

    def begin(self) -> None:
        """An operation, or something else with an end, has begun."""
        self._activity.begin()

    def end(self) -> None:
        """It has ended."""
        self._activity.end()
        self._settled()


class RunEnvironment:
    """The environment of a run, and the bodies of its agents in it.

    It is a separate module, so that a program without an environment need not import one.

    Args:
        deployment: declarations of the project.
        modules: its Python files.
        clock: clock of the run.
        resources: services for artifacts.
        console: log of artifacts.
        activity: counts running operations of agents.
        on_internal_error: called with defects of JaCaROS itself.

    Attributes:
        environment: all workspaces and artifacts.
        given_types: artifact classes by name that have precedence over all others.

    Raises:
        ModuleUnreadable: the project's own artifacts have an error.
    """

    def __init__(
        self,
        deployment: Deployment,
        modules: ProjectModules,
        clock: Clock,
        resources: Mapping[str, object],
        console: RunConsole,
        activity: Activity,
        on_internal_error: Callable[[BaseException], None],
    ) -> None:
        self.given_types: dict[str, type[Artifact]] = {}
        # A project's own artifacts are imported at the start, so that errors in them are reported before anything runs;
        # those of JaCaROS are imported when the first artifact is created.
        self._modules = modules
        self._find: FindType | None = None
        if has_own_artifacts(deployment.base_path):
            self._find = self._finder()
        self.environment = Environment(clock, resources, self.find_type, console.log, on_internal_error)
        self._console = console
        self._activity = activity
        references = References()
        self._writer = PerceptWriter(references, self.environment.workspace)
        # A run may create and dispose millions of artifacts.
        self.environment.when_disposed(references.forget)
        self.environment.when_disposed(self._writer.forget)

    def find_type(self, type_name: str) -> "type[Artifact]":
        """Return the artifact class with this name. Raises `UnknownArtifactType`."""
        if type_name in self.given_types:
            return self.given_types[type_name]
        try:
            self._find = self._find or self._finder()
            return self._find(type_name)
        except UnknownArtifactType:
            if close_matches(type_name, self.given_types):
                raise UnknownArtifactType(type_name, self.given_types) from None
            raise

    def _finder(self) -> "FindType":
        from jacaros.robots.registry import type_finder

        return type_finder(self._modules)

    def make_body(self, host: AgentHost) -> AgentBody:
        """Return a body for an agent, in ``/main``."""
        mind = host.mind
        assert mind is not None
        return AgentBody(host.name, mind, self.environment, self._writer, host.print, self._activity)

    def situate(self, presence: Presence, spec: AgentSpec) -> None:
        """Let an agent join and focus what the project declares.

        An artifact that does not exist is focused as soon as it is created, and a workspace of another node is joined as
        soon as it appears. Other errors are logged.
        """
        join = [each for each in spec.join if each not in spec.join_later]
        focus = [each for each in spec.focus if each.workspace not in spec.join_later]
        wishes: tuple[str | FocusSpec, ...] = (*join, *focus)
        for wanted in wishes:
            try:
                if isinstance(wanted, str):
                    presence.join(self.environment.workspace(path_of(self.environment, wanted)))
                else:
                    self._focus(presence, wanted)
            except OperationFailed as failure:
                self._console.log(f"[{spec.name}] error: {failure.message}", "error")
        if spec.join_later:
            self._situate_later(presence, spec)

    def _situate_later(self, presence: Presence, spec: AgentSpec) -> None:
        from jacaros.runtime.mas.late_joins import LateJoin  # here: most projects have one node

        for path in spec.join_later:
            before = spec.join[: spec.join.index(path)]
            listed = [each if each in spec.join_later else path_of(self.environment, each) for each in before]
            LateJoin(presence, path, [each for each in spec.focus if each.workspace == path], listed)

    def _focus(self, presence: Presence, wanted: FocusSpec) -> None:
        known = wanted.workspace
        path = path_of(self.environment, known) if known else artifact_of(self.environment, wanted).workspace
        if not presence.workspaces.has_joined(path):
            presence.join(self.environment.workspace(path))
        here = presence.workspaces.at(path)
        presence.focus_when_available(here, wanted.artifact, ignore_made, wanted.namespace)

    async def set_up(self, deployment: Deployment) -> None:
        """Create the workspaces and artifacts that the project declares.

        The artifacts have no creator, so no agent prefers them as its own.

        Raises:
            ProjectError: all unknown types, before anything is created; or all failures of creation.
        """
        artifacts = [artifact for workspace in deployment.workspaces for artifact in workspace.artifacts]
        types = types_of(artifacts, self.find_type)
        wrong: list[Diagnostic] = []
        for spec in deployment.workspaces:
            workspace = _workspace(self.environment, spec)
            for artifact in spec.artifacts:
                arguments = fitted(artifact.arguments, types[artifact.type_name])
                try:
                    await workspace.make_artifact(artifact.name, artifact.type_name, arguments)
                except OperationFailed as failure:
                    wrong.append(Diagnostic("error", failure.message, artifact.span))
        if wrong:
            raise ProjectError(wrong)


def types_of(artifacts: Sequence[ArtifactSpec], find_type: "FindType") -> "dict[str, type[Artifact]]":
    """Return the classes of artifacts by artifact name.

    Raises:
        ProjectError: all unknown types.
    """
    found: dict[str, type[Artifact]] = {}
    wrong: list[Diagnostic] = []
    for artifact in artifacts:
        try:
            found[artifact.type_name] = find_type(artifact.type_name)
        except ModuleUnreadable:
            raise
        except NotImported:
            continue
        except Exception as error:
            message = str(error) or type(error).__name__
            unknown = error if isinstance(error, UnknownArtifactType) else None
            help = unknown.help if unknown and unknown.is_explained else _where(artifact.type_name)
            wrong.append(Diagnostic("error", message, artifact.type_span or artifact.span, help))
    if wrong:
        raise ProjectError(wrong)
    return found


def _where(type_name: str) -> str:
    package, _, name = type_name.rpartition(".")
    file = f"{package.replace('.', '/')}.py or artifacts.py" if package else "artifacts.py"
    return f"write `class {name}(Artifact)` in {file} beside the project file"


def fitted(arguments: tuple[object, ...], artifact_type: "type[Artifact]") -> tuple[object, ...]:
    """Return the arguments of a project file as the ``init`` of a type expects them.

    In JaCaMo, a number in quotes is a number. Here it is a string, unless the parameter does not accept one.
    """
    init = artifact_type.interface.inits.find("init", len(arguments))
    if init is None or not any(isinstance(argument, str) for argument in arguments):
        return arguments
    signature = init.signature
    places: list[Parameter | None] = [*signature.parameters]
    places += [signature.rest] * (len(arguments) - len(places))
    return tuple(map(_fitting, arguments, places))


def _fitting(argument: object, parameter: Parameter | None) -> object:
    if parameter is None or not isinstance(argument, str) or isinstance(argument, Atom):
        return argument
    return next((value for value in _readings(argument) if _suits(value, parameter)), argument)


def _readings(text: str) -> Iterator[object]:
    """Return the values that a string may stand for."""
    yield text
    if text in ("true", "false"):
        yield text == "true"
    for kind in (int, float):
        with suppress(ValueError):
            yield kind(text)


def _suits(argument: object, parameter: Parameter) -> bool:
    try:
        parameter.accept(argument)
    except Unsuitable:
        return False
    return True


def _workspace(environment: Environment, spec: WorkspaceSpec) -> Workspace:
    if spec.name == "main" and not spec.parent:
        return environment.workspace("/main")
    above = path_of(environment, spec.parent) if spec.parent else "/main"
    try:
        return environment.create_workspace(f"{above}/{spec.name}")
    except OperationFailed as failure:
        raise ProjectError([Diagnostic("error", failure.message, spec.span)]) from failure


def path_of(environment: Environment, name: str) -> str:
    """Return the full path of a workspace of the project.

    Raises:
        UnknownWorkspace: the workspace does not exist.
    """
    for workspace in environment.workspaces():
        if name in (workspace.name, workspace.path):
            return workspace.path
    return environment.workspace(name if name.startswith("/") else f"/main/{name}").path


def artifact_of(environment: Environment, focus: FocusSpec) -> "ArtifactId":
    """Return the artifact that an agent of the project focuses.

    Raises:
        OperationFailed: it does not exist.
    """
    if focus.workspace is not None:
        return environment.workspace(path_of(environment, focus.workspace)).lookup(focus.artifact)
    for workspace in environment.workspaces():
        for artifact in workspace.artifacts():
            if artifact.name == focus.artifact:
                return artifact
    return environment.workspace("/main").lookup(focus.artifact)
