"""The clock of a run: programs print ``begin`` and ``end`` around their work."""

import gc
import resource
import sys
import time
from statistics import median
from typing import Any

TURNS = 20_000
SAMPLES = 9


def empty(first: object, second: object, third: object) -> None:
    """The cost of an empty call is the unit."""


def seconds_for_a_call() -> float:
    """Of an empty Python function with three arguments, the loop taken off; about 10 ms."""
    samples = []
    for _ in range(SAMPLES):
        began = time.process_time()
        for _ in range(TURNS):
            empty(1, 2, 3)
        called = time.process_time()
        for _ in range(TURNS):
            pass
        samples.append((called - began - (time.process_time() - called)) / TURNS)
    return median(samples)


class Marks:
    """Receives the output of a program, and measures between the marks.

    Attributes:
        seconds: processor time of each piece of work.
        calls: the same in empty calls, measured right before and right after.
        results: what was printed with ``end``.
    """

    def __init__(self) -> None:
        self.seconds: list[float] = []
        self.calls: list[float] = []
        self.results: list[str] = []
        self._megabytes = 0.0
        self._call = 0.0
        self._began: float | None = None

    def take(self, text: str) -> None:
        """Process a line of output."""
        now = time.process_time()
        if text == "begin":
            gc.collect()
            self._call = seconds_for_a_call()
            self._began = time.process_time()
            # For the reader of the marks, who would otherwise wait in vain.
            print(f"begin {self._began:.3f}", file=sys.stderr, flush=True)
        elif text.startswith("end") and self._began is not None:
            spent = now - self._began
            self._megabytes = self._megabytes or resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            call = (self._call + seconds_for_a_call()) / 2
            self.seconds.append(spent)
            self.calls.append(spent / call)
            self.results.append(text.removeprefix("end").strip().removesuffix(".0"))
            self._began = None

    def report(self) -> dict[str, Any]:
        """Return the figures: medians of all repetitions but the first, which compiles the plans."""
        counted = slice(1, None) if len(self.seconds) > 1 else slice(None)
        seconds = median(self.seconds[counted])
        return {
            "seconds": seconds,
            "calls": median(self.calls[counted]),
            "call": seconds / median(self.calls[counted]),
            "first": self.seconds[0],
            "times": len(self.seconds),
            "results": self.results,
            "megabytes": self._megabytes,
        }
