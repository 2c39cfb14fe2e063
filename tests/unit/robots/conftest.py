"""Lets the tests of this folder import its laboratory, which pytest's importlib mode does not, and run in it.

A test that is a coroutine runs in a laboratory, its parameter ``lab``: in the world of the mark ``world``, or in none.
Its class, the annotation, may have a function ``play`` that makes it and plays the scene.
Its parameters ``artifact`` and ``watcher`` are the artifact of the mark ``makes``, and what observes it.
"""

import inspect
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from jacaros.runtime.clock import WallClock, run

if TYPE_CHECKING:
    from robot_lab import Lab

sys.path.insert(0, str(Path(__file__).parent))


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "world(name): text or name of the world of a coroutine's laboratory")
    config.addinivalue_line(
        "markers", "makes(kind, *arguments, recorded, on_graph): the artifact of a coroutine's laboratory"
    )


@pytest.fixture
def lab() -> None:
    """The place of the laboratory, which is made in the loop of the test."""


@pytest.fixture
def artifact() -> None:
    """The place of the artifact, which is made in the laboratory."""


@pytest.fixture
def watcher() -> None:
    """The place of what observes the artifact."""


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    parameters = inspect.signature(test).parameters
    given = {name: pyfuncitem.funcargs[name] for name in parameters}
    if "lab" not in given:
        run(lambda: test(**given), WallClock())
        return True
    from robot_lab import in_lab

    play = getattr(parameters["lab"].annotation, "play", in_lab)
    mark, makes = map(pyfuncitem.get_closest_marker, ("world", "makes"))

    async def body(lab: "Lab") -> None:
        given["lab"] = lab
        if makes is not None and not given.keys().isdisjoint(("artifact", "watcher")):
            if makes.kwargs["recorded"]:
                lab.record()
            if makes.kwargs["on_graph"]:
                lab.match_late()
            artifact = await lab.make(*makes.args)
            made = {"artifact": artifact, "watcher": lab.watch(artifact) if "watcher" in given else None}
            given.update((name, thing) for name, thing in made.items() if name in given)
        await test(**given)

    play(body, *(mark.args if mark is not None else (None,) if play is in_lab else ()))
    return True
