"""Which real graphs are there, and what becomes of tests on those that are not."""

import importlib.util
import socket
import sys
from pathlib import Path

import pytest
from masters import Broker, Master

LIBRARIES = {"ros1": "rospy", "ros2": "rclpy"}


def client_of(kind: str) -> str:
    """The backend with which a kind of graph is met: there are several kinds behind a rosbridge server."""
    return kind.partition("-")[0]


def missing(kind: str) -> str | None:
    """Tell what a kind of graph lacks here."""
    kind = client_of(kind)
    if kind == "memory":
        return None
    if kind == "rosbridge":
        # The server of these tests speaks through roslibpy's WebSocket library: an implementation that is not ours.
        lacking = [name for name in ("websockets", "roslibpy") if importlib.util.find_spec(name) is None]
        return f"no {lacking[0]} in {sys.executable}; run `pip install 'jacaros[dev]'`" if lacking else None
    if kind == "mqtt":
        if importlib.util.find_spec("aiomqtt") is None:
            return f"no aiomqtt in {sys.executable}; run `pip install 'jacaros[dev]'`"
        return None if Broker.program() else "no mosquitto; run `tools/install_program.sh mosquitto`"
    if importlib.util.find_spec(LIBRARIES[kind]) is None:
        return f"no {LIBRARIES[kind]} in {sys.executable}; run tools/install_{kind}.sh and use its venv"
    if kind == "ros1" and Master.program() is None:
        return "no rosmaster; run tools/install_ros1.sh"
    return None


def is_wanted(kind: str, config: pytest.Config) -> bool:
    """Whether to run tests on *kind*: `test_contract_presence` tells once of one that is missing, not every test."""
    return missing(kind) is None or config.getoption(f"--require-{client_of(kind)}")


def need(kind: str, config: pytest.Config) -> None:
    """Skip the test where *kind* is missing, or fail where it is required."""
    problem = missing(kind)
    if problem is None:
        return
    if config.getoption(f"--require-{client_of(kind)}"):
        pytest.fail(f"{kind} is required, but there is {problem}")
    pytest.skip(f"{kind.upper()} IS NOT TESTED: {problem}")


_DOMAINS: list[socket.socket] = []
"""What keeps the domains of this process from others as long as it lives."""


def own_domain() -> str:
    """Return the number of a ROS 2 domain that no other test run on this machine uses at the same time."""
    for number in range(1, 101):
        claim = socket.socket(socket.AF_UNIX)
        try:
            claim.bind(f"\0jacaros-test-domain-{number}")
        except OSError:
            claim.close()
            continue
        _DOMAINS.append(claim)
        return str(number)
    pytest.fail("a hundred ROS 2 domains are in use by other test runs")


def ros2_environment(folder: Path) -> dict[str, str]:
    """A domain that no other run uses at the same time, on this machine alone.

    Messages take the network: tests kill processes, and these leave their shared memory behind for good. Another test
    that meets it, or removes it while a third one opens it, loses messages.
    """
    return {
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "ROS_DOMAIN_ID": own_domain(),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_LOG_DIR": str(folder / "log"),
    }
