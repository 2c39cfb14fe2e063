"""The client of the deliveries example, as a program of its own on ROS 2, with the world and the agents in others."""

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from typing import Any

import pytest
from examples_lab import EXAMPLES
from processes import Agents, WorldProcess

pytestmark = [pytest.mark.only("ros2")]
FOLDER = EXAMPLES / "13_deliveries"
PATIENCE = 120.0


def ordered(environment: Mapping[str, str], parcel: str, room: str) -> tuple[int, list[str]]:
    """Run the client. Return its exit code and what it printed."""
    done = subprocess.run(
        [sys.executable, str(FOLDER / "clients" / "ros2_client.py"), parcel, room],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.stdout, done.stderr
    return done.returncode, done.stdout.splitlines()


def test_a_node_of_ros2_orders_a_delivery(
    run_world: Callable[..., WorldProcess], run_agents: Callable[..., Agents], environment: Any
) -> None:
    run_world("house")
    run_agents(FOLDER / "deliveries.jcm", "--offer")
    while True:
        code, lines = ordered(environment, "mail", "living_room")
        if lines[-1] != "refused starting":
            break
    assert (code, lines[-1].startswith('achieved {"percent": ')) == (0, True), lines
    assert any(line.startswith("drive_there(2,0,") for line in lines), lines
    code, lines = ordered(environment, "mail", "cellar")
    assert (code, lines[-1].split(" ")[0]) == (1, "invalid_arguments"), lines
