"""Options and fixtures of the whole test suite: which real ROS graphs must be there."""

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let a run insist on a real ROS: what is missing then fails instead of being skipped."""
    group = parser.getgroup("jacaros")
    group.addoption("--require-ros1", action="store_true", help="fail, do not skip, when ROS 1 is missing")
    group.addoption("--require-ros2", action="store_true", help="fail, do not skip, when ROS 2 is missing")
    group.addoption(
        "--require-rosbridge", action="store_true", help="fail, do not skip, when roslibpy is missing"
    )
