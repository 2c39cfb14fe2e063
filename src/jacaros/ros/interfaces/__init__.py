"""Interface definitions that JaCaROS brings along, and those of the user's own folders.

Definitions are the usual text files, ``<root>/<package>/msg/<Type>.msg`` and
``<root>/<package>/srv/<Type>.srv``.  The folder ``jacaros_interfaces`` beside this file is also a complete
ROS 2 interface package, built for installations that lack ``example_interfaces``.
"""

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


def split_service(text: str) -> tuple[str, str]:
    """Split a service definition at its line ``---`` into request and response."""
    lines = text.splitlines()
    try:
        cut = [line.strip() for line in lines].index("---")
    except ValueError:
        raise ValueError("a service definition has a line --- between request and response") from None
    return "\n".join(lines[:cut]) + "\n", "\n".join(lines[cut + 1 :]) + "\n"
