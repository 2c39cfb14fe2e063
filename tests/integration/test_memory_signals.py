"""A run that is stopped from outside stops its robots and leaves in good order."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
!go.
+!go <- makeArtifact("motion", "ArtCmdVelAndOdometry", [], M); focus(M); !!announce; moveForward(1000).
+!announce <- .wait(300); .print(driving).
"""


@pytest.mark.slow
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_signal_ends_the_run(tmp_path: Path, number: signal.Signals, code: int) -> None:
    file = tmp_path / "driver.asl"
    file.write_text(PROGRAM, encoding="utf-8")
    record = tmp_path / "record.jsonl"
    command = [sys.executable, "-m", "jacaros", "run", str(file), "--record", str(record)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "[driver] driving\n"
        process.send_signal(number)
        output, errors = process.communicate(timeout=120)
    assert process.returncode == code
    assert output == ""
    assert "Traceback" not in errors
    assert record.read_text(encoding="utf-8").count('"frame"') > 1
