"""A test that is a coroutine is a scene on the virtual clock, which the fixture ``play`` of its folder runs.

What ``play`` makes replaces the fixtures of the same names, such as the running system ``mas``.
"""

import inspect
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

import jacaros
from jacaros.testing import RunResult, run_project

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


SUFFIXES = ("asl", "jcm", "mas2j", "py")


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    """Writes files (``a_asl`` is a.asl). Returns the path of the first."""

    def write(**files: str) -> Path:
        paths = [tmp_path / ".".join(name.rsplit("_", 1)) for name in files]
        for path, text in zip(paths, files.values(), strict=True):
            path.write_text(text, encoding="utf-8")
        return paths[0]

    return write


@pytest.fixture
def ran(write: Callable[..., Path]) -> Callable[..., RunResult]:
    """Writes a program a.asl, or files, and runs the first until nothing is left to do, if no option says otherwise."""

    def run(program: str = "", **given: Any) -> RunResult:
        files = {name: given.pop(name) for name in tuple(given) if name.rpartition("_")[2] in SUFFIXES}
        if program:
            files = {"a_asl": program, **files}
        return run_project(write(**files), **{"until_idle": True, **given})

    return run
