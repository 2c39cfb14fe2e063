"""A thread that computes without end: the load next to a bare echo that corresponds to a busy agent."""

import os
import sys
import threading

INTERVAL = "BENCHMARK_SWITCH_INTERVAL"
"""The environment variable with the switch interval of the echo's process in seconds; without it, Python's own 5 ms."""


def compute() -> None:
    """Begin."""
    sys.setswitchinterval(float(os.environ.get(INTERVAL, "0.005")))
    threading.Thread(target=_compute, name="computing", daemon=True).start()


def _compute() -> None:
    state = {}
    number = 0
    while True:
        number = (number * 7 + 1) % 1000
        state[number] = (number, str(number))
