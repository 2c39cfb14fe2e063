"""Which files belong to a project or to a lone program: found by reading little of them, before they are checked."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from jacaros.robots.mapping.file import find_mapping
from jacaros.runtime.files.texts import file_text, files_below
from jacaros.runtime.mas.agents.programs import SourcePath, project_folders, source_folders
from jacaros.runtime.mas.checks.files import MAPPINGS, PROJECTS
from jacaros.runtime.mas.deployment import ProjectError
from jacaros.runtime.mas.project.reading import read_project

PROGRAM: Final = ".asl"
_INCLUDE: Final = re.compile(r"""\binclude\(\s*["']([^"'\n]+)["']""")
_MAPPING: Final = re.compile(r"""["']([^"'\n#]+\.ya?ml)(?:#[^"'\n]*)?["']""")


def roots_of(roots: Iterable[Path], file: Path) -> Iterator[Path]:
    """Yield the folders that are searched for the projects of a file: those open in the editor, or its own project's."""
    around = [root for root in roots if file.is_relative_to(root)]
    yield from around or project_folders(file.parent)[-1:]


def candidates(folders: Iterable[Path]) -> list[Path]:
    """Return the projects and programs below these folders."""
    return list(dict.fromkeys(each.resolve() for each in files_in(folders, (*PROJECTS, PROGRAM))))


def files_in(folders: Iterable[Path], suffixes: Sequence[str]) -> Iterator[Path]:
    """Yield the files of these kinds below folders, as far as these can be read."""
    for folder in folders:
        with suppress(OSError):  # a folder that others must not read
            yield from files_below(folder, suffixes)


def members(path: Path) -> set[Path]:
    """Return the files of a project or program, as far as they can be seen without checking it."""
    if path.suffix == PROGRAM:
        return _reached([path], source_folders(path.parent))
    try:
        reading = read_project(path)
    except ProjectError:
        return {path}
    deployment = reading.deployment
    folders = (deployment.base_path, *deployment.source_paths)
    kinds = [artifact.type_name for space in deployment.workspaces for artifact in space.artifacts]
    files = {path, *reading.used, *_mappings(kinds, folders)}
    if deployment.world is not None:
        files.add(Path(deployment.world).resolve())
    return files | _reached([each.source_path for each in deployment.agents], folders)


def _reached(programs: Iterable[Path], folders: Sequence[Path]) -> set[Path]:
    """Return programs with the files that they include or name."""
    search = SourcePath(folders)
    found: set[Path] = set()
    left = [each.resolve() for each in programs if each.suffix == PROGRAM]
    while left:
        file = left.pop()
        if file in found:
            continue
        found.add(file)
        try:
            text = file_text(file)
        except (OSError, UnicodeError):
            continue
        found |= _mappings(_MAPPING.findall(text), folders)
        for name in _INCLUDE.findall(text):
            with suppress(OSError, ValueError):
                left.append(SourcePath((file.parent, *search.folders)).find(name).resolve())
    return found


def _mappings(names: Iterable[str], folders: Sequence[Path]) -> set[Path]:
    files = dict.fromkeys(name.partition("#")[0] for name in names)
    found = (find_mapping(each, folders) for each in files if each.endswith(MAPPINGS))
    return {each.resolve() for each in found if each is not None}
