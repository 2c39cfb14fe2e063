"""A thread that computes without end: what a bare echo has to live with where an agent is busy."""

import threading


def compute() -> None:
    """Begin."""
    threading.Thread(target=_compute, name="computing", daemon=True).start()


def _compute() -> None:
    state = {}
    number = 0
    while True:
        number = (number * 7 + 1) % 1000
        state[number] = (number, str(number))
