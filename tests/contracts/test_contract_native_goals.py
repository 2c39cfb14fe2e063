"""Contract: clients written without us give goals to agents: rclpy, rospy, the commands of ROS 2, and py_trees_ros."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.only("ros1", "ros2"), pytest.mark.slow]
HERE = Path(__file__).parent
PATIENCE = 60.0
PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), when_busy(wait)) }
{ offer(goal, guard, when_left(cancel)) }
+!deliver(_, office) <- .refuse(closed(office)).
+!deliver(_, R) <- !drive(R); .progress(0.5, "half"); .wait(300).
+!drive(_) <- .wait(2000).
@g[cleanup(tidy)] +!guard <- .print("guarding"); .wait(100000).
+!tidy <- .print("tidied").
"""


class Agents:
    """A run of ``jacaros run`` that offers goals in the graph."""

    def __init__(self, graph: Any, folder: Path, *options: str) -> None:
        file = folder / f"{folder.name.strip('0123456789')}.asl"
        file.write_text(PROGRAM)
        self.agent = file.stem
        self._process = subprocess.Popen(
            [sys.executable, "-m", "jacaros", "run", str(file), "--ros", graph.kind, "--offer", *options],
            env=os.environ | graph.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.lines: list[str] = []

    def wait_for(self, text: str) -> None:
        """Read the output until a line contains *text*."""
        assert self._process.stdout is not None
        while not any(text in line for line in self.lines):
            line = self._process.stdout.readline()
            assert line, f"the run ended: {self.lines}"
            self.lines.append(line)

    def wait(self) -> int:
        return self._process.wait(PATIENCE)

    def close(self) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
        self._process.wait(PATIENCE)
        assert self._process.stdout is not None
        self._process.stdout.close()


@pytest.fixture
def agents(graph: Any, tmp_path: Path) -> Iterator[Agents]:
    made = Agents(graph, tmp_path)
    yield made
    made.close()


def client(graph: Any, *arguments: str) -> "subprocess.Popen[str]":
    """The native client of the graph."""
    return subprocess.Popen(
        [sys.executable, str(HERE / f"native_{graph.kind}_goals.py"), *arguments],
        env=os.environ | graph.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )


def heard(process: "subprocess.Popen[str]") -> list[dict[str, Any]]:
    """What a client has printed at its end; Fast DDS 2 may report something in between."""
    try:
        lines = process.communicate(timeout=2 * PATIENCE)[0].splitlines()
    except subprocess.TimeoutExpired:
        process.kill()
        raise AssertionError(f"the client does not end; it said {process.communicate()[0]}") from None
    return [json.loads(line) for line in lines if line.startswith("{")]


def test_a_native_client_gives_a_goal_and_hears_of_it(graph: Any, agents: Agents) -> None:
    told = heard(client(graph, f"/{agents.agent}/deliver", '["p1", "kitchen"]'))
    assert {"doing": "drive(kitchen)", "progress": -1.0, "note": ""} in told
    assert {"doing": 'deliver("p1",kitchen)', "progress": 0.5, "note": "half"} in told
    assert (told[-1]["status"], told[-1]["state"]) == (4, "achieved")


def test_a_native_client_hears_why_a_goal_is_refused(graph: Any, agents: Agents) -> None:
    told = heard(client(graph, f"/{agents.agent}/deliver", '["p1", "office"]'))
    assert (told[-1]["status"], told[-1]["state"]) == (6, "refused")
    assert told[-1]["reasons"][0] == "refused(closed(office))"


def test_a_native_client_cancels(graph: Any, agents: Agents) -> None:
    told = heard(client(graph, f"/{agents.agent}/achieve", "guard", "--cancel"))
    assert (told[-1]["status"], told[-1]["state"]) == (5, "cancelled")
    agents.wait_for("tidied")


def test_a_goal_whose_only_client_is_killed_is_cancelled(graph: Any, agents: Agents) -> None:
    """Its offer says so. Fast DDS notices after twenty seconds that a process was killed."""
    process = client(graph, f"/{agents.agent}/guard", "")
    try:
        agents.wait_for("guarding")
    finally:
        process.kill()
        process.communicate()
    agents.wait_for("tidied")


def has(module: str) -> bool:
    return importlib.util.find_spec(module) is not None


needs_commands = pytest.mark.skipif(
    not has("ros2cli"), reason="THE COMMANDS OF ROS 2 ARE NOT TESTED: no ros2cli here, and no wheels of it"
)


def ros2(graph: Any, *arguments: str) -> str:
    """The output of a command of ROS 2."""
    code = "import sys; from ros2cli.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env=os.environ | graph.environment | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    return done.stdout


def until(found: Callable[[], bool], what: str) -> None:
    """Try again what needs the discovery of nodes, which a command without a daemon begins anew."""
    deadline = time.monotonic() + PATIENCE
    while not found():
        assert time.monotonic() < deadline, what


@needs_commands
@pytest.mark.only("ros2")
def test_ros2_action_send_goal(graph: Any, agents: Agents) -> None:
    goal = json.dumps({"goal": '["p1", "kitchen"]'})
    kind = "jacaros_interfaces/action/Achieve"
    told = ros2(graph, "action", "send_goal", "--feedback", f"/{agents.agent}/deliver", kind, goal)
    assert "doing: drive(kitchen)" in told
    assert "Goal finished with status: SUCCEEDED" in told


@needs_commands
@pytest.mark.only("ros2")
def test_ros2_lifecycle(graph: Any, tmp_path: Path) -> None:
    agents = Agents(graph, tmp_path, "--lifecycle")
    node, at_once = f"/{agents.agent}", ("--no-daemon", "--spin-time", "3")
    try:
        for transition in ("configure", "activate", "deactivate", "shutdown"):
            until(
                lambda t=transition: "successful" in ros2(graph, "lifecycle", "set", node, t, *at_once),
                transition,
            )
            agents.wait_for(f"by `{transition}`")
        assert agents.wait() == 0
    finally:
        agents.close()


TREE = """
import sys, types, importlib.util, time
import py_trees, rclpy
package = types.ModuleType("py_trees_ros")  # without its blackboards, which need a compiled package
package.__path__ = list(importlib.util.find_spec("py_trees_ros").submodule_search_locations)
sys.modules["py_trees_ros"] = package
from py_trees_ros.action_clients import FromConstant
from jacaros_interfaces.action import Achieve

rclpy.init()
node = rclpy.create_node("tree")
deliver = FromConstant("deliver", Achieve, sys.argv[1], Achieve.Goal(goal=sys.argv[2]))
tree = py_trees.trees.BehaviourTree(deliver)
tree.setup(node=node, timeout=30.0)
deadline = time.monotonic() + 60.0
while deliver.status not in (py_trees.common.Status.SUCCESS, py_trees.common.Status.FAILURE):
    tree.tick()
    rclpy.spin_once(node, timeout_sec=0.1)
    assert time.monotonic() < deadline
print(deliver.status.name)
"""


@pytest.mark.skipif(
    not has("py_trees_ros"), reason="PY_TREES_ROS IS NOT TESTED: it is not here, and has no wheels"
)
@pytest.mark.only("ros2")
@pytest.mark.parametrize(("room", "status"), [("kitchen", "SUCCESS"), ("office", "FAILURE")])
def test_a_behaviour_tree_gives_a_goal(graph: Any, agents: Agents, room: str, status: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", TREE, f"/{agents.agent}/deliver", f'["p1", "{room}"]'],
        env=os.environ | graph.environment,
        capture_output=True,
        text=True,
        timeout=2 * PATIENCE,
        check=False,
    )
    assert done.stdout.splitlines()[-1:] == [status], done.stderr
