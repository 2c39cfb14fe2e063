"""Verdicts of checkers, and their main program."""

import json
from pathlib import Path

import pytest

from jacaros.robots.world import GroundTruth
from jacaros.robots.world.data.ground_truth import header
from jacaros.testing import Verdict, judge

ROBOT = {"name": "r", "pose": [0, 0, 0], "radius": 0.17}


def check(truth: GroundTruth) -> Verdict:
    verdict = Verdict()
    verdict.at_most("metres driven", truth.odometer(), 1.0)
    return verdict


def truth_file(folder: Path, odometer: float) -> str:
    sample = {"time": 0, "x": 0, "y": 0, "yaw": 0, "battery": 100, "charging": False, "touching": False}
    records = [
        header({"robots": [ROBOT]}, 0, 0.0),
        {"kind": "sample", "robot": "r", **sample, "odometer": odometer},
    ]
    path = folder / "truth.jsonl"
    path.write_text("".join(json.dumps(record) + "\n" for record in records), encoding="utf-8")
    return str(path)


def test_a_verdict_without_complaints_passes() -> None:
    verdict = Verdict()
    assert verdict.measure("metres", 0.123456) == 0.123456
    verdict.expect(True, "never said")
    assert verdict.passed
    assert verdict.lines() == ["metres: 0.1235", "passed"]


def test_every_complaint_is_listed() -> None:
    verdict = Verdict()
    verdict.expect(False, "too late")
    verdict.at_most("metres off", 0.06, 0.05)
    assert not verdict.passed
    assert verdict.lines() == [
        "metres off: 0.06",
        "FAILED: too late",
        "FAILED: metres off: 0.06, more than 0.05",
    ]


@pytest.mark.parametrize(("odometer", "code", "last"), [(0.5, 0, "passed"), (1.5, 1, "more than 1")])
def test_a_ground_truth_file_is_judged(
    odometer: float, code: int, last: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert judge(check, [truth_file(tmp_path, odometer)]) == code
    assert capsys.readouterr().out.rstrip().endswith(last)


def test_an_invalid_ground_truth_file_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty"
    empty.write_text("{}\n", encoding="utf-8")
    assert judge(check, [str(empty)]) == 1
    assert judge(check, [str(tmp_path / "missing")]) == 1
    assert judge(check, []) == 2
    assert "cannot read the ground truth" in capsys.readouterr().out
