"""`jacaros check` warns of nothing in programs that are right."""

from pathlib import Path

import pytest
from right_programs import Alarm, alarms_in_files, alarms_of_pages

TRUE = Path(__file__).with_name("true_alarms.tsv")
"""Alarms about programs that show a mistake on purpose, or that do what is nearly always one: each with its reason."""


def true_alarms() -> dict[Alarm, str]:
    """Return the judged alarms with their reasons."""
    rows = [line.split("\t") for line in TRUE.read_text(encoding="utf-8").splitlines()[1:]]
    return {(place, code, message): reason for place, code, message, reason in rows}


def test_programs_in_files_have_true_alarms_only() -> None:
    assert _false(set(alarms_in_files())) == []


def test_programs_of_pages_have_true_alarms_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert _false(set(alarms_of_pages(tmp_path))) == []


def test_every_true_alarm_has_a_reason() -> None:
    assert [alarm for alarm, reason in true_alarms().items() if len(reason.split()) < 3] == []


def _false(found: set[Alarm]) -> list[str]:
    """Return alarms that are not in the list of judged ones, as lines for the table."""
    return ["\t".join(alarm) for alarm in sorted(found - true_alarms().keys())]
