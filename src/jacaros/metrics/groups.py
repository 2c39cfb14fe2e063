"""The groups of files in which a program is counted."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from jacaros.metrics.counted_file import CountedFile, Counts, counts_of


class Group(StrEnum):
    """The role of source files."""

    AGENTS = "agents"
    """Agent programs (.asl), and Python files with agents."""

    ARTIFACTS = "artifacts"
    """All other Python code of a program, and its mapping files."""

    PROJECTS = "projects"
    """Project files (.jcm, .mas2j) and launch files."""

    WORLDS = "worlds"
    """World files and fault files."""

    LIBRARY = "library"
    """Parts of the artifacts and plans of jacaros, and of other libraries, that the program uses."""

    BASELINE = "baseline"
    """Python files of a program without agents and with the same behaviour."""

    BASELINE_LIBRARY = "baseline_library"
    """Library code that the baseline uses."""


@dataclass(frozen=True)
class ProgramMetrics:
    """A program with its files.

    Attributes:
        name: name of its folder.
        files: files by group, sorted by path; groups without files may be missing.
    """

    name: str
    files: Mapping[Group, tuple[CountedFile, ...]]

    def counts(self, group: Group) -> Counts:
        """Return the counts of one group."""
        return counts_of(self.files.get(group, ()))

    @property
    def total(self) -> Counts:
        """Counts of the code that the program author wrote: agents and artifacts, as in the thesis; no configuration."""
        return self.counts(Group.AGENTS) + self.counts(Group.ARTIFACTS)
