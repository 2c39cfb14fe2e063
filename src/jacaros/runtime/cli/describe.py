"""``jacaros describe TYPE|FILE``."""

import dataclasses
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.loader import new_names, read_program
from jacaros.agents.language.offers import Offer
from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.errors import UnknownArtifactType
from jacaros.artifacts.env.manual import Manual, describe
from jacaros.runtime.cli.options import PATH, imports_option, option
from jacaros.runtime.cli.usage import examples, usage_error
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.python_modules import UNSEEN, NotImported, ProjectModules
from jacaros.runtime.files.texts import is_file
from jacaros.runtime.mas.agents.programs import SourcePath, text_of
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.launch import load_deployment

PROJECT_FILES = (".asl", ".mas2j", ".jcm")


@click.command(
    "describe",
    epilog=examples(
        "jacaros describe ArtCmdVel", "jacaros describe robot.yaml", "jacaros describe house.jcm --json"
    ),
)
@click.argument("what")
@option(
    "--project FOLDER",
    "Folder with the project's own artifact types (default: the current folder).",
    PATH,
    default=Path(),
    show_default=False,
)
@option("--json", "Print JSON.", name="as_json")
@imports_option
def command(what: str, project: Path, as_json: bool, imports: bool) -> None:
    """Describe WHAT: an artifact type, a Python file or a mapping file with artifact types, or a project file.

    For an artifact type: its options, observable properties, signals and operations. For a project: its agents with
    what they offer to callers, workspaces and artifacts. Python code of the project is read, not run, unless you give
    --import.
    """
    unseen = None if imports else set[Path]()
    if what.endswith(PROJECT_FILES):
        deployment = load_deployment(what)
        manuals, unknown = _project_types(deployment, unseen)
        offers = _offers(deployment, unseen)
        data: Any = _project_data(deployment, manuals, offers)
        text = "\n".join(_project_lines(deployment, manuals, unknown, offers))
    else:
        manuals = [describe(kind) for kind in _kinds(what, project, unseen)]
        described = [dataclasses.asdict(manual) for manual in manuals]
        data = described[0] if len(described) == 1 else described
        text = "\n\n".join(map(_for_people, manuals))
    click.echo(json.dumps(data, indent=2, ensure_ascii=False) if as_json else text)


def _kinds(what: str, project: Path, unseen: set[Path] | None) -> Sequence[type[Artifact]]:
    """Return the artifact types that *what* names."""
    if what.endswith(".py"):
        return _types_in(Path(what), unseen)
    if what.endswith((".yaml", ".yml")):
        from jacaros.robots.mapping.file import find_mapping, load_mapping  # here: few files are mappings

        path = find_mapping(what, (project,))
        if path is None:
            raise usage_error(f"mapping file not found: `{what}`")
        return [_find(f"{path}#{each}", project, unseen) for each in load_mapping(path).artifacts]
    return [_find(what, project, unseen)]


def _for_people(manual: Manual) -> str:
    """Return a manual as text, without the backquotes of docstrings."""
    return str(manual).replace("`", "")


def _find(name: str, folder: Path, unseen: set[Path] | None) -> type[Artifact]:
    # Imported here: it imports all built-in artifacts.
    from jacaros.robots.registry import type_finder

    try:
        return type_finder(ProjectModules(folder, unseen=unseen))(name)
    except UnknownArtifactType as unknown:
        if unknown.help:
            raise usage_error(str(unknown), unknown.help) from unknown
        raise UsageError(str(unknown)) from unknown


def _types_in(file: Path, unseen: set[Path] | None) -> list[type[Artifact]]:
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


def _project_types(project: Deployment, unseen: set[Path] | None) -> tuple[list[Manual], dict[str, str]]:
    """Return the types of a project's artifacts, and why others are unknown, by name."""
    from jacaros.robots.registry import ARTIFACTS, type_finder

    modules = ProjectModules(project.base_path, *project.source_paths, unseen=unseen)
    find = type_finder(modules)
    unknown: dict[str, str] = {}
    types: dict[type[Artifact], None] = {}
    for workspace in project.workspaces:
        for artifact in workspace.artifacts:
            try:
                types[find(artifact.type_name)] = None
            except (UnknownArtifactType, NotImported) as reason:
                unknown[artifact.type_name] = str(reason)
    types.update(dict.fromkeys(_own_types(modules, ARTIFACTS)))
    return [describe(kind) for kind in types], unknown


Offers = Mapping[Path, Sequence[Offer]]
"""What the programs of a project offer to callers outside, by file."""


def _offers(project: Deployment, unseen: set[Path] | None) -> Offers:
    folders = (project.base_path, *project.source_paths)
    code = PythonCode(ProjectModules(*folders, unseen=unseen))
    names, path = new_names(code.functions, code.actions), SourcePath(folders)
    found: dict[Path, Sequence[Offer]] = {}
    for file in {agent.source_path for agent in project.agents if not agent.is_python}:
        with suppress(AslError):  # a missing file; errors in a program are for `jacaros check`
            program, _ = read_program(
                SourceFile(file.as_posix(), text_of(file)), path.include, names.for_program()
            )
            found[file] = program.offers
    return found


def _offer_lines(offer: Offer) -> Iterator[str]:
    yield f"    offers {offer.what} {offer} to {' or '.join(sorted(offer.roles))}{_limits(offer)}"
    if offer.doc:
        yield f"      {offer.doc}"
    yield from (f"      {each.name}: {each.doc}" for each in offer.parameters if each.doc)


def _limits(offer: Offer) -> str:
    if offer.what != "goal":
        return ""
    further = {"refuse": "refuses more", "wait": "lets more wait", "replace": "replaces the oldest"}
    limits = [] if offer.at_most is None else [f"{offer.at_most} at once, {further[offer.when_busy]}"]
    limits += ["cancelled when its caller leaves"] if offer.when_left == "cancel" else []
    return "".join(f"; {each}" for each in (*limits, *sorted(offer.hints)))


def _project_lines(
    project: Deployment, manuals: list[Manual], unknown: dict[str, str], offers: Offers
) -> Iterator[str]:
    yield project.name
    for agent in project.agents:
        yield f"  agent {agent.name}: {agent.source_path}"
        for offer in offers.get(agent.source_path, ()):
            yield from _offer_lines(offer)
    for workspace in project.workspaces:
        yield f"  workspace {workspace.name}"
        for artifact in workspace.artifacts:
            reason = unknown.get(artifact.type_name)
            yield f"    artifact {artifact.name}: {artifact.type_name}{f' ({reason})' if reason else ''}"
    if project.world is not None:
        yield f"  world {project.world}"
    for manual in manuals:
        yield f"\n{_for_people(manual)}"


def _project_data(project: Deployment, manuals: list[Manual], offers: Offers) -> dict[str, Any]:
    from jacaros.serving.arguments import described  # here: other commands do not need it

    workspaces = [
        {
            "name": workspace.name,
            "artifacts": [{"name": each.name, "type": each.type_name} for each in workspace.artifacts],
        }
        for workspace in project.workspaces
    ]
    return {
        "name": project.name,
        "agents": [
            {
                "name": agent.name,
                "source": str(agent.source_path),
                "offers": [described(each) for each in offers.get(agent.source_path, ())],
            }
            for agent in project.agents
        ],
        "workspaces": workspaces,
        "world": project.world,
        "types": [dataclasses.asdict(manual) for manual in manuals],
    }
