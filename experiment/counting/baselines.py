"""Programs of agents with their baselines: the files of both."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from counting.counts import CountedFile, Group, ProgramMetrics
from counting.programs import DEFAULT, Files, Library, check_counted, measure
from counting.sources import PythonFile, Sources
from jacaros.runtime.files.texts import is_file


def measure_beside(folders: Sequence[Path], baselines: Sequence[Iterable[Path]]) -> list[ProgramMetrics]:
    """Count the programs in folders, each with its baseline; the total leaves the baseline out.

    Args:
        folders: folders of the programs.
        baselines: Python files of the baseline of each program; each counts with the neighbouring files that it imports.

    Raises:
        ValueError: the number of baselines differs from that of programs.
        MetricsError: there are errors in programs, or in baselines.
    """
    sources = Sources()
    library = Library(sources, DEFAULT)
    programs = measure(folders)
    beside = [_baseline(paths, sources, library) for paths in baselines]
    check_counted(sources, library)
    return [
        replace(program, files={**program.files, **files})
        for program, files in zip(programs, beside, strict=True)
    ]


def _baseline(paths: Iterable[Path], sources: Sources, library: Library) -> Files:
    """Return the files of a baseline by group, after reporting their errors."""
    found: dict[Path, CountedFile] = {}
    modules: set[str] = set()
    wanted = list(paths)
    while wanted:
        path = wanted.pop()
        file = sources.python(path)
        if file is not None and path.resolve() not in found:
            found[path.resolve()] = file.counted
            modules |= file.modules
            wanted += _beside(path, file)
    return {
        Group.BASELINE: tuple(found[path] for path in sorted(found)),
        Group.BASELINE_LIBRARY: library.files(modules),
    }


def _beside(path: Path, file: PythonFile) -> Iterator[Path]:
    """Yield the files that a file imports from its own folder, or by relative names."""
    for name, level in file.imports:
        folder = path.resolve().parents[max(0, level - 1)]
        parts = name.split(".")
        for length in range(1, len(parts) + 1):
            place = folder.joinpath(*parts[:length])
            yield from filter(is_file, (place / "__init__.py", place.with_name(f"{place.name}.py")))
