"""ROS 2 alone: names and parameters with mismatched types have clear errors."""

import pytest
from programs import run_program

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


def test_a_name_already_used_with_another_type_is_reported(domain: dict[str, str]) -> None:
    done = run_program(PROGRAM, domain)
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


def test_a_mismatched_value_for_a_parameter_of_rclpys_own_is_reported(domain: dict[str, str]) -> None:
    done = run_program(WRONG_PARAMETER, domain)
    assert done.stdout.startswith("a parameter of /node: "), done.stderr
    assert "use_sim_time" in done.stdout
    assert done.returncode == 0
