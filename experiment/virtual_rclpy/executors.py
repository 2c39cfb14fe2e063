"""``rclpy.executors``: several nodes of one program."""

from virtual_rclpy.graph import current
from virtual_rclpy.node import Node


class SingleThreadedExecutor:
    """Runs the callbacks of its nodes in turn."""

    def add_node(self, node: Node) -> None:
        """Do nothing: while time passes, callbacks of all nodes run."""

    def spin(self) -> None:
        """Let time pass and run callbacks until one raises an exception."""
        current().spin()
