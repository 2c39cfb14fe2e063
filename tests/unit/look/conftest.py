"""Makes the drivers of pages importable by the tests of this folder, and runs those that are coroutines.

They run on the event loop of `jacaros.run`, on the clock that the mark or the parameter ``clock`` names.
"""

import inspect
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "clock(name): clock of a coroutine's event loop, real or fast")


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    from jacaros import run

    given = {name: pyfuncitem.funcargs[name] for name in inspect.signature(test).parameters}
    mark = pyfuncitem.get_closest_marker("clock")
    run(test(**given), clock=mark.args[0] if mark is not None else given.get("clock", "real"))
    return True
