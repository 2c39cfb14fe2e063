"""Programs of the experiment whose nodes spin in a thread: waits, parameters and libraries that keep a node."""

import logging
import sys
from pathlib import Path

import pytest

from jacaros.testing import RunResult
from scenarios import SCENARIOS
from virtual_run import run_baseline

SPINNING = """
import threading, time
import rclpy
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node

rclpy.init()
node = Node("node")
log = node.get_logger().info

def spin(kind):
    executor = kind()
    executor.add_node(node)
    threading.Thread(target=executor.spin).start()
"""

GOAL = """
client = ActionClient(node, NavigateToPose, "navigate_to_pose")
client.wait_for_server()
goal = NavigateToPose.Goal()
goal.pose.header.frame_id = "map"
goal.pose.pose.position.x, goal.pose.pose.orientation.w = 2.0, 1.0
ended = threading.Event()
handles = []

def accepted(sent):
    handles.append(sent.result())
    sent.result().get_result_async().add_done_callback(end)

def end(result):
    log(f"status {result.result().status}")
    ended.set()

client.send_goal_async(goal).add_done_callback(accepted)
"""


@pytest.fixture
def run(tmp_path: Path):
    def run(text: str, seconds: float = 20.0, **parameters: object) -> RunResult:
        program = tmp_path / "program.py"
        program.write_text(SPINNING + text, encoding="utf-8")
        scenario = SCENARIOS["patrol"]._replace(baseline=program)
        return run_baseline(scenario, seconds=seconds, parameters=parameters)

    return run


def said(result: RunResult) -> list[str]:
    assert result.errors == []
    return [line.removeprefix("[node] ") for line in result.lines]


@pytest.mark.parametrize(
    ("kind", "lines"),
    [
        # Another callback must deliver the answer: it runs beside the one that waits only with several threads.
        ("MultiThreadedExecutor", ["cancelled: 1", "status 5"]),
        ("SingleThreadedExecutor", []),
    ],
)
def test_a_callback_waits_until_its_goal_is_cancelled(run, kind: str, lines: list[str]) -> None:
    cancel = 'log(f"cancelled: {len(handles[0].cancel_goal().goals_canceling)}")'
    text = f"spin({kind})\n{GOAL}\ntimer = node.create_timer(1.0, lambda: (timer.cancel(), {cancel}))\nended.wait()"
    assert sorted(said(run(text))) == lines


def test_a_server_that_does_not_come_is_waited_for_until_the_timeout(run) -> None:
    text = (
        "log(str(ActionClient(node, NavigateToPose, 'none').wait_for_server(1.5)) + f' {time.monotonic()}')"
    )
    assert said(run(text)) == ["False 1.5"]


def test_a_rejected_goal_has_a_result(run) -> None:
    nowhere = GOAL.replace("2.0", "float('nan')")
    assert said(run(f"spin(MultiThreadedExecutor)\n{nowhere}\nended.wait(5)")) == ["status 0"]


def test_a_parameter_has_the_value_of_the_run_and_its_type(run) -> None:
    text = """
node.declare_parameter("pause", 1.0)
value = node.get_parameter("pause").get_parameter_value()
named = rclpy.Parameter.Type(node.get_parameter_type("pause")).name
log(f"{node.has_parameter('pause')} {node.has_parameter('other')} {named} {value.double_value}")
"""
    assert said(run(text, pause=2.5)) == ["True False DOUBLE 2.5"]


def test_a_library_that_keeps_a_node_is_imported_anew_in_the_next_run(
    run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "elsewhere" / "states"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("import logging\nlogging.basicConfig(level=0)\nNODES = []\n")
    (package / "node.py").write_text("from rclpy.node import Node\n")
    monkeypatch.syspath_prepend(str(package.parent))
    level, handlers = logging.getLogger().level, list(logging.getLogger().handlers)
    for _ in range(2):
        text = "import states.node\nstates.NODES.append(node)\nlog(str(len(states.NODES)))"
        assert said(run(text)) == ["1"]
        assert "states" not in sys.modules
    assert (logging.getLogger().level, logging.getLogger().handlers) == (level, handlers)
