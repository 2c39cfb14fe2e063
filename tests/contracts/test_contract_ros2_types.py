"""ROS 2 alone: names and parameters with mismatched types have clear errors."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from presence import is_wanted, ros2_environment

pytestmark = pytest.mark.ros2

PROGRAM = """
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.open import open_backend

async def main():
    backend = open_backend("ros2", WallClock(), "node")
    await backend.start()
    backend.client("/s", "std_srvs/srv/Trigger")
    backend.action_client("/a", "jacaros_interfaces/action/Count")
    for ask in (
        lambda: backend.client("/s", "std_srvs/srv/SetBool"),
        lambda: backend.service("/s", "std_srvs/srv/SetBool", print),
        lambda: backend.action_client("/a", "nav2_msgs/action/NavigateToPose"),
        lambda: backend.action_server("/a", "nav2_msgs/action/NavigateToPose", print),
    ):
        try:
            ask()
        except RosError as error:
            print(error)
    await backend.close()

run(main, WallClock())
"""


def test_a_name_already_used_with_another_type_is_reported(
    tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    if not is_wanted("ros2", request.config):
        pytest.skip("no ROS 2 here; see test_contract_presence")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        env=os.environ | ros2_environment(tmp_path),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    end = "this node already uses it with another type"
    assert done.stdout.splitlines() == [
        f"service /s cannot be used with type std_srvs/srv/SetBool: {end}",
        f"service /s cannot be used with type std_srvs/srv/SetBool: {end}",
        f"action /a cannot be used with type nav2_msgs/action/NavigateToPose: {end}",
        f"action /a cannot be used with type nav2_msgs/action/NavigateToPose: {end}",
    ], done.stderr


WRONG_PARAMETER = """
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.errors import ParameterRefused
from jacaros.robots.ros.open import open_backend

async def main():
    backend = open_backend("ros2", WallClock(), "node", parameters={"use_sim_time": 5})
    try:
        await backend.start()
    except ParameterRefused as error:
        print(error)

run(main, WallClock())
"""


def test_a_mismatched_value_for_a_parameter_of_rclpys_own_is_reported(
    tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    if not is_wanted("ros2", request.config):
        pytest.skip("no ROS 2 here; see test_contract_presence")
    done = subprocess.run(
        [sys.executable, "-c", WRONG_PARAMETER],
        env=os.environ | ros2_environment(tmp_path),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.stdout.startswith("a parameter of /node: "), done.stderr
    assert "use_sim_time" in done.stdout
    assert done.returncode == 0
