"""``jacaros describe TYPE|FILE``."""

import inspect
from collections.abc import Iterator
from pathlib import Path

import click

from jacaros.env.artifact import Artifact
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.interface import OperationTable
from jacaros.errors import UsageError
from jacaros.mas.deployment import Deployment
from jacaros.mas.loading import load_deployment


@click.command("describe", short_help="Tell what an artifact type or a project offers.")
@click.argument("what")
@click.option(
    "--project",
    type=click.Path(path_type=Path),
    default=Path(),
    metavar="FOLDER",
    help="Folder of the project whose own artifacts count (default: this one).",
)
def command(what: str, project: Path) -> None:
    """Tell what WHAT offers: an artifact type (operations), or a project file (agents, artifacts)."""  # fmt: skip
    if what.endswith((".asl", ".mas2j", ".jcm")):
        lines = _project(load_deployment(what))
    else:
        lines = _artifact_type(_find(what, project))
    for line in lines:
        click.echo(line)


def _find(name: str, folder: Path) -> type[Artifact]:
    # Imported here: all built-in artifacts come with it.
    from jacaros.artifacts.registry import type_finder
    from jacaros.env.errors import UnknownArtifactType

    try:
        return type_finder(folder)(name)
    except UnknownArtifactType as unknown:
        raise UsageError(str(unknown)) from unknown


def _artifact_type(artifact_type: type[Artifact]) -> Iterator[str]:
    yield artifact_type.__name__
    yield from _indented(inspect.getdoc(artifact_type) or "")
    for title, table in (
        ("operations", artifact_type.interface.operations),
        ("linked operations", artifact_type.interface.links),
    ):
        if list(table):
            yield f"{title}:"
            yield from _operations(table)
    if artifact_type.ports:
        yield f"out ports: {', '.join(artifact_type.ports)}"


def _operations(table: OperationTable) -> Iterator[str]:
    for declared in sorted(table, key=lambda each: each.name):
        yield f"  {declared.name}({_parameters(declared)})"
        summary = (inspect.getdoc(declared.function) or "").partition("\n")[0]
        if summary:
            yield f"      {summary}"


def _parameters(declared: DeclaredOperation) -> str:
    return str(declared.signature)


def _indented(text: str) -> Iterator[str]:
    for line in text.splitlines():
        yield f"  {line}".rstrip()


def _project(deployment: Deployment) -> Iterator[str]:
    yield deployment.name
    for agent in deployment.agents:
        written = " (in Python)" if agent.is_python else ""
        yield f"  agent {agent.name}: {agent.source_path}{written}"
    for workspace in deployment.workspaces:
        yield f"  workspace {workspace.name}"
        for artifact in workspace.artifacts:
            yield f"    artifact {artifact.name}: {artifact.type_name}"
    if deployment.world is not None:
        yield f"  world {deployment.world}"
