"""rclpy on the virtual clock: the part of ROS 2's client library that the baselines use, over JaCaROS's memory graph.

`virtual_rclpy.installed.installed` lets programs import it under the name ``rclpy``, and message packages with it. Time
passes while a program spins. The world and all messages are in the same process, so a run is as fast as the machine, and
the same for the same seed. Functions and classes do what rclpy documents for those of the same names.
"""

from typing import Any

from virtual_rclpy.graph import current
from virtual_rclpy.parameter import Parameter

__all__ = ["Parameter", "init", "ok", "shutdown", "spin"]


def init() -> None:
    """Do nothing: the run has made the graph."""


def spin(node: Any) -> None:
    """Let time pass and run callbacks until one raises an exception."""
    del node
    current().spin()


def ok() -> bool:
    """Return True: the graph is there for as long as the program."""
    return True


def shutdown() -> None:
    """Stop running callbacks."""
    current().spinning = False
