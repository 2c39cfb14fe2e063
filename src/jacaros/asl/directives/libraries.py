"""Libraries of other systems that programs include.

Their contents are built in here (joining and focusing, answers to messages), have a counterpart in our own library
(questions about workspaces), or are not supported (organisations).

>>> is_library("$jacamo/templates/common-cartago.asl"), is_library("robot.asl")
(True, False)
"""

from pathlib import Path
from typing import Final

from jacaros.asl.source import SourceFile

_ROOTS: Final = frozenset(
    {"$jacamo", "$jacamoJar", "$jason", "$jasonJar", "$moise", "$moiseJar", "$cartago", "$cartagoJar"}
)
_KNOWN: Final = frozenset(
    {
        "common.asl",
        "dynamic-focus.asl",
        "kqmlPlans.asl",
        "tester_agent.asl",
        "test_assert.asl",
        "test_manager.asl",
    }
)


_ORGANISATIONS: Final = frozenset({"common-moise.asl", "org-obedient.asl", "org-rules.asl", "sai-rules.asl"})
_OURS: Final = {"common-cartago.asl": "common_cartago.asl", "wsp-rules.asl": "common_cartago.asl"}


def counterpart(path: str) -> SourceFile | None:
    """Return the file of our own library that replaces a library file, or None."""
    name = _OURS.get(path.rpartition("/")[2]) if is_library(path) else None
    if name is None:
        return None
    file = Path(__file__).parent.parent / "library" / name
    return SourceFile(f"$jacaros/{name}", file.read_text(encoding="utf-8"))


def is_of_organisations(path: str) -> bool:
    """Return whether *path* is a library file for agents in organisations."""
    return is_library(path) and path.rpartition("/")[2] in _ORGANISATIONS


def is_library(path: str) -> bool:
    """Return whether *path* names a file of one of these systems, as in ``$jacamo/templates/common-cartago.asl``."""
    return path.partition("/")[0] in _ROOTS


def is_known_library(path: str) -> bool:
    """Return whether *path* is a library file that programs here do not need."""
    return is_library(path) and path.rpartition("/")[2] in _KNOWN
