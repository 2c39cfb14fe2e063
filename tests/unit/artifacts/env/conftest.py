"""A test of this folder that is a coroutine plays on a stage.

Its parameters may be the ``stage``; ``it``, an artifact of the class in the mark ``makes``; ``made``, this artifact as
its own code knows it; and ``watcher``, which observes it and has taken the first note. Or a ``session``, and the
``counter`` and the ``wheels`` that it has made and focuses on.
"""

import importlib
import inspect

import pytest

from jacaros.artifacts import Session
from stage_lab import play


def pytest_configure(config):
    config.addinivalue_line("markers", "makes(it=type): class of the artifact `it`")
    config.addinivalue_line("markers", "expects_defects: the scene has defects of JaCaROS itself")


@pytest.fixture
def stage():
    """The place of what is made in the loop of the test."""


it = made = watcher = session = counter = wheels = stage


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    names = inspect.signature(test).parameters.keys()

    async def scene(stage):
        given = {name: pyfuncitem.funcargs[name] for name in names} | {"stage": stage}
        if not names.isdisjoint(("it", "made", "watcher")):
            given["it"] = await stage.make(pyfuncitem.get_closest_marker("makes").kwargs["it"])
            given["made"] = stage.environment.artifact(given["it"])
        if "watcher" in names:
            given["watcher"] = stage.watch(given["it"])
            given["watcher"].take()
        if "session" in names:
            given["session"] = Session(stage.environment, "painter")
        for name in [each for each in ("wheels", "counter") if each in names]:
            kind = getattr(importlib.import_module("session_lab"), name.title())
            given[name] = given["session"].focus(await given["session"].make_artifact(name, kind))
        await test(**{name: given[name] for name in names})

    play(scene, expect_defects=pyfuncitem.get_closest_marker("expects_defects") is not None)
    return True
