"""The projects of the files that are open in an editor, and what the checker reports about them."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.editors.lsp.membership import PROGRAM, candidates, members, roots_of
from jacaros.editors.symbols.index import Index
from jacaros.runtime.files.texts import file_text, unsaved
from jacaros.runtime.mas.checks.files import MAPPINGS, PROJECTS, Checked, check_files
from jacaros.runtime.mas.checks.observables import Observables

SUFFIXES = (PROGRAM, *PROJECTS, *MAPPINGS)
"""Files that are checked."""


@dataclass
class Unit:
    """What is checked in one pass: a project with its programs, a lone program, or a lone YAML file.

    Attributes:
        path: the file that ``jacaros check`` would be given.
        files: all files that were read.
        found: the diagnostics, by file; those without a place belong to `path`.
        checked: the parsed project; None for YAML files.
        index: the meaning of its names, which may be that of the check before; None until it has been made.
        is_indexed: whether `index` is that of this check.
    """

    path: Path
    files: frozenset[Path]
    found: dict[Path, list[Diagnostic]] = field(default_factory=dict)
    checked: Checked | None = None
    index: Index | None = None
    is_indexed: bool = False

    def name_of(self, file: Path) -> str:
        """Return the name of a file in the places of its programs."""
        sources = self.checked.sources if self.checked is not None else ()
        return next((each for each in sources if Path(each).resolve() == file), file.as_posix())


class Projects:
    """Finds what a file belongs to, and checks it. It may run in any thread, but only in one at a time.

    Args:
        roots: the folders that are open in the editor.
    """

    def __init__(self, roots: Iterable[Path] = ()) -> None:
        self.roots = [each.resolve() for each in roots]
        self._observables = Observables()
        self._units: dict[Path, Unit] = {}
        self._members: dict[Path, set[Path]] = {}
        self._candidates: dict[tuple[Path, ...], list[Path]] = {}

    def update(self, changed: Iterable[Path], texts: Mapping[Path, str]) -> dict[Path, list[Diagnostic]]:
        """Check everything that changed files belong to. Return the diagnostics of all files concerned.

        Args:
            changed: files that were opened, edited, saved or closed.
            texts: the texts of open files.
        """
        with unsaved({str(path): text for path, text in texts.items()}):
            concerned: set[Path] = set()
            checked: set[Path] = set()
            for file in dict.fromkeys(changed):
                for path in self._paths_of(file):
                    if path not in checked:
                        checked.add(path)
                        concerned |= self._check(path)
                if file in texts and not self.units_of(file):  # it is no longer part of what it was part of
                    self._members.pop(file, None)
                    concerned |= self._check(file)
            concerned |= self._forget_unused(texts)
        return {file: self.diagnostics_of(file) for file in concerned}

    def index(self, texts: Mapping[Path, str]) -> bool:
        """Make the index of each project that has been checked since. Until then, the one before serves its programs.

        Return whether one has its first index.
        """
        is_first = False
        with unsaved({str(path): text for path, text in texts.items()}):
            for unit in [*self._units.values()]:
                if unit.checked is not None and not unit.is_indexed:
                    is_first |= unit.index is None
                    unit.index, unit.is_indexed = _index_of(unit, unit.checked), True
        return is_first

    def files_changed(self) -> None:
        """Look for the projects of files again: files have been created, removed or changed outside the editor."""
        self._members.clear()
        self._candidates.clear()

    def units_of(self, file: Path) -> list[Unit]:
        """Return the units that a file belongs to, as of the last check."""
        return [unit for unit in [*self._units.values()] if file in unit.files]

    def diagnostics_of(self, file: Path) -> list[Diagnostic]:
        """Return what all units report about a file, each diagnostic once."""
        return list(dict.fromkeys(each for unit in self.units_of(file) for each in unit.found.get(file, ())))

    def _paths_of(self, file: Path) -> list[Path]:
        """Return the projects, or else the programs, that a file belongs to; otherwise the file."""
        known = [unit.path for unit in self.units_of(file)]
        if known and file in self._members:
            return known
        folders = tuple(roots_of(self.roots, file))
        if folders not in self._candidates:  # walking through large folders is slow
            self._candidates[folders] = candidates(folders)
        others = [each for each in self._candidates[folders] if each != file]
        for suffixes in (PROJECTS, (PROGRAM,)):
            found = [each for each in others if each.suffix in suffixes and file in self._members_of(each)]
            if found:
                used = {each for path in found for each in self._members_of(path) if each != path}
                self._members_of(file)
                return [each for each in found if each not in used]
        self._members_of(file)
        return [file]

    def _members_of(self, path: Path) -> set[Path]:
        found = self._members.get(path)
        if found is None:
            found = self._members[path] = members(path) if path.suffix not in MAPPINGS else {path}
        return found

    def _check(self, path: Path) -> set[Path]:
        """Check one unit. Return the files whose diagnostics may have changed."""
        findings = check_files([path], observables=self._observables, named=False)
        by_file: dict[Path, list[Diagnostic]] = {}
        for each in findings.diagnostics:
            file = path if each.span is None else _file_of(each.span.file, path)
            by_file.setdefault(file, []).append(each)
        files = frozenset(each.resolve() for each in findings.files) | {path}
        before = self._units.get(path)
        index = before.index if before is not None else None
        checked = next(iter(findings.checked), None)
        self._units[path] = Unit(path, files, by_file, checked, index)
        self._members[path] = set(files)
        return {*files, *by_file, *(before.found if before is not None else ())}

    def _forget_unused(self, texts: Mapping[Path, str]) -> set[Path]:
        """Drop the units none of whose files are open."""
        gone = [unit for unit in self._units.values() if unit.files.isdisjoint(texts)]
        for unit in gone:
            del self._units[unit.path]
        return {file for unit in gone for file in unit.found}


def _index_of(unit: Unit, checked: Checked) -> Index:
    """Return the index of a project as it was checked. What the one before knows of artifact types is read once."""
    agents = [each.name for each in checked.deployment.agents]
    index = Index(checked.known_types(), dict(checked.actions), agents, unit.index)
    for name, program in checked.read.items():
        index.put(name, program)
    for path in unit.files:
        if path.suffix in PROJECTS:
            with suppress(OSError, UnicodeError):  # reported by the checker
                index.put_project(SourceFile(path.as_posix(), file_text(path)))
    return index


def _file_of(file: SourceFile, path: Path) -> Path:
    """Return the file of a text; declarations of agents are part of the project file."""
    return path if file.name.startswith("<") else Path(file.name).resolve()
