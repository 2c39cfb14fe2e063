"""Find the comments of a text, given its tokens."""

from collections.abc import Iterable, Iterator

Stretch = tuple[int, int]
"""A part of a text: the offset of its first character, and the offset after its last one."""


def line_starts(text: str) -> list[int]:
    """Return the offset of each line; only a line feed ends a line."""
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    return starts


def between(text: str, tokens: Iterable[Stretch]) -> Iterator[Stretch]:
    """Yield the non-blank text between tokens, which can only be comments."""
    at = 0
    for start, stop in (*tokens, (len(text), len(text))):
        gap = text[at : max(at, start)]
        if not gap.isspace() and gap:
            yield at + len(gap) - len(gap.lstrip()), at + len(gap.rstrip())
        at = max(at, stop)
