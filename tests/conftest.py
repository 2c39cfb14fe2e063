"""Options and fixtures of the whole test suite."""

import gc
import os
import sys
from collections.abc import Callable, Iterator

import hypothesis
import pytest

# The same examples in every run, however slow the machine. `--hypothesis-profile exploring` looks for new ones.
UNTIMED = hypothesis.settings(deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow])
hypothesis.settings.register_profile("exploring", UNTIMED)
hypothesis.settings.register_profile("repeatable", UNTIMED, derandomize=True, database=None)
hypothesis.settings.load_profile("repeatable")

# No test finds code that another one, or the user, has left.
os.environ["JACAROS_CACHE"] = "0"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let a run insist on a real ROS: what is missing then fails instead of being skipped."""
    group = parser.getgroup("jacaros")
    group.addoption("--require-ros1", action="store_true", help="fail, do not skip, when ROS 1 is missing")
    group.addoption("--require-ros2", action="store_true", help="fail, do not skip, when ROS 2 is missing")
    group.addoption(
        "--require-rosbridge",
        action="store_true",
        help="fail, do not skip, when websockets or roslibpy is missing",
    )
    group.addoption("--require-mqtt", action="store_true", help="fail, do not skip, without an MQTT broker")


@pytest.fixture(autouse=True)
def _no_finalizer_at_the_end_of_the_stack(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep the garbage of other tests out of those that use up Python's stack.

    A finalizer such as that of a closed event loop, run by a collection that begins there, has no stack left, and its
    error would be counted as one of the test.
    """
    if "whole_stack" not in request.keywords:
        yield
        return
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.fixture
def calls_of() -> Callable[[Callable[[], object]], int]:
    """Count the Python functions that a function calls: unlike time, the same on every machine."""

    def count(function: Callable[[], object]) -> int:
        calls = 0

        def note(_frame: object, event: str, _argument: object) -> None:
            nonlocal calls
            calls += event == "call"

        before = sys.getprofile()
        sys.setprofile(note)
        try:
            function()
        finally:
            sys.setprofile(before)
        return calls

    return count
