"""Read project files: from a `.mas2j` or `.jcm` file to a deployment."""

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.runtime.files.texts import file_text, is_file
from jacaros.runtime.mas.agents.programs import source_folders
from jacaros.runtime.mas.deployment import CARTAGO_ENVIRONMENTS, Deployment, ProjectError
from jacaros.runtime.mas.project.declarations import (
    ArtifactDeclaration,
    FocusPart,
    ProjectPart,
    WorkspacePart,
    condensed,
)
from jacaros.runtime.mas.project.language import ProjectReader
from jacaros.runtime.mas.project.resolving import Resolver

_JCM: Final = ".jcm"
_CODE_PATHS: Final = ("src", "src/env", "src/agt")
"""Folders that are searched for Python modules of a `.jcm` file without a ``java-path``."""


@dataclass(frozen=True)
class ReadProject:
    """The result of reading a project.

    Attributes:
        deployment: the declared system as far as it is valid. Its ``ignored`` holds the warnings that a run prints.
        diagnostics: all errors and warnings, in the order of the text.
        used: the files that it uses.
    """

    deployment: Deployment
    diagnostics: list[Diagnostic]
    used: frozenset[Path]


def read_project(path: Path) -> ReadProject:
    """Read a `.mas2j` or `.jcm` file, with the files that it uses.

    Raises:
        ProjectError: the file cannot be read.
    """
    files = _Files()
    part = files.read(path)
    found = files.diagnostics
    deployment = _deployment(path, part, found)
    told = [*found, *condensed(part.unsupported)]
    every = [*found, *(each.diagnostic() for each in part.unsupported)]
    used = frozenset(files.seen - {path.resolve()})
    return ReadProject(
        replace(deployment, ignored=tuple(sorted(told, key=_place))), sorted(every, key=_place), used
    )


class _Files:
    """Reads a project file and the files that it uses, each once. ``seen`` are all files that were read."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.seen: set[Path] = set()

    def read(self, path: Path, using: tuple[Path, ...] = ()) -> ProjectPart:
        """Return the declarations of one file, preceded by those of the files it uses.

        Raises:
            ProjectError: the file cannot be read.
        """
        self.seen.add(path.resolve())
        reader = reader_of(SourceFile(path.as_posix(), _text(path)), self.diagnostics)
        part = reader.read()
        _complete(path, part)
        self._map(path, part)
        for file, span in reversed(part.uses):
            used = path.parent / (file if file.endswith(_JCM) else file + _JCM)
            if not is_file(used):
                reader.report(f"project not found: `{file}`", span, f"expected at {used}")
            elif used.resolve() in (*using, path.resolve()):
                reader.report(f"project `{file}` uses itself", span)
            elif used.resolve() not in self.seen:
                try:
                    _import(part, self.read(used, (*using, path.resolve())))
                except ProjectError as error:
                    reader.report(error.diagnostics[0].message, span)
        return part

    def _map(self, path: Path, part: ProjectPart) -> None:
        if not part.mappings:
            return
        from jacaros.runtime.mas.mappings import MAIN, read_mapping_file  # here: most projects name none

        for name, span in part.mappings:
            specs, wrong = read_mapping_file(name, (path.parent,), span)
            self.diagnostics += wrong
            part.mapped += map(ArtifactDeclaration, specs)
        if path.suffix != _JCM:
            # A `.mas2j` file cannot declare what agents focus.
            for agent in part.agents:
                agent.focus += [FocusPart(each.spec.name, MAIN, None, agent.span) for each in part.mapped]


def _text(path: Path) -> str:
    try:
        return file_text(path)
    except FileNotFoundError:
        raise ProjectError([Diagnostic("error", f"file not found: {path}")]) from None
    except (OSError, UnicodeError) as error:
        raise ProjectError([Diagnostic("error", f"cannot read {path}: {error}")]) from error


def reader_of(file: SourceFile, diagnostics: list[Diagnostic]) -> ProjectReader:
    """Return a reader for a file, by the ending of its name. It adds errors to *diagnostics*."""
    # Imported on demand: a project uses one of the two formats.
    if file.name.endswith(_JCM):
        from jacaros.runtime.mas.project.jcm import JcmReader

        return JcmReader(file, diagnostics)
    from jacaros.runtime.mas.project.mas2j import Mas2jReader

    return Mas2jReader(file, diagnostics)


def _complete(path: Path, part: ProjectPart) -> None:
    """Resolve the folders and files that the project at *path* names."""
    base = path.parent
    declared = [folder for folder in part.source_paths if not folder.startswith("$")]
    programs = source_folders(base, declared)
    code = [base / folder for folder in part.code_paths or _CODE_PATHS] if path.suffix == _JCM else []
    part.folders = tuple(dict.fromkeys([*programs, *(folder for folder in code if os.path.isdir(folder))]))
    for agent in part.agents:
        agent.folders = programs
    if part.world is not None and is_file(base / part.world):
        part.world = str(base / part.world)


def _import(part: ProjectPart, used: ProjectPart) -> None:
    part.agents[:0] = used.agents
    part.workspaces[:0] = used.workspaces
    part.nodes[:0] = used.nodes
    part.organisations |= used.organisations
    part.unsupported[:0] = used.unsupported
    part.mapped[:0] = used.mapped
    part.folders = tuple(dict.fromkeys([*part.folders, *used.folders]))
    if not part.world:
        part.world, part.world_span = used.world, used.world_span


def _deployment(path: Path, part: ProjectPart, diagnostics: list[Diagnostic]) -> Deployment:
    _add_mapped_artifacts(part)
    resolver = Resolver(part, diagnostics)
    instances = [each for agent in part.agents for each in resolver.instances(agent)]
    resolver.repeated([(agent.name, agent.span) for agent in instances], "agent")
    resolver.repeated([(node.name, node.span) for node in part.nodes], "node")
    workspaces = resolver.specs()
    resolver.nodes.warn_of_unused((*instances, *workspaces))
    diagnostics += dict.fromkeys(resolver.nodes.problems)
    cartago = (part.environment or "").partition("(")[0] in CARTAGO_ENVIRONMENTS
    return Deployment(
        name=part.name,
        base_path=path.parent,
        agents=tuple(instances),
        workspaces=workspaces,
        nodes=tuple(part.nodes),
        environment=part.environment,
        artifact_environment=path.suffix == _JCM or cartago or bool(part.mapped),
        world=part.world,
        world_span=part.world_span,
        source_paths=part.folders,
    )


def _add_mapped_artifacts(part: ProjectPart) -> None:
    if not part.mapped:
        return
    named = (each for each in part.workspaces if each.name in ("main", "/main") and not each.parent)
    main = next(named, None)
    if main is None:
        span = part.mapped[0].spec.span
        assert span is not None
        main = WorkspacePart("main", span)
        part.workspaces.insert(0, main)
    main.artifacts[:0] = part.mapped


def _place(diagnostic: Diagnostic) -> tuple[str, int, int]:
    span = diagnostic.span
    return ("", 0, 0) if span is None else (span.file.name, span.line, span.column)
