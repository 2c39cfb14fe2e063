"""The yardstick: what an empty Python call costs at this moment."""

import time


def empty(first: object, second: object, third: object) -> None:
    """What is called."""


def call(calls: int = 200_000, rounds: int = 5) -> float:
    """Microseconds of an empty call with three arguments, the loop taken off; the best of some rounds."""
    best = 1.0
    for _ in range(rounds):
        began = time.process_time()
        for _ in range(calls):
            empty(1, 2, 3)
        called = time.process_time()
        for _ in range(calls):
            pass
        best = min(best, (called - began - (time.process_time() - called)) / calls)
    return best * 1e6
