"""Interface definitions that JaCaROS brings along, and those of the user's own folders.

Definitions are the usual text files, ``<root>/<package>/msg/<Type>.msg``, ``<root>/<package>/srv/<Type>.srv`` and
``<root>/<package>/action/<Type>.action``.  The folder ``jacaros_interfaces`` beside this file is also a complete
ROS 2 interface package, built for installations that lack ``example_interfaces``.
"""

import os
import sys
from collections.abc import Sequence
from pathlib import Path

BUILT_IN = Path(__file__).parent


def definition(type_name: str, roots: Sequence[Path] = ()) -> str | None:
    """Give the text that defines a type in full form, the user's *roots* first; None when there is none."""
    package, kind, name = type_name.split("/")
    for root in (*roots, BUILT_IN):
        path = root / package / kind / f"{name}.{kind}"
        if path.is_file():
            return path.read_text(encoding="utf-8")
    return None


def installed() -> tuple[Path, ...]:
    """Folders with the definitions of the ROS packages that are installed here.

    ``share`` of each prefix of ROS 2 (``AMENT_PREFIX_PATH``), of ROS 1 (``CMAKE_PREFIX_PATH``), of Python and of the
    system (Debian's packages); and the workspaces of ROS 1 (``ROS_PACKAGE_PATH``).
    """
    prefixes = [*_listed("AMENT_PREFIX_PATH"), *_listed("CMAKE_PREFIX_PATH"), Path(sys.prefix), Path("/usr")]
    workspaces = (root for entry in _listed("ROS_PACKAGE_PATH") for root in _package_roots(entry))
    roots = (*(prefix / "share" for prefix in prefixes), *workspaces)
    return tuple(root for root in dict.fromkeys(roots) if root.is_dir())


def _listed(variable: str) -> list[Path]:
    return [Path(each) for each in os.environ.get(variable, "").split(os.pathsep) if each]


def _package_roots(entry: Path) -> list[Path]:
    """The folders that hold packages: an entry is a package, or holds packages and repositories of packages."""
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
        raise ValueError("a service definition has a line --- between request and response")
    return parts[0], parts[1]


def split_action(text: str) -> tuple[str, str, str]:
    """Split an action definition at its two lines ``---`` into goal, result and feedback."""
    parts = _split(text)
    if len(parts) != 3:
        raise ValueError("an action definition has two lines ---: after the goal and after the result")
    return parts[0], parts[1], parts[2]


def _split(text: str) -> list[str]:
    parts: list[list[str]] = [[]]
    for line in text.splitlines():
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append(line)
    return ["\n".join(lines) + "\n" for lines in parts]
