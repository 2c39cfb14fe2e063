"""A test that is a coroutine is a scene on the virtual clock, which the fixture ``play`` of its folder runs.

What ``play`` makes replaces the fixtures of the same names, such as the running system ``mas``.
"""

import inspect
from collections.abc import Awaitable, Callable

import pytest

import jacaros

Play = Callable[[Callable[..., Awaitable[None]]], object]


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    given = {name: pyfuncitem.funcargs[name] for name in inspect.signature(test).parameters}

    def scene(**made: object) -> Awaitable[None]:
        return test(**{name: made.get(name, value) for name, value in given.items()})

    pyfuncitem.funcargs["play"](scene)
    return True


@pytest.fixture(autouse=True)
def play() -> Play:
    return lambda scene: jacaros.run(scene(), clock="fast")


@pytest.fixture
def mas() -> None:
    """The place of the system, which ``play`` makes."""


@pytest.fixture
def lines() -> list[str]:
    """What the agents of a scene have printed."""
    return []


@pytest.fixture
def logs() -> list[str]:
    """What a scene has logged."""
    return []
