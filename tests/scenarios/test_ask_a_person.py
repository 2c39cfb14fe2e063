"""A person answers an agent's questions in the terminal of `jacaros run`, or does not."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
{ include("$jacaros/artifacts.asl") }
!fetch.
+!fetch
  <- !use_artifact("operator", "Operator", [timeout(60)]);
     ask("Where is the ball?", [kitchen, hall], Place);
     ask("Who are you?", [], Name);
     .print("I look in the ", Place, ", ", Name).
-!fetch[env_failure_reason(R)] <- .print("failed: ", R).
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("typed", "last"),
    [
        (b"garage\n2\nAda\n", "I look in the hall, Ada"),
        (b"kitchen\nAda", "I look in the kitchen, Ada"),
        (b"", "failed: no_answer(60)"),
        (None, "failed: no_answer(60)"),
    ],
    ids=["a refused answer first", "no line end", "an empty input", "a closed input"],
)
def test_a_piped_answer_arrives_in_virtual_time(tmp_path: Path, typed: bytes | None, last: str) -> None:
    (tmp_path / "fetch.asl").write_text(PROGRAM)
    command = [sys.executable, "-m", "jacaros", "run", "fetch.asl", "--clock", "fast", "--until-idle"]
    closed = None if typed is not None else lambda: os.close(0)
    ran = subprocess.run(
        command, input=typed, capture_output=True, cwd=tmp_path, timeout=60, check=True, preexec_fn=closed
    )
    lines = ran.stdout.decode().splitlines()
    assert lines[0] == "[fetch] question 1: Where is the ball? 1) kitchen 2) hall"
    assert lines[-1] == f"[fetch] {last}"
    assert (b"answer refused: `garage`" in ran.stderr) == (typed is not None and b"garage" in typed)
