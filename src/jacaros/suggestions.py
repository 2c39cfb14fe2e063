"""Suggestions for unknown names: the one rule for "did you mean", and for how similar two names must be."""

import re
from collections.abc import Iterable
from heapq import nlargest
from itertools import islice
from typing import Final

ALIKE: Final = 0.66
"""Least similarity of two names, from 0 to 1 (`difflib.SequenceMatcher.ratio`): a slip in a name of three letters."""
MOST_KNOWN: Final = 2000
"""Maximum number of names that one name is compared with: comparing is slow."""
_PARTS: Final = re.compile("[./:]+")


def close_matches(name: str, known: Iterable[str], most: int = 1) -> list[str]:
    """Return the known names most similar to *name*, the most similar first; none that is less than `ALIKE`."""
    candidates = islice(dict.fromkeys(known), MOST_KNOWN)
    found = nlargest(most, ((_similarity(name, each), each) for each in candidates))
    return [each for similarity, each in found if similarity >= ALIKE]


def _similarity(name: str, other: str) -> float:
    """Return how similar two names are: as their least similar parts, so that a common package counts for nothing."""
    parts, others = _PARTS.split(name), _PARTS.split(other)
    if len(parts) != len(others):
        return _likeness(name, other)
    return min(
        1.0 if one.isdigit() and two.isdigit() else _likeness(one, two)
        for one, two in zip(parts, others, strict=True)
    )


def _likeness(name: str, other: str) -> float:
    from difflib import SequenceMatcher  # here: only mistakes need it

    matcher = SequenceMatcher(None, other, name)
    if other.startswith(f"{name}_"):
        return max(ALIKE, matcher.ratio())
    for limit in (matcher.real_quick_ratio, matcher.quick_ratio):  # quick upper limits
        if limit() < ALIKE:
            return 0.0
    return matcher.ratio()


def did_you_mean(names: Iterable[str], otherwise: str = "") -> str:
    """Return the question for *names* that may be meant; without any, *otherwise*."""
    listed = " or ".join(f"`{name}`" for name in names)
    return f"did you mean {listed}?" if listed else otherwise


def suggestion(name: str, known: Iterable[str], otherwise: str = "", most: int = 1) -> str:
    """Return the help for an unknown name: the *known* names that may be meant; without any, *otherwise*."""
    return did_you_mean(close_matches(name, known, most), otherwise)


def aside(name: str, known: Iterable[str]) -> str:
    """Return a suggestion of at most three names as the end of a message, ``; did you mean …?``; empty without any."""
    found = suggestion(name, known, most=3)
    return f"; {found}" if found else ""
