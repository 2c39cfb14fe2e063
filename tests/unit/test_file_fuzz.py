"""The fuzzer of `tools`, for a moment with each kind of file: it is taken, or refused with a message that can be read."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import fuzz  # noqa: E402
from fuzzed_files import KINDS  # noqa: E402


@pytest.mark.parametrize("kind", KINDS)
def test_a_damaged_file_is_taken_or_refused(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    tally = fuzz.fuzz(kind, 2026, range(40), 60.0, tmp_path)
    assert not tally.findings


def test_a_file_belongs_to_its_kind_seed_and_number(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for kind in ("program", *KINDS):
        assert fuzz.made(kind, 3, 14) == fuzz.made(kind, 3, 14)
        assert fuzz.made(kind, 3, 14) != fuzz.made(kind, 3, 15)
