"""``rclpy.executors``: several nodes of one program."""

from typing import Any

from virtual_rclpy.graph import current


class SingleThreadedExecutor:
    """Runs the callbacks of its nodes in turn."""

    def add_node(self, node: Any) -> None:
        """Do nothing: while time passes, callbacks of all nodes run."""

    def spin(self) -> None:
        """Let time pass and run callbacks until one raises an exception."""
        current().spin()


class MultiThreadedExecutor(SingleThreadedExecutor):
    """Runs a callback while another one waits."""

    def __init__(self, num_threads: int | None = None) -> None:
        current().concurrent = True
