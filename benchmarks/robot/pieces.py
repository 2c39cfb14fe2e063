"""Pieces of one work, timed one by one, with a look at the yardstick before each: the best of each counts.

What is measured calls `begin` and `end`; it may be an artifact of the project that is run.
"""

import time
from statistics import median

from yardstick import call

CALLS = 2000
_spent: list[float] = []
_calls: list[float] = []
_began: list[float] = []


def begin() -> None:
    """A piece begins."""
    _calls.append(call(CALLS, 1))
    _began.append(time.process_time())


def end(count: int) -> None:
    """It is over, and was *count* units of work."""
    _spent.append((time.process_time() - _began.pop()) / count * 1e6)


def take() -> tuple[float, float, float]:
    """Microseconds of a unit in the best piece, of an empty call at best, and how many of these a unit takes (median).

    The first piece, in which plans are compiled, does not count.
    """
    found = min(_spent[1:]), min(_calls), median(s / c for s, c in zip(_spent[1:], _calls[1:], strict=True))
    _spent.clear()
    _calls.clear()
    return found
