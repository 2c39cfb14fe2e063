"""Lets the tests of this folder import its laboratory, which pytest's importlib mode does not, and run in it.

A test that is a coroutine runs in a laboratory, its parameter ``lab``: in the world of the mark ``world``, or in none.
"""

import inspect
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "world(name): text or name of the world of a coroutine's laboratory")


@pytest.fixture
def lab() -> None:
    """The place of the laboratory, which is made in the loop of the test."""


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    from robot_lab import in_lab

    mark = pyfuncitem.get_closest_marker("world")
    given = {name: pyfuncitem.funcargs[name] for name in inspect.signature(test).parameters}
    in_lab(lambda lab: test(**{**given, "lab": lab}), mark.args[0] if mark is not None else None)
    return True
