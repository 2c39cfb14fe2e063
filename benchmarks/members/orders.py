"""What a process measures, as lines on its standard input, and its answers on its standard output."""

import json
import sys


class Orders:
    """Of one process."""

    def ready(self) -> None:
        """Report that the process can be used."""
        print("ready", flush=True)

    def next(self) -> tuple[str, float] | None:
        """Return what to measure, and how much of it. None: the end."""
        line = sys.stdin.readline()
        if not line:
            return None
        what, amount = line.split()
        return what, float(amount)

    def answer(self, times: list[float]) -> None:
        """Answer with microseconds of each time, or between arrivals."""
        print(json.dumps(times), flush=True)
