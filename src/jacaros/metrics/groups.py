"""The groups of files in which a program is counted."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from jacaros.metrics.counted_file import CountedFile, Counts, counts_of


class Group(StrEnum):
    """What source files are for."""

    AGENTS = "agents"
    """Agent programs (.asl), and Python files with agents."""

    ARTIFACTS = "artifacts"
    """All other Python code of a program, and its mapping files."""

    PROJECTS = "projects"
    """Project files (.jcm, .mas2j) and launch files."""

    WORLDS = "worlds"
    """World files and fault files."""

    LIBRARY = "library"
    """What the program uses of the artifacts and plans that come with jacaros, and of other libraries."""

    BASELINE = "baseline"
    """Python files of a program without agents that does the same."""

    BASELINE_LIBRARY = "baseline_library"
    """What the baseline uses of libraries."""


@dataclass(frozen=True)
class ProgramMetrics:
    """A program with its files.

    Attributes:
        name: of its folder.
        files: by group, each group sorted by paths; groups without files may be missing.
    """

    name: str
    files: Mapping[Group, tuple[CountedFile, ...]]

    def counts(self, group: Group) -> Counts:
        """The counts of one group."""
        return counts_of(self.files.get(group, ()))

    @property
    def total(self) -> Counts:
        """What the author of the program wrote in code: agents and artifacts, as in the thesis; no configuration."""
        return self.counts(Group.AGENTS) + self.counts(Group.ARTIFACTS)
