"""Warnings of commands about incomplete recordings."""

import gzip
import json
from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call

WORLD = {"kind": "world", "version": 2, "world": {}}
WAITS = {
    "kind": "event",
    "t": 1.0,
    "event": "agent",
    "data": {"agent": "bob", "what": "asl", "state": "began"},
}


def written(path: Path, world: dict[str, object] = WORLD) -> Path:
    text = "".join(json.dumps(each) + "\n" for each in (world, WAITS))
    path.write_bytes(gzip.compress(text.encode()) if path.suffix == ".gz" else text.encode())
    return path


@pytest.mark.parametrize("command", ["why", "view"])
def test_a_recording_of_a_newer_version_is_read_with_a_warning(command: str, tmp_path, capsys):
    run = str(written(tmp_path / "run.jsonl", {**WORLD, "version": 99}))
    more = {"why": ["nothing"], "view": ["--output", str(tmp_path / "run.html")]}
    assert call([command, run, *more[command]]) == 0
    assert "warning: " in (told := capsys.readouterr().err)
    assert "version 99" in told


def test_a_truncated_compressed_recording_is_read_to_its_last_line(tmp_path, capsys):
    run = written(tmp_path / "run.jsonl.gz")
    run.write_bytes(run.read_bytes()[:-8])
    assert call(["why", str(run), "nothing"]) == 0  # the sum at its end is missing
    assert "at 1.000 s" in capsys.readouterr().out
