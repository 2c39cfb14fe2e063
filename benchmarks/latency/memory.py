"""The measurement on the graph inside the process: agent, echo and pings share one loop."""

import time
from pathlib import Path
from typing import Any

from pings import PERIOD, Measurement

from jacaros.mas.console import StandardConsole
from jacaros.mas.launch import launch
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System
from jacaros.ros.backend import Backend
from jacaros.ros.open import open_backend

ODOMETRY, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist"


class InProcess:
    """Joins the run's graph with a node for the bare echo and one for the pings."""

    def __init__(self) -> None:
        self.pings: Measurement | None = None

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

        pings = self.pings = Measurement(time.perf_counter, send)
        pinger.subscription("/cmd_vel", TWIST, lambda s: pings.returned("agent", s.message.linear.x))
        pinger.subscription("/bare/cmd_vel", TWIST, lambda s: pings.returned("bare", s.message.linear.x))

        def tick() -> None:
            if pings.over:
                mas.end(0)
            else:
                pings.next()
                mas.clock.call_later(PERIOD, tick)

        mas.clock.call_later(0.5, tick)

    def _bare(self, node: Backend) -> None:
        publisher = node.publisher("/bare/cmd_vel", TWIST)

        def reply(sample: Any) -> None:
            command = publisher.message()
            command.linear.x = sample.message.pose.pose.position.x
            publisher.publish(command)

        node.subscription("/bare/odom", ODOMETRY, reply)


def start(node: Backend) -> None:
    """Start a node of the graph inside the process, which waits for nothing."""
    try:
        node.start().send(None)
    except StopIteration:
        return


def main() -> None:
    """Run, and print."""
    measurement = InProcess()
    world = Path(__file__).parent / "nobody.yaml"
    options = RunOptions(world=world)
    launch(Path(__file__).parent / "echo.asl", options, StandardConsole("error"), measurement.join)
    assert measurement.pings is not None
    print(measurement.pings.report("memory"))


if __name__ == "__main__":
    main()
