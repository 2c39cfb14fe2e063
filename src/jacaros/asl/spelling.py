"""How like two words are."""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Final

MOST_ASKED: Final = 25
"""Mistakes of one kind for which a like word is looked for: a comparison of words takes long."""
MOST_KNOWN: Final = 2000
"""Words that one word is compared with."""


def close_matches(word: str, known: Iterable[str], cutoff: float = 0.6) -> list[str]:
    """Return the one of the (first) *known* words that is most like *word*, in a list; an empty one below *cutoff*."""
    from difflib import get_close_matches  # here: only for programs that are wrong

    return get_close_matches(word, list(islice(known, MOST_KNOWN)), 1, cutoff)


class Slips:
    """Words, found by any slip of one of them: so that the time does not grow with the product of two numbers of words."""

    def __init__(self, words: Iterable[str]) -> None:
        self._words: dict[str, list[str]] = {}
        for word in words:
            for part in _shortened(word):
                self._words.setdefault(part, []).append(word)

    def of(self, written: str) -> list[str]:
        """Return the words that *written* may be a slip of (see `is_slip_of`), each once."""
        return list(dict.fromkeys(word for part in _shortened(written) for word in self._words.get(part, ())))


def _shortened(word: str) -> Iterator[str]:
    """A word, and what is left without one of its letters; words that differ by a slip have one of these in common."""
    yield word
    for place in range(min(len(word), _LONGEST)):
        yield word[:place] + word[place + 1 :]


_LONGEST: Final = 60
"""Letters of a word in which a slip is looked for."""


def is_slip_of(written: str, meant: str) -> bool:
    """Whether *written* is *meant* with one letter more, less, wrong or in another order (not *meant* itself)."""
    if written == meant or abs(len(written) - len(meant)) > 1:
        return False
    at = next(
        (i for i, (one, two) in enumerate(zip(written, meant, strict=False)) if one != two),
        min(len(written), len(meant)),
    )
    rest, wanted = written[at:], meant[at:]
    return (
        rest[1:] == wanted[1:]
        or rest[1:] == wanted
        or rest == wanted[1:]
        or (rest[:2] == wanted[:2][::-1] and rest[2:] == wanted[2:])
    )
