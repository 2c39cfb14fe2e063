"""How like two words are."""

from collections.abc import Iterable


def close_matches(word: str, known: Iterable[str], cutoff: float = 0.6) -> list[str]:
    """The one of the *known* words that is most like *word*, in a list; an empty one below *cutoff*."""
    from difflib import get_close_matches  # here: only for programs that are wrong

    return get_close_matches(word, list(known), 1, cutoff)


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
