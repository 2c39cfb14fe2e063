"""Interface definitions: those that come with JaCaROS, and those of the user's own folders.

Definitions are the usual text files, ``<root>/<package>/msg/<Type>.msg``, ``<root>/<package>/srv/<Type>.srv`` and
``<root>/<package>/action/<Type>.action``. The folder ``jacaros_interfaces`` next to this file is also a complete ROS
2 interface package, built for installations that lack ``example_interfaces``.
"""

import os
import sys
from collections.abc import Sequence
from pathlib import Path

BUILT_IN = Path(__file__).parent


def definition(type_name: str, roots: Sequence[Path] = ()) -> str | None:
    """Return the definition of a type in full form, searching the user's *roots* first; None if none exists."""
    package, kind, name = type_name.split("/")
    for root in (*roots, BUILT_IN):
        path = root / package / kind / f"{name}.{kind}"
        if path.is_file():
            return path.read_text(encoding="utf-8")
    return None


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


def split_service(text: str) -> tuple[str, str]:
    """Split a service definition at its line ``---`` into request and response."""
    parts = _split(text)
    if len(parts) != 2:
        raise ValueError("expected a service definition with a line --- between request and response")
    return parts[0], parts[1]


def split_action(text: str) -> tuple[str, str, str]:
    """Split an action definition at its two lines ``---`` into goal, result and feedback."""
    parts = _split(text)
    if len(parts) != 3:
        raise ValueError(
            "expected an action definition with two lines ---, after the goal and after the result"
        )
    return parts[0], parts[1], parts[2]


def _split(text: str) -> list[str]:
    parts: list[list[str]] = [[]]
    for line in text.splitlines():
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append(line)
    return ["\n".join(lines) + "\n" for lines in parts]
