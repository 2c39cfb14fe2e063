"""Interface definitions: those that come with JaCaROS, and those of the user's own folders.

Definitions are the usual text files, ``<root>/<package>/msg/<Type>.msg``, ``<root>/<package>/srv/<Type>.srv`` and
``<root>/<package>/action/<Type>.action``. The folder ``jacaros_interfaces`` next to this file is also a complete ROS
2 interface package, built for installations that lack ``example_interfaces``.
"""

import os
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

BUILT_IN = Path(__file__).parent
KINDS = {"msg": "message", "srv": "service", "action": "action"}
"""Kinds of types, by the middle part of their names."""
PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""The messages of services and actions, in the order of their definitions."""
SUBSTITUTES = "jacaros_interfaces"
"""A package for ROS 2 that has a substitute for the types of missing packages; ``tools/ros2_package.py`` writes it."""
NOT_SUBSTITUTED = {
    # Every ROS 2 has these; their definitions are here for the backends that have no packages.
    *("action_msgs", "actionlib_msgs", "builtin_interfaces", "diagnostic_msgs", "geometry_msgs"),
    *("lifecycle_msgs", "nav_msgs", "rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "shape_msgs"),
    *("std_msgs", "std_srvs", "stereo_msgs", "trajectory_msgs", "visualization_msgs"),
    # Robots and stacks that stayed with ROS 1: no node in a ROS 2 graph uses these types.
    *("kobuki_msgs", "move_base_msgs", "perception_msgs"),
    # Built under its own name, which all other nodes use on /tf.
    "tf2_msgs",
}


def definition(type_name: str, roots: Sequence[Path] = ()) -> str | None:
    """Return the definition of a type in full form, searching the user's *roots* first; None if none exists."""
    package, kind, name = type_name.split("/")
    for root in (*roots, BUILT_IN):
        path = root / package / kind / f"{name}.{kind}"
        if path.is_file():
            return path.read_text(encoding="utf-8")
    return None


@cache
def origin(kind: str, name: str) -> str | None:
    """Return the package of the type that a type of `SUBSTITUTES` replaces; None if it is our own, or does not exist."""
    packages = {path.parents[1].name for path in BUILT_IN.glob(f"*/{kind}/{name}.{kind}")} - NOT_SUBSTITUTED
    return min(packages - {SUBSTITUTES}, default=None)


def installed() -> tuple[Path, ...]:
    """Return the folders with the definitions of the installed ROS packages.

    These are ``share`` of each prefix of ROS 2 (``AMENT_PREFIX_PATH``), of ROS 1 (``CMAKE_PREFIX_PATH``), of Python
    and of the system (Debian's packages), and the workspaces of ROS 1 (``ROS_PACKAGE_PATH``).
    """
    prefixes = [*_listed("AMENT_PREFIX_PATH"), *_listed("CMAKE_PREFIX_PATH"), Path(sys.prefix), Path("/usr")]
    workspaces = (root for entry in _listed("ROS_PACKAGE_PATH") for root in _package_roots(entry))
    roots = (*(prefix / "share" for prefix in prefixes), *workspaces)
    return tuple(root for root in dict.fromkeys(roots) if root.is_dir())


def _listed(variable: str) -> list[Path]:
    return [Path(each) for each in os.environ.get(variable, "").split(os.pathsep) if each]


def _package_roots(entry: Path) -> list[Path]:
    """Return the folders that contain packages: an entry is a package, or contains packages and repositories of
    packages."""
    if (entry / "package.xml").is_file():
        return [entry.parent]
    try:
        folders = sorted(each for each in entry.iterdir() if each.is_dir())
    except OSError:
        return []
    return [entry, *(each for each in folders if not (each / "package.xml").is_file())]


def split(type_name: str, text: str) -> dict[str, str]:
    """Split the definition of a service or an action at its lines ``---``.

    Returns:
        The definition of each of its message types, by full name.

    Raises:
        ValueError: it has another number of parts.
    """
    names = PARTS[type_name.split("/")[1]]
    parts: list[list[str]] = [[]]
    for line in text.splitlines():
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append(line)
    if len(parts) != len(names):
        lines = "a line ---" if len(names) == 2 else "two lines ---"
        raise ValueError(f"expected {', '.join(names).lower()}, with {lines} between them")
    return {f"{type_name}_{name}": "\n".join(part) + "\n" for name, part in zip(names, parts, strict=True)}


def how_to_define(type_name: str) -> str:
    """Return what to do about a missing definition."""
    return (
        "put its definition into a folder and name that folder in interface_paths (in a mapping file: interfaces): "
        f"{type_name}.{type_name.split('/')[1]}"
    )
