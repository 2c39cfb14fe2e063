"""How many messages a second are answered, as JSON: five are on their way at a time, by one way and then the other."""

import json
import time

from echo import ARTIFACTS, PROGRAM, WAYS, connect
from graph import run
from yardstick import call

from jacaros.runtime.mas.system import System

COUNT = 5000
WINDOW = 5
"""Messages on their way: as many as the queue of a sensor's subscription takes."""
ROUNDS = 3


class Rate:
    """Sends a message for each command that comes back."""

    def __init__(self) -> None:
        self.best = dict.fromkeys(WAYS, 0.0)
        self.lost = 0
        self._expected = 0.0
        self._turns = [way for _ in range(ROUNDS) for way in WAYS]

    def begin(self, mas: System) -> None:
        """Begin the first turn."""
        self._mas = mas
        self._send = connect(mas, self.returned)
        self._number = 0.0
        self._next()

    def _next(self) -> None:
        if not self._turns:
            self._mas.end(0)
            return
        self._way = self._turns.pop(0)
        self._last = self._number + COUNT
        self._expected = self._number + 1
        self._began = time.process_time()
        for _ in range(WINDOW):
            self._one()

    def _one(self) -> None:
        if self._number < self._last:
            self._number += 1
            self._send(self._way, self._number)

    def returned(self, way: str, number: float) -> None:
        """Send the next one."""
        del way
        self.lost += int(number - self._expected)
        self._expected = number + 1
        if number == self._last:
            rate = COUNT / (time.process_time() - self._began)
            self.best[self._way] = max(self.best[self._way], rate)
            self._mas.clock.call_later(0.0, self._next)
        else:
            self._one()


def main() -> None:
    """Measure."""
    yardstick = call()
    measured = Rate()
    run(PROGRAM, measured.begin, ARTIFACTS)
    print(json.dumps({**measured.best, "lost": measured.lost, "call": yardstick}))


if __name__ == "__main__":
    main()
