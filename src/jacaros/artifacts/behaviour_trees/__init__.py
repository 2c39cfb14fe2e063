"""Artifacts for behaviour trees: behaviours of py_trees that use and observe artifacts, and a runner that ticks them.

Nothing here depends on agents: a tree is another user of an environment, with agents or without. It needs py_trees,
which the extra ``behaviour-trees`` of the package installs.
"""

try:
    import py_trees as _py_trees  # noqa: F401 - told with its help before anything else needs it
except ModuleNotFoundError as missing:
    if missing.name != "py_trees":
        raise
    raise ModuleNotFoundError(
        "behaviour trees need py_trees, which is not installed: pip install 'jacaros[behaviour-trees]'",
        name="py_trees",
    ) from missing

from jacaros.artifacts.behaviour_trees.act import Act, Failure, FromBlackboard, ToBlackboard
from jacaros.artifacts.behaviour_trees.behaviours import ArtifactBehaviour, HasProperty, PropertyCheck
from jacaros.artifacts.behaviour_trees.tree_runner import TreeRunner

__all__ = [
    "Act",
    "ArtifactBehaviour",
    "Failure",
    "FromBlackboard",
    "HasProperty",
    "PropertyCheck",
    "ToBlackboard",
    "TreeRunner",
]
