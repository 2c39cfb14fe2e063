"""Run one project on JaCaROS and print what it cost, as JSON: seconds of processor time, cycles, peak memory.

on_jacaros.py PROJECT
"""

import gc
import json
import resource
import sys
import time
from typing import Any

from jacaros.mas.launch import GARBAGE_THRESHOLD
from jacaros.testing import run_project

CALLS = 300_000


def empty(first: object, second: object, third: object) -> None:
    """What an empty call costs is the yardstick."""


def seconds_for_a_call() -> float:
    """Of an empty Python function with three arguments, the loop taken off; the best of five."""
    best = 1.0
    for _ in range(5):
        began = time.process_time()
        for _ in range(CALLS):
            empty(1, 2, 3)
        called = time.process_time()
        for _ in range(CALLS):
            pass
        best = min(best, (called - began - (time.process_time() - called)) / CALLS)
    return best


def main(project: str) -> None:
    """Run it as the command does, on the virtual clock."""
    minds: list[Any] = []
    began = 0.0
    before = seconds_for_a_call()

    def started(mas: Any) -> None:
        nonlocal began
        gc.freeze()
        gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)
        minds.extend(host.mind for host in mas.directory)
        began = time.process_time()

    result = run_project(project, when_started=started)
    seconds = time.process_time() - began
    if result.exit_code or result.errors:
        sys.exit("\n".join(result.errors) or f"exit code {result.exit_code}")
    print(
        json.dumps(
            {
                "seconds": seconds,
                "cycles": sum(mind.cycles for mind in minds),
                "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
                "call": (before + seconds_for_a_call()) / 2,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1])
