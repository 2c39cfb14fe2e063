"""The libraries of other systems that programs include and that need not be included here.

What they give there (joining, focusing, plans for organisations) is built in here or not supported.
"""

from typing import Final

_ROOTS: Final = frozenset(
    {"$jacamo", "$jacamoJar", "$jason", "$jasonJar", "$moise", "$moiseJar", "$cartago", "$cartagoJar"}
)
_KNOWN: Final = frozenset(
    {
        "common-cartago.asl",
        "common-moise.asl",
        "common.asl",
        "org-obedient.asl",
        "org-rules.asl",
        "wsp-rules.asl",
        "sai-rules.asl",
        "dynamic-focus.asl",
        "kqmlPlans.asl",
        "tester_agent.asl",
        "test_assert.asl",
        "test_manager.asl",
    }
)


def is_library(path: str) -> bool:
    """Whether *path* names a file of one of these systems, as in ``$jacamo/templates/common-cartago.asl``."""
    return path.partition("/")[0] in _ROOTS


def is_known_library(path: str) -> bool:
    """Whether *path* is one of the library files of which programs here need nothing."""
    return is_library(path) and path.rpartition("/")[2] in _KNOWN
