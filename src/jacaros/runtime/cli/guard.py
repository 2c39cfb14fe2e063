"""``jacaros guard NAME``."""

import os
import sys
from contextlib import suppress
from typing import Any

import click

from jacaros.robots.ros.middleware import ROS_KINDS
from jacaros.runtime.cli.graph_options import address_options, ros_option
from jacaros.runtime.cli.options import option
from jacaros.runtime.cli.usage import examples
from jacaros.runtime.clock import WallClock, run
from jacaros.runtime.files.texts import visible

LEAST_TIMEOUT = 0.15
"""Seconds: three heartbeats."""


@click.command(
    "guard",
    epilog=examples("jacaros guard robot --ros ros2", "jacaros run robot.asl --ros ros2 --guard"),
)
@click.argument("name")
@ros_option("ROS graph to join.", ROS_KINDS[1:], required=True)
@address_options
@option("--node-name NODE", "Name of the guard's node (default: NAME_guard).")
@option(
    "--timeout S",
    "Seconds without a heartbeat after which the guard stops the robot (default: 0.3 for agents on this computer, "
    "0.5 over the graph). Larger values cause fewer false alarms on a busy machine or network.",
    click.FloatRange(min=LEAST_TIMEOUT),
    envvar="JACAROS_GUARD_TIMEOUT",
)
@option("--once", "Exit when the agents have shut down, or when none connect.")
def command(
    name: str,
    timeout: float | None,
    once: bool,
    **graph: Any,
) -> None:
    """Guard the robot of the agents whose node is named NAME, until you press Ctrl+C.

    `jacaros run --guard` in the same graph sends heartbeats to this guard, from the same computer or from another one.
    When they stop, the guard cancels all goals of the actions that the agents use, and publishes zero velocity to their
    topics until the agents return. Start it on the robot's computer to stop the robot when that loses its network.
    """  # fmt: skip
    from jacaros.robots.ros.guard import Guard
    from jacaros.robots.ros.heartbeat import socket_path
    from jacaros.robots.ros.open import GraphAddress

    address = GraphAddress(**graph)
    address.check()

    async def main() -> None:
        # Beside a guard on the robot's computer: ROS 1 ends a node when another one takes its name.
        backend = address.open(WallClock(), f"{name}_local_guard" if once else f"{name}_guard", _log)
        agents = f"{backend.node_name.rpartition('/')[0]}/{name}"
        path = socket_path(address.ros, address.identity, agents)
        await Guard(backend, agents, path, timeout, once, _log, _leave_output if once else lambda: None).run()

    run(main, WallClock())


def _leave_output() -> None:
    """Close the standard error inherited from dead agents: a reader of their pipe waits until it is closed."""
    if not os.isatty(2):
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 2)
        os.close(null)


def _log(text: str) -> None:
    """Write a line; the reader may have died with the agents."""
    with suppress(OSError):
        os.write(sys.stderr.fileno(), visible(f"[guard {os.getpid()}] {text}\n").encode())
