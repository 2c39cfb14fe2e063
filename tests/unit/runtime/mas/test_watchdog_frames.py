"""What the watchdog takes for work: a step or a callback of the loop, but no import, which may take long."""

import asyncio
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType

import pytest

from jacaros.runtime.mas.watchdog import task_of

FRAMES: list[FrameType | None] = []


def look() -> None:
    """Note what the watchdog sees at this moment."""
    FRAMES.append(task_of(sys._getframe()))


@pytest.fixture(autouse=True)
def _fresh() -> None:
    FRAMES.clear()


def in_a_callback(function: Callable[[], None]) -> FrameType | None:
    """Call a function in a callback of the loop, and return the work that the watchdog sees in it."""

    async def main() -> None:
        asyncio.get_running_loop().call_soon(function)
        await asyncio.sleep(0)

    asyncio.run(main())
    (found,) = FRAMES
    return found


def test_a_callback_of_the_loop_is_work() -> None:
    def work() -> None:
        look()

    found = in_a_callback(work)
    assert found is not None
    assert found.f_code is work.__code__


def test_an_import_is_not_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "slow_module.py").write_text(f"from {__name__} import look\nlook()\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setitem(sys.modules, __name__, sys.modules[look.__module__])

    def work() -> None:
        import slow_module  # type: ignore[import-not-found]  # noqa: F401

    assert in_a_callback(work) is None


def test_outside_of_the_loop_nothing_is_work() -> None:
    look()
    assert FRAMES == [None]
