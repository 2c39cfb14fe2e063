"""Where comments are in a text whose language tells where its tokens are."""

from collections.abc import Iterable, Iterator

Stretch = tuple[int, int]
"""A part of a text: the offset of its first character, and the offset behind its last one."""


def line_starts(text: str) -> list[int]:
    """Return the offset of each line; only a line feed ends a line."""
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    return starts


def between(text: str, tokens: Iterable[Stretch]) -> Iterator[Stretch]:
    """Yield what is between tokens and not blank: there, only comments can be."""
    at = 0
    for start, stop in (*tokens, (len(text), len(text))):
        gap = text[at : max(at, start)]
        if not gap.isspace() and gap:
            yield at + len(gap) - len(gap.lstrip()), at + len(gap.rstrip())
        at = max(at, stop)
