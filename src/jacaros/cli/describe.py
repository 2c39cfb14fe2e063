"""``jacaros describe TYPE|FILE``."""

import dataclasses
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.artifacts.env.manual import Manual, describe
from jacaros.cli.usage import examples, usage_error
from jacaros.errors import UsageError
from jacaros.files.python_modules import UNSEEN, NotImported, ProjectModules
from jacaros.files.texts import is_file
from jacaros.mas.deployment import Deployment
from jacaros.mas.launch import load_deployment

PROJECT_FILES = (".asl", ".mas2j", ".jcm")


@click.command(
    "describe",
    short_help="Describe an artifact type, a mapping file or a project.",
    epilog=examples(
        "jacaros describe ArtCmdVel", "jacaros describe robot.yaml", "jacaros describe house.jcm --json"
    ),
)
@click.argument("what")
@click.option(
    "--project",
    type=click.Path(path_type=Path),
    default=Path(),
    metavar="FOLDER",
    help="Folder with the project's own artifact types (default: the current folder).",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option(
    "--import",
    "imports",
    is_flag=True,
    help="Run the Python files of the project to find all their declarations (default: read them only).",
)
def command(what: str, project: Path, as_json: bool, imports: bool) -> None:
    """Describe WHAT: an artifact type, a Python file or a mapping file with artifact types, or a project file.

    For an artifact type: its options, observable properties, signals and operations. For a project: its agents,
    workspaces and artifacts. Python code of the project is read, not run, unless you give --import.
    """
    unseen = None if imports else set[Path]()
    if what.endswith(PROJECT_FILES):
        described = _Project(load_deployment(what), unseen)
        click.echo(_json(described.data()) if as_json else "\n".join(described.lines()))
        return
    manuals = [describe(kind) for kind in _kinds(what, project, unseen)]
    if as_json:
        click.echo(
            _json([dataclasses.asdict(manual) for manual in manuals] if len(manuals) != 1 else manuals[0])
        )
    else:
        click.echo("\n\n".join(map(_for_people, manuals)))


def _kinds(what: str, project: Path, unseen: set[Path] | None) -> Sequence[type[Artifact]]:
    """Return the artifact types that *what* names."""
    if what.endswith(".py"):
        return _types_in(Path(what), unseen)
    if what.endswith((".yaml", ".yml")):
        return _mapped_types(what, project, unseen)
    return [_find(what, project, unseen)]


def _mapped_types(name: str, folder: Path, unseen: set[Path] | None) -> list[type[Artifact]]:
    """Return the artifact types of a mapping file, in the order of the file."""
    # Imported here: only for mapping files.
    from jacaros.artifacts.mapping.file import find_mapping, load_mapping

    path = find_mapping(name, (folder,))
    if path is None:
        raise usage_error(f"mapping file not found: `{name}`")
    return [_find(f"{path}#{each}", folder, unseen) for each in load_mapping(path).artifacts]


def _for_people(manual: Manual) -> str:
    """Return a manual as text, without the backquotes of docstrings."""
    return str(manual).replace("`", "")


def _json(data: Any) -> str:
    return json.dumps(
        dataclasses.asdict(data) if isinstance(data, Manual) else data, indent=2, ensure_ascii=False
    )


def _find(name: str, folder: Path, unseen: set[Path] | None) -> type[Artifact]:
    # Imported here: it imports all built-in artifacts.
    from jacaros.artifacts.registry import type_finder

    try:
        return type_finder(ProjectModules(folder, unseen=unseen))(name)
    except UnknownArtifactType as unknown:
        raise UsageError(str(unknown)) from unknown


def _types_in(file: Path, unseen: set[Path] | None) -> list[type[Artifact]]:
    """Return the artifact types of a Python file, in the order of the file."""
    if not is_file(file):
        raise usage_error(f"file not found: `{file}`")
    modules = ProjectModules(file.parent, unseen=unseen)
    found = _own_types(modules, file.stem)
    if not found:
        for module in modules.load(file.stem):
            for name in [name for name, value in vars(module).items() if value is UNSEEN] or [file.stem]:
                modules.require_seen(module, name)
        raise usage_error(
            f"no artifact type in `{file}`",
            "an artifact type is a class derived from jacaros.artifacts.Artifact",
        )
    return found


def _own_types(modules: ProjectModules, name: str) -> list[type[Artifact]]:
    return [
        each
        for module in modules.load(name)
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, Artifact) and each.__module__ == module.__name__
    ]


class _Project:
    """A project, and the types of its artifacts."""

    def __init__(self, deployment: Deployment, unseen: set[Path] | None) -> None:
        from jacaros.artifacts.registry import ARTIFACTS, type_finder

        self._deployment = deployment
        modules = ProjectModules(deployment.base_path, *deployment.source_paths, unseen=unseen)
        find = type_finder(modules)
        self._unknown: dict[str, str] = {}
        types: dict[type[Artifact], None] = {}
        for workspace in deployment.workspaces:
            for artifact in workspace.artifacts:
                try:
                    types[find(artifact.type_name)] = None
                except (UnknownArtifactType, NotImported) as unknown:
                    self._unknown[artifact.type_name] = str(unknown)
        types.update(dict.fromkeys(_own_types(modules, ARTIFACTS)))
        self._manuals = [describe(kind) for kind in types]

    def lines(self) -> Iterator[str]:
        """Yield the lines of the description."""
        deployment = self._deployment
        yield deployment.name
        for agent in deployment.agents:
            yield f"  agent {agent.name}: {agent.source_path}"
        for workspace in deployment.workspaces:
            yield f"  workspace {workspace.name}"
            for artifact in workspace.artifacts:
                unknown = self._unknown.get(artifact.type_name)
                yield f"    artifact {artifact.name}: {artifact.type_name}" + (
                    f" ({unknown})" if unknown else ""
                )
        if deployment.world is not None:
            yield f"  world {deployment.world}"
        for manual in self._manuals:
            yield ""
            yield _for_people(manual)

    def data(self) -> dict[str, Any]:
        """Return the description as data for JSON."""
        deployment = self._deployment
        return {
            "name": deployment.name,
            "agents": [{"name": agent.name, "source": str(agent.source_path)} for agent in deployment.agents],
            "workspaces": [
                {
                    "name": workspace.name,
                    "artifacts": [
                        {"name": each.name, "type": each.type_name} for each in workspace.artifacts
                    ],
                }
                for workspace in deployment.workspaces
            ],
            "world": deployment.world,
            "types": [dataclasses.asdict(manual) for manual in self._manuals],
        }
