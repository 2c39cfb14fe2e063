"""Code of a project that reads the time of day in a run on the virtual clock."""

from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call
from jacaros.testing import run_project

PROJECT = "mas rooms { agent bob : bob.asl\n workspace w { artifact heater: Heater() } }"
HEATER = """
from jacaros.artifacts import Artifact
{imports}

class Heater(Artifact):
    def init(self) -> None:
        self.begun = {call}
"""


def errors_of(
    folder: Path, capsys: pytest.CaptureFixture[str], imports: str, written: str, clock: str
) -> str:
    """The standard error output of a run with an artifact that makes a call."""
    (folder / "rooms.jcm").write_text(PROJECT)
    (folder / "bob.asl").write_text("!start.\n+!start <- .stopMAS.\n")
    (folder / "artifacts.py").write_text(HEATER.format(imports=imports, call=written))
    assert call(["run", str(folder / "rooms.jcm"), "--clock", clock]) == 0
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("imports", "written", "name"),
    [
        ("import time", "time.time()", "time.time"),
        ("import time as t", "t.monotonic()", "time.monotonic"),
        ("from time import monotonic as now", "now()", "time.monotonic"),
        ("import time", "time.sleep(0.0)", "time.sleep"),
        ("import datetime", "datetime.date.today()", "datetime.date.today"),
        ("from datetime import datetime as dt, UTC", "dt.now(UTC)", "datetime.datetime.now"),
        ("from threading import Timer", "Timer(9.0, print)", "threading.Timer"),
    ],
)
def test_a_run_on_the_virtual_clock_warns(imports: str, written: str, name: str, tmp_path, capsys):
    errors = errors_of(tmp_path, capsys, imports, written, "fast")
    assert f"artifacts.py:7:22: warning: `{name}` follows the time of day" in errors
    assert "= help: use `" in errors
    assert errors_of(tmp_path, capsys, imports, written, "real") == ""


@pytest.mark.parametrize(
    "written",
    ["self.clock.elapsed", "self.clock.now()", "time.perf_counter()", "clock.time()", "datetime.min.now"],
)
def test_other_readings_are_fine(written: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    imports = "import time\nfrom datetime import datetime\nfrom types import SimpleNamespace\n"
    imports += "clock = SimpleNamespace(time=lambda: 0)"
    assert errors_of(tmp_path, capsys, imports, written, "fast") == ""


ASYNCIO = """
import asyncio
from jacaros.artifacts import Artifact, Out, operation

class Heater(Artifact):
    @operation
    async def heat(self, hours: Out) -> None:
        begun, loop, rung = self.clock.elapsed, asyncio.get_running_loop(), asyncio.Event()
        await asyncio.sleep(3600)
        loop.call_later(3600, rung.set)
        await rung.wait()
        try:
            async with asyncio.timeout(3600):
                await asyncio.Event().wait()
        except TimeoutError:
            hours.set((self.clock.elapsed - begun) / 3600)
"""


def test_timers_of_asyncio_follow_the_virtual_clock(tmp_path: Path) -> None:
    (tmp_path / "rooms.jcm").write_text(PROJECT.replace("bob.asl", "bob.asl { focus: w.heater }"))
    (tmp_path / "bob.asl").write_text("!start.\n+!start <- heat(Hours); .print(Hours); .stopMAS.\n")
    (tmp_path / "artifacts.py").write_text(ASYNCIO)
    result = run_project(tmp_path / "rooms.jcm")
    assert (result.lines, result.errors) == (["[bob] 3"], [])
    assert 3 * 3600 <= result.seconds < 3 * 3600 + 1
