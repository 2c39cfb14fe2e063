"""What can happen to messages on their way, for tests: `MemoryGraph.disturb` takes one of these.

All are deterministic: the same seed and the same messages give the same faults.
"""

import random
from collections.abc import Callable, Sequence
from typing import Any

Fate = Callable[[Any], Sequence[float]]
"""Takes a message; gives the delays in seconds after which copies of it arrive: none when it is lost."""


def delayed(seconds: float, jitter: float = 0.0, seed: int = 0) -> Fate:
    """Let every message come late.

    Args:
        seconds: by so much.
        jitter: and by up to so much more, at random, so that messages overtake each other.
        seed: of the jitter.
    """
    chance = random.Random(seed)
    return lambda message: (seconds + chance.uniform(0.0, jitter) if jitter else seconds,)


def dropped(share: float = 1.0, seed: int = 0) -> Fate:
    """Lose messages.

    Args:
        share: of the messages, from 0 to 1; 1 loses all.
        seed: of the choice.
    """
    chance = random.Random(seed)
    return lambda message: () if chance.random() < share else (0.0,)


def duplicated(copies: int = 2, apart: float = 0.0) -> Fate:
    """Let every message come several times.

    Args:
        copies: how often.
        apart: seconds between two copies.
    """
    return lambda message: [number * apart for number in range(copies)]


def both(first: Fate, second: Fate) -> Fate:
    """Let two things happen to each message: each copy that *first* lets through suffers *second*."""
    return lambda message: [late + later for late in first(message) for later in second(message)]
