"""What share of a core a laser takes, as JSON: 720 beams, 40 scans a second, a plan that uses five ranges.

Seconds with and without scans take turns; the difference is what the scans cost.
"""

import json
import time
from typing import Any

import numpy as np
from graph import node, run
from yardstick import call

from jacaros.runtime.mas.system import System

BEAMS, HERTZ, SECONDS = 720, 40, 40
SCANS = 20
"""Different scans, published in a cycle."""
WARM_UP = 2

PROGRAM = """
!start.
+!start <- makeArtifact("scan", "ArtBaseScan", [], Scan); focus(Scan).
+laserrange(A, B, C, D, E) : C < 0.7 <- !avoid(A + B, D + E).
+laserrange(A, B, C, D, E) <- -+free(C).
+!avoid(Right, Left) : Right > Left <- -+turn(right).
+!avoid(_, _) <- -+turn(left).
"""


class Scanning:
    """Publishes scans in every other second."""

    def __init__(self) -> None:
        self.spent = [0.0, 0.0]
        self._ticks = 0

    def begin(self, mas: System) -> None:
        """Publish until time is up."""
        publisher = node(mas, "laser").publisher("/scan", "sensor_msgs/msg/LaserScan")
        scans = [self._scan(publisher, number) for number in range(SCANS)]
        since = time.process_time()

        def tick() -> None:
            nonlocal since
            second, place = divmod(self._ticks, HERTZ)
            if place == 0:
                now = time.process_time()
                if second > WARM_UP:
                    self.spent[(second - 1) % 2] += now - since
                since = now
                if second == WARM_UP + 2 * SECONDS:
                    mas.end(0)
                    return
            if second % 2 == 0:
                publisher.publish(scans[self._ticks % SCANS])
            self._ticks += 1
            mas.clock.call_later(1 / HERTZ, tick)

        tick()

    def _scan(self, publisher: Any, number: int) -> Any:
        scan = publisher.message(range_max=10.0)
        scan.ranges = np.linspace(0.5, 0.5 + number / 10, BEAMS, dtype=np.float32)
        return scan


def main() -> None:
    """Measure."""
    yardstick = call()
    measured = Scanning()
    run(PROGRAM, measured.begin)
    seconds = measured.spent[0] - measured.spent[1]
    print(
        json.dumps(
            {
                "beams": BEAMS,
                "hertz": HERTZ,
                "seconds": SECONDS,
                "scan": seconds / SECONDS / HERTZ * 1e6,
                "share": seconds / SECONDS,
                "goal": 0.05,
                "call": yardstick,
            }
        )
    )


if __name__ == "__main__":
    main()
