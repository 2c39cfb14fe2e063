"""How like two words are."""


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
