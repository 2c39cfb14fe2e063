"""A robot that bumps repeatedly, and the time until its agent stops the wheels: a measurement of ``reactivity.py``.

    bumps.py memory steady|burst COUNT PROGRAM   the agent and the robot, in this process
    bumps.py KIND steady|burst COUNT [URL]       the robot alone, on a real graph; URL: of a rosbridge server

The robot publishes a scan 40 times a second, and a bump when it has been stopped for the bump before.  With ``burst`` it
first orders 10,000 readings, and bumps as soon as they wait.  Prints the reaction times as JSON.
"""

import asyncio
import json
import sys
import time
from array import array
from pathlib import Path
from typing import Any

from memory import beats, start
from pings import Pings

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import Clock, WallClock, run
from jacaros.runtime.mas.console import StandardConsole
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

HERE = Path(__file__).resolve().parent
INT32, SCAN, TWIST = "std_msgs/msg/Int32", "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist"

BEAMS, HERTZ = 720, 40
READINGS = 10_000
PERIOD = 0.037
"""Minimum seconds between two bumps; not a multiple of a scan's period, so that bumps fall anywhere between two scans."""

WARM_UP = 10
PATIENCE = 30.0
"""Seconds after which a bump counts as lost."""

SETTLED = 3.0
"""Seconds until all topics of a real graph are connected, once the first one is."""


class Robot:
    """The robot's node: scans, bumps, and the orders for readings.

    Args:
        node: where its topics are.
        clock: calls for scans.
        burst: bump when 10,000 readings wait.
        count: bumps that count.
    """

    def __init__(self, node: Backend, clock: Clock, burst: bool, count: int) -> None:
        self.pings = Pings(time.perf_counter, self._bump, ("agent",), count, WARM_UP, PATIENCE)
        self.heard = False
        self._clock, self._burst, self._idle = clock, burst, True
        self._bumper = node.publisher("/bumper", INT32)
        self._readings = node.publisher("/readings", INT32)
        self._scanner = node.publisher("/scan", SCAN)
        self._scan: Any = self._scanner.message(range_max=10.0)
        self._scan.ranges = array("f", (0.5 + 2 * beam / BEAMS for beam in range(BEAMS)))
        node.subscription("/cmd_vel", TWIST, lambda s: self._stopped(s.message.angular.x))
        node.subscription("/readings/waiting", INT32, lambda _: self.pings.next())
        node.subscription("/readings/handled", INT32, lambda _: self._rest())

    @property
    def done(self) -> bool:
        """Whether every bump has been answered, or is lost."""
        return self.pings.over and not self.pings.under_way

    def scan(self) -> None:
        """Publish scans from now on."""
        self._scanner.publish(self._scan)
        self._clock.call_later(1 / HERTZ, self.scan)

    def knock(self) -> None:
        """Bump without measuring, to check that the agent is running."""
        self._bump("agent", 0)

    def beat(self, moment: float | None = None) -> None:
        """Start the next bump, unless the agent is still busy with the last one.

        Args:
            moment: when the bump began, in seconds of ``time.perf_counter``; now by default.
        """
        if self.pings.over:
            return
        if not self._burst:
            self.pings.next(moment)
        elif self._idle:
            self._idle = False
            self._readings.publish(self._readings.message(data=READINGS))

    def report(self) -> str:
        """Return the reaction times in seconds and the number of lost bumps, as JSON."""
        return json.dumps({"times": self.pings.times["agent"], "lost": self.pings.lost})

    def _bump(self, way: str, number: float) -> None:
        del way
        self._bumper.publish(self._bumper.message(data=int(number)))

    def _stopped(self, number: float) -> None:
        self.heard = True
        self.pings.returned("agent", number)

    def _rest(self) -> None:
        self._idle = True


def in_process(burst: bool, count: int, program: Path) -> str:
    """Measure on the in-process graph; another process triggers the bumps, because the loop is busy."""
    robots = []

    def started(mas: System) -> None:
        graph: Any = mas.ros.backend()
        node = open_backend("memory", mas.clock, "robot", graph=graph.graph)
        start(node)
        robot = Robot(node, mas.clock, burst, count)
        robots.append(robot)
        robot.scan()
        beats(PERIOD, robot.beat, lambda: robot.done, mas)

    launch(program, RunOptions(world=HERE / "no_robots.yaml"), StandardConsole("error"), started)
    return robots[0].report()


def on_graph(kind: str, burst: bool, count: int, url: str | None) -> str:
    """Measure on a real graph."""
    clock = WallClock()
    reports = []

    async def main() -> None:
        node = open_backend(kind, clock, "robot", url=url)
        await node.start()
        robot = Robot(node, clock, burst, count)
        while not robot.heard:
            robot.knock()
            await asyncio.sleep(0.5)
        await asyncio.sleep(SETTLED)
        robot.scan()
        while not robot.done:
            robot.beat()
            await asyncio.sleep(PERIOD)
        reports.append(robot.report())
        await node.close()

    run(main, clock)
    return reports[0]


def main() -> None:
    """Measure, and print."""
    kind, load, count, *rest = sys.argv[1:]
    burst = load == "burst"
    if kind == "memory":
        print(in_process(burst, int(count), Path(rest[0])))
    else:
        print(on_graph(kind, burst, int(count), rest[0] if rest else None))


if __name__ == "__main__":
    main()
