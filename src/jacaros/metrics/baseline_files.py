"""The files of a baseline: a program without agents with the same behaviour."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.files.texts import is_file
from jacaros.metrics import python_source
from jacaros.metrics.counted_file import CountedFile
from jacaros.metrics.groups import Group
from jacaros.metrics.library import Library
from jacaros.metrics.program_files import absolute_imports, is_launch_file, is_test, source_files
from jacaros.metrics.sources import PythonFile, Sources


def read_baseline(
    paths: Iterable[Path], sources: Sources, library: Library
) -> dict[Group, tuple[CountedFile, ...]]:
    """Return the Python files of a baseline by group, after reporting their errors.

    Args:
        paths: folders, whose Python files count except for tests and launch files; and files, which count together with the
            neighbouring files that they import.
        sources: reads the files and collects the reports.
        library: finds library code.
    """
    found: dict[Path, CountedFile] = {}
    modules: set[str] = set()
    wanted = [each for path in paths for each in _files(path, sources)]
    while wanted:
        path = wanted.pop(0)
        file = sources.python(path)
        if path.resolve() in found or file is None or is_test(file) or is_launch_file(file):
            continue
        found[path.resolve()] = file.counted
        modules.update(absolute_imports(file))
        wanted += _beside(path, file)
    used = [] if sources.problems else [each.counted for each in library.files(modules)]
    return {
        Group.BASELINE: tuple(found[path] for path in sorted(found)),
        Group.BASELINE_LIBRARY: tuple(sorted(used, key=lambda each: each.path)),
    }


def _files(path: Path, sources: Sources) -> list[Path]:
    if is_file(path):
        return [path]
    if not path.is_dir():
        sources.report(Diagnostic("error", f"file or folder does not exist: `{path}`"))
        return []
    files = source_files(path, (".py",))
    if not files:
        sources.report(Diagnostic("error", f"no Python files in `{path}`"))
    return files


def _beside(path: Path, file: PythonFile) -> Iterator[Path]:
    """Return the files that a file imports from its own folder, or by relative names."""
    for name, level in python_source.imports_of(file.tree):
        folder = path.resolve().parents[max(0, level - 1)]
        parts = name.split(".")
        for length in range(1, len(parts) + 1):
            place = folder.joinpath(*parts[:length])
            for each in (place / "__init__.py", place.with_name(f"{place.name}.py")):
                if is_file(each):
                    yield each
