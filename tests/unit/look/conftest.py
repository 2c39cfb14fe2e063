"""Makes the drivers of pages importable by the tests of this folder, and runs those that are coroutines.

They run on the event loop of `jacaros.run`, on the clock that their parameter ``clock`` names.
"""

import inspect
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.obj
    if not inspect.iscoroutinefunction(test):
        return None
    from jacaros import run

    given = {name: pyfuncitem.funcargs[name] for name in inspect.signature(test).parameters}
    run(test(**given), clock=given.get("clock", "real"))
    return True
