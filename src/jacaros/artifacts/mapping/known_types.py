"""Names of the types that come with the package, for hints."""

import difflib

from jacaros.ros.interfaces import BUILT_IN
from jacaros.ros.typestore import stored_types

PARTS = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
"""What names of messages end with that are parts of services and actions."""


def known_types(kind: str) -> list[str]:
    """Types of a kind, ``msg``, ``srv`` or ``action``."""
    own = [
        f"{path.parent.parent.name}/{kind}/{path.stem}"
        for path in sorted(BUILT_IN.glob(f"*/{kind}/*.{kind}"))
    ]
    whole = [name for name in stored_types() if not name.endswith(PARTS)]
    return [*own, *(name for name in whole if f"/{kind}/" in name)]


def similar_types(type_name: str) -> list[str]:
    """At most two known types whose names are nearly *type_name*."""
    return difflib.get_close_matches(type_name, known_types(type_name.split("/")[1]), 2, 0.8)
