"""The yardstick: what an empty Python call costs at this moment."""

import time

CALLS = 200_000


def empty(first: object, second: object, third: object) -> None:
    """What is called."""


def call() -> float:
    """Microseconds of an empty call with three arguments, the loop taken off; the best of five."""
    best = 1.0
    for _ in range(5):
        began = time.process_time()
        for _ in range(CALLS):
            empty(1, 2, 3)
        called = time.process_time()
        for _ in range(CALLS):
            pass
        best = min(best, (called - began - (time.process_time() - called)) / CALLS)
    return best * 1e6
