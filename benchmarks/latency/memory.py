"""The measurement on the graph inside the process: agent, echo and pings share one loop.

    memory.py [agent|bare]

With a way: this one alone, an agent beside 100 busy intentions, or a bare echo beside a computing thread.  Then another
process says when a message begins, as on a real graph: the thread of the loop has not got the interpreter yet.
"""

import asyncio
import os
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from computing import compute
from pings import PERIOD, WAYS, Measurement, Pings

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.mas.console import StandardConsole
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

BEATS = """
import os, struct, time
while True:
    time.sleep(%r)
    os.write(1, struct.pack("d", time.perf_counter()))
"""

ODOMETRY, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist"


class InProcess:
    """Joins the run's graph with a node for the bare echo and one for the pings.

    Args:
        way: the only one to measure, beside something busy: an agent, or a computing thread; None for both ways in turn.
    """

    def __init__(self, way: str | None) -> None:
        self.way = way
        self.pings: Measurement | Pings | None = None

    def join(self, mas: System) -> None:
        """Start when the run has started."""
        graph: Any = mas.ros.backend()
        echo, pinger = (
            open_backend("memory", mas.clock, name, graph=graph.graph) for name in ("echo", "pinger")
        )
        for node in (echo, pinger):
            start(node)
        self._bare(echo)
        publishers = {
            "agent": pinger.publisher("/odom", ODOMETRY),
            "bare": pinger.publisher("/bare/odom", ODOMETRY),
        }

        def send(way: str, number: float) -> None:
            message = publishers[way].message()
            message.pose.pose.position.x = number
            publishers[way].publish(message)

        if self.way is None:
            pings: Measurement | Pings = self._in_turn(mas, send)
        else:
            pings = self._alone(mas, send, self.way)
        self.pings = pings
        pinger.subscription("/cmd_vel", TWIST, lambda s: pings.returned("agent", s.message.linear.x))
        pinger.subscription("/bare/cmd_vel", TWIST, lambda s: pings.returned("bare", s.message.linear.x))

    def _in_turn(self, mas: System, send: Callable[[str, float], None]) -> Measurement:
        """Measure both ways; a timer begins the messages."""
        pings = Measurement(time.perf_counter, send)

        def tick() -> None:
            if pings.over:
                mas.end(0)
            else:
                pings.next()
                mas.clock.call_later(PERIOD, tick)

        mas.clock.call_later(0.5, tick)
        return pings

    def _alone(self, mas: System, send: Callable[[str, float], None], way: str) -> Pings:
        """Measure one way beside something busy; another process begins the messages."""
        pings = Pings(time.perf_counter, send, (way,))
        beats(PERIOD, pings.next, lambda: pings.over, mas)
        if way == "bare":
            compute()
        return pings

    def _bare(self, node: Backend) -> None:
        publisher = node.publisher("/bare/cmd_vel", TWIST)

        def reply(sample: Any) -> None:
            command = publisher.message()
            command.linear.x = sample.message.pose.pose.position.x
            publisher.publish(command)

        node.subscription("/bare/odom", ODOMETRY, reply)


def beats(period: float, beat: Callable[[float], None], over: Callable[[], bool], mas: System) -> None:
    """Have another process call *beat* every *period* seconds, with the moment; the run ends when it is *over*."""
    caller = subprocess.Popen([sys.executable, "-c", BEATS % period], stdout=subprocess.PIPE)
    assert caller.stdout is not None
    pipe, loop = caller.stdout.fileno(), asyncio.get_running_loop()

    def read() -> None:
        data = os.read(pipe, 4096)
        if over() or not data:
            loop.remove_reader(pipe)
            caller.kill()
            mas.end(0)
        else:
            beat(*struct.unpack("d", data[-8:]))

    loop.add_reader(pipe, read)


def start(node: Backend) -> None:
    """Start a node of the graph inside the process, which waits for nothing."""
    try:
        node.start().send(None)
    except StopIteration:
        return


def main() -> None:
    """Run, and print."""
    way = sys.argv[1] if len(sys.argv) > 1 else None
    assert way is None or way in WAYS
    measurement = InProcess(way)
    world = Path(__file__).parent / "no_robots.yaml"
    options = RunOptions(world=world)
    program = "busy.asl" if way == "agent" else "echo.asl"
    launch(Path(__file__).parent / program, options, StandardConsole("error"), measurement.join)
    assert measurement.pings is not None
    print(measurement.pings.report("memory"))


if __name__ == "__main__":
    main()
