"""From a message to the command it leads to, in real time, as JSON: the two ways take turns, 200 messages a second."""

import json
import statistics
import time

from echo import ARTIFACTS, PROGRAM, WAYS, connect
from graph import run
from yardstick import call

from jacaros.runtime.mas.system import System

COUNT = 1000
WARM_UP = 200
PERIOD = 0.005


class Latency:
    """Sends the messages and takes the commands."""

    def __init__(self) -> None:
        self.times: dict[str, list[float]] = {way: [] for way in WAYS}
        self._sent: dict[str, tuple[float, float]] = {}
        self._number = 0

    def begin(self, mas: System) -> None:
        """Send one message after the other."""
        send = connect(mas, self.returned)

        def tick() -> None:
            if self._number >= len(WAYS) * (WARM_UP + COUNT):
                mas.end(0)
                return
            self._number += 1
            way = WAYS[self._number % len(WAYS)]
            self._sent[way] = (float(self._number), time.perf_counter())
            send(way, float(self._number))
            mas.clock.call_later(PERIOD, tick)

        tick()

    def returned(self, way: str, number: float) -> None:
        """Take a command; those that answer an earlier message do not count."""
        arrived = time.perf_counter()
        sent, began = self._sent[way]
        if sent == number and number > len(WAYS) * WARM_UP:
            self.times[way].append(arrived - began)


def main() -> None:
    """Measure."""
    yardstick = call()
    measured = Latency()
    run(PROGRAM, measured.begin, ARTIFACTS, fast=False)
    figures: dict[str, object] = {"messages": min(map(len, measured.times.values())), "call": yardstick}
    for way, times in measured.times.items():
        ordered = sorted(times)
        figures[way] = {
            "median": statistics.median(ordered) * 1e6,
            "p95": ordered[int(0.95 * len(ordered))] * 1e6,
        }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
