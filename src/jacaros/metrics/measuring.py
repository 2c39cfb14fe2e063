"""Count programs and single files."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from jacaros.agents.language.diagnostics import Diagnostic, render_all
from jacaros.errors import JacarosError
from jacaros.files.texts import suggestion
from jacaros.metrics.baseline_files import read_baseline
from jacaros.metrics.counted_file import CountedFile
from jacaros.metrics.groups import Group, ProgramMetrics
from jacaros.metrics.library import DEFAULT, Library
from jacaros.metrics.program_files import ProgramFiles, no_programs
from jacaros.metrics.sources import Sources


class MetricsError(JacarosError):
    """Raised for source files that cannot be counted. ``diagnostics`` holds all errors, ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))


def measure(
    folders: Sequence[Path],
    baselines: Sequence[Iterable[Path]] = (),
    libraries: Sequence[str] = DEFAULT,
) -> list[ProgramMetrics]:
    """Count the programs in folders, each next to its baseline.

    Args:
        folders: folders of the programs.
        baselines: files and folders of the baseline of each program; empty for no baselines at all.
        libraries: names of installed Python packages that count as library code if a program imports them.

    Raises:
        ValueError: the number of baselines differs from that of programs, and is not 0.
        MetricsError: there are errors in programs or baselines; folders do not exist or have no programs.
    """
    if baselines and len(baselines) != len(folders):
        raise ValueError(f"expected {len(folders)} baselines, found {len(baselines)}")
    sources = Sources()
    library = Library(sources, libraries)
    measured = []
    for number, folder in enumerate(folders):
        files = _program(folder, sources, library)
        if baselines:
            files |= read_baseline(baselines[number], sources, library)
        measured.append(ProgramMetrics(_name(folder, folders), files))
    sources.report(*map(_not_installed, sorted(library.missing)))
    if sources.problems:
        raise MetricsError(list(sources.problems))
    return measured


def _program(folder: Path, sources: Sources, library: Library) -> dict[Group, tuple[CountedFile, ...]]:
    if not folder.is_dir():
        sources.report(_no_folder(folder))
        return {}
    before = len(sources.problems)
    try:
        program = ProgramFiles(folder, sources, library)
        files = program.read()
    except OSError as error:
        sources.report(Diagnostic("error", f"cannot read `{folder}`: {error.strerror or error}"))
        return {}
    if len(sources.problems) == before and not program.has_agents:
        sources.report(no_programs(folder))
    return files


def _no_folder(path: Path) -> Diagnostic:
    if path.exists():
        return Diagnostic("error", f"not a folder: `{path}`", help=f"name its folder: `{path.parent}`")
    help = suggestion(str(path), map(str, path.parent.glob("*/"))) or None
    return Diagnostic("error", f"folder does not exist: `{path}`", help=help)


def _name(folder: Path, folders: Sequence[Path]) -> str:
    """Return the name of a folder, or its path if another folder has the same name."""
    name = folder.resolve().name
    return str(folder) if [each.resolve().name for each in folders].count(name) > 1 else name


def _not_installed(package: str) -> Diagnostic:
    return Diagnostic(
        "error",
        f"library not installed, so it cannot be counted: `{package}`",
        None,
        f"pip install {package}",
    )
