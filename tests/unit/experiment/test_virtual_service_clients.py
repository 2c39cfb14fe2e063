"""Clients of services in the virtual rclpy."""

from pathlib import Path

from scenarios import SCENARIOS
from virtual_run import run_baseline

CALL = """
import rclpy
from nav2_msgs.srv import ClearEntireCostmap
from rclpy.node import Node


class Caller(Node):
    def __init__(self):
        super().__init__("caller")
        self.client = self.create_client(ClearEntireCostmap, "{service}")
        self.answer = None
        self.create_timer(1.0, self.tick)

    def tick(self):
        if self.answer is not None and self.answer.done():
            self.get_logger().info(f"answered: {{type(self.answer.result()).__name__}}")
            raise SystemExit
        if self.answer is None:
            self.get_logger().info(f"ready: {{self.client.service_is_ready()}}")
            self.answer = self.client.call_async(ClearEntireCostmap.Request())


rclpy.init()
rclpy.spin(Caller())
"""


def lines_of(service: str, folder: Path) -> list[str]:
    program = folder / "caller.py"
    program.write_text(CALL.format(service=service))
    scenario = SCENARIOS["patrol"]._replace(baseline=program)
    return run_baseline(scenario, seconds=5.0).lines


def test_a_service_of_the_world_answers(tmp_path: Path) -> None:
    ready, answered = lines_of("global_costmap/clear_entirely_global_costmap", tmp_path)
    assert ready == "[caller] ready: True"
    assert "ClearEntireCostmap_Response" in answered


def test_a_service_without_a_server_is_not_ready_and_does_not_answer(tmp_path: Path) -> None:
    assert lines_of("no_such_costmap/clear", tmp_path) == ["[caller] ready: False"]
