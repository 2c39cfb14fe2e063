"""The workspaces and artifacts that a project declares: made in the order of the file, and found by its names."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from jacaros.asl.diagnostics import Diagnostic
from jacaros.env.environment import Environment
from jacaros.env.errors import OperationFailed
from jacaros.env.kernel.kinds import Unsuitable
from jacaros.env.kernel.signature import Parameter
from jacaros.env.ports import Workspace
from jacaros.env.values import Atom
from jacaros.mas.deployment import ArtifactSpec, FocusSpec, ProjectError, WorkspaceSpec
from jacaros.project_modules import ModuleUnreadable, NotImported

if TYPE_CHECKING:
    from jacaros.env.artifact import Artifact
    from jacaros.env.ids import ArtifactId


async def furnish(
    environment: Environment,
    workspaces: Sequence[WorkspaceSpec],
    find_type: "Callable[[str], type[Artifact]]",
) -> None:
    """Make workspaces and their artifacts.

    The artifacts have no creator: no agent prefers them as its own.

    Raises:
        ProjectError: with all types that there are not, before anything is made; or with all that cannot be made.
    """
    artifacts = [artifact for workspace in workspaces for artifact in workspace.artifacts]
    types = types_of(artifacts, find_type)
    wrong: list[Diagnostic] = []
    for spec in workspaces:
        workspace = _workspace(environment, spec)
        for artifact in spec.artifacts:
            fitting = replace(artifact, arguments=fitted(artifact.arguments, types[artifact.type_name]))
            try:
                await workspace.make_artifact(fitting.name, fitting.type_name, fitting.arguments)
            except OperationFailed as failure:
                wrong.append(Diagnostic("error", failure.message, artifact.span))
    if wrong:
        raise ProjectError(wrong)


def types_of(
    artifacts: Sequence[ArtifactSpec], find_type: "Callable[[str], type[Artifact]]"
) -> "dict[str, type[Artifact]]":
    """The classes of artifacts by their names.

    Raises:
        ProjectError: with all that are not found.
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
            told = str(error) or type(error).__name__
            hint = None if "did you mean" in told else _where(artifact.type_name)
            wrong.append(Diagnostic("error", told, artifact.type_span or artifact.span, hint))
    if wrong:
        raise ProjectError(wrong)
    return found


def _where(type_name: str) -> str:
    """What to do about a type that is not there."""
    package, _, name = type_name.rpartition(".")
    file = f"{package.replace('.', '/')}.py or artifacts.py" if package else "artifacts.py"
    return f"write a class {name}(Artifact) in {file} beside the project file"


def fitted(arguments: tuple[object, ...], artifact_type: "type[Artifact]") -> tuple[object, ...]:
    """The arguments of a project file as the ``init`` of a type wants them.

    In JaCaMo a number in quotes is a number.  Here it is a text, unless that is not what the parameter takes.
    """
    init = artifact_type.interface.inits.find("init", len(arguments))
    if init is None or not any(isinstance(argument, str) for argument in arguments):
        return arguments
    signature = init.signature
    places: list[Parameter | None] = [*signature.parameters]
    places += [signature.rest] * (len(arguments) - len(places))
    return tuple(
        _fitting(argument, parameter)
        for argument, parameter in zip(arguments, places[: len(arguments)], strict=True)
    )


def _fitting(argument: object, parameter: Parameter | None) -> object:
    if parameter is None or not isinstance(argument, str) or isinstance(argument, Atom):
        return argument
    if _suits(argument, parameter):
        return argument
    return next((value for value in _readings(argument) if _suits(value, parameter)), argument)


def _readings(text: str) -> list[object]:
    """What else a text may stand for."""
    if text in ("true", "false"):
        return [text == "true"]
    found: list[object] = []
    for kind in (int, float):
        with suppress(ValueError):
            found.append(kind(text))
    return found


def _suits(argument: object, parameter: Parameter) -> bool:
    try:
        parameter.accept(argument)
    except Unsuitable:
        return False
    return True


def _workspace(environment: Environment, spec: WorkspaceSpec) -> Workspace:
    above = environment.workspace(path_of(environment, spec.parent)) if spec.parent else None
    path = f"{above.path if above is not None else '/main'}/{spec.name}"
    if spec.name == "main" and above is None:
        return environment.workspace("/main")
    try:
        return environment.create_workspace(path)
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
