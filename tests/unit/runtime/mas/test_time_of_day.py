"""Code of a project that reads the time of day in a run on the virtual clock."""

from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call

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
        ("import time", "time.time()", "time"),
        ("import time as t", "t.monotonic()", "monotonic"),
        ("from time import monotonic as now", "now()", "monotonic"),
        ("import time", "time.sleep(0.0)", "sleep"),
    ],
)
def test_a_run_on_the_virtual_clock_warns(imports: str, written: str, name: str, tmp_path, capsys):
    errors = errors_of(tmp_path, capsys, imports, written, "fast")
    assert f"artifacts.py:7:22: warning: `time.{name}` follows the time of day" in errors
    assert "= help: use `" in errors
    assert errors_of(tmp_path, capsys, imports, written, "real") == ""


@pytest.mark.parametrize(
    "written", ["self.clock.elapsed", "self.clock.now()", "time.perf_counter()", "clock.time()"]
)
def test_other_readings_are_fine(written: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    imports = "import time\nfrom types import SimpleNamespace\nclock = SimpleNamespace(time=lambda: 0)"
    assert errors_of(tmp_path, capsys, imports, written, "fast") == ""
