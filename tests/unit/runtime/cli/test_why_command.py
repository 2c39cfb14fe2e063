"""``jacaros why``: what the command line reports about a recording."""

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from jacaros.runtime.cli.recordings import why as why_command
from jacaros.runtime.errors import UsageError

RECORDING = (
    '{"kind": "world", "version": 2, "world": {"name": "lab", "robots": [{"name": "turtlebot"}]}}\n'
    '{"kind": "event", "t": 0.0, "event": "agent", "data": {"agent": "bob", "what": "asl", "state": "began"}}\n'
)


def asked(path: Path, *arguments: str) -> Result:
    """Ask about the recording *path*."""
    return CliRunner().invoke(
        why_command, [str(path), *arguments], catch_exceptions=False, standalone_mode=False
    )


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A recording of an agent that does nothing."""
    path = tmp_path / "run.jsonl"
    path.write_text(RECORDING, encoding="utf-8")
    return path


def test_a_whole_recording_has_no_warning(recording: Path) -> None:
    assert asked(recording, "waiting", "--agent", "bob").stderr == ""


def test_a_truncated_recording_answers_with_a_warning(recording: Path) -> None:
    recording.write_text(recording.read_text(encoding="utf-8") + '{"kind": "ev', encoding="utf-8")
    result = asked(recording, "waiting")
    assert result.exit_code == 0
    assert "no agent has a goal" in result.stdout
    assert result.stderr.startswith(f"warning: {recording} is cut off or damaged")


@pytest.mark.parametrize("option", ["--agent", "--robot"])
def test_an_unknown_name_is_reported(recording: Path, option: str) -> None:
    with pytest.raises(UsageError, match=f"unknown {option[2:]}: `unknown`"):
        asked(recording, "waiting", option, "unknown")
