"""The study with users: its plan and evaluation, on data that are made up here and published nowhere."""

import math
import random
import sys
from collections import Counter
from pathlib import Path

import evaluate
import plan
import pytest

REQUESTS = {
    "A": ("add_a_room", "add_an_emergency_stop"),
    "B": ("change_the_order", "charge_before_the_last_round"),
}


def made_up(participants: int, ratio: float, gain: float, folder: Path) -> tuple[Path, Path]:
    """Write tables of participants who need *ratio* as long with agents, and explain *gain* more with `why`."""
    draw = random.Random(3)
    changes = [evaluate.MADE_UP, "participant,group,part,side,request,minutes,errors,accepted"]
    explanations = [evaluate.MADE_UP, "participant,run,why,correct"]
    for number, group in enumerate(plan.assigned(participants, 3), 1):
        skill = draw.gauss(0, 0.3)
        for part, text in enumerate(plan.GROUPS[group - 1], 1):
            side, letter = text.split()
            for request in REQUESTS[letter]:
                slower = ratio if side == "agents" else 1.0
                minutes = 12 * slower * math.exp(skill + draw.gauss(0, 0.2))
                changes.append(
                    f"{number},{group},{part},{side},{request},{minutes:.1f},{draw.randint(0, 2)},yes"
                )
        for run in range(1, 7):
            why = run % 2 == number % 2
            correct = draw.random() < 0.4 + gain * why
            explanations.append(f"{number},{run},{'yes' if why else 'no'},{'yes' if correct else 'no'}")
    files = folder / "changes.csv", folder / "explanations.csv"
    for file, lines in zip(files, (changes, explanations), strict=True):
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return files


def printed(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> list[str]:
    monkeypatch.setattr(sys, "argv", ["evaluate.py", *map(str, files)])
    evaluate.main()
    return capsys.readouterr().out.splitlines()


def test_a_difference_is_found_and_made_up_data_are_labelled(tmp_path, capsys, monkeypatch) -> None:
    lines = printed(made_up(16, 0.6, 0.5, tmp_path), capsys, monkeypatch)
    assert lines[0].startswith("THESE DATA ARE MADE UP")
    time, explained = lines[2], lines[4]
    assert time.startswith(("Time, agents / tree: 0.5", "Time, agents / tree: 0.6"))
    assert "p = 0.000" in time
    assert explained.startswith("Explained correctly, with - without `why`: +")


def test_no_difference_is_found_where_none_is(tmp_path, capsys, monkeypatch) -> None:
    changes, _ = evaluate.read(made_up(16, 1.0, 0.0, tmp_path)[0])
    result = evaluate.compared(changes, "side", "agents", "tree", evaluate.log_minutes)
    assert result.low < 0 < result.high
    assert result.p > 0.05


def test_the_permutation_test_counts_all_swaps() -> None:
    assert evaluate.permutation([1.0, 2.0, 3.0]) == 2 / 8
    assert evaluate.permutation([1.0, -1.0]) == 1.0


def test_a_participant_with_one_side_alone_does_not_count() -> None:
    rows = [
        {"participant": "1", "side": "agents", "errors": "1"},
        {"participant": "1", "side": "tree", "errors": "3"},
        {"participant": "2", "side": "tree", "errors": "9"},
    ]
    result = evaluate.compared(rows, "side", "agents", "tree", lambda row: float(row["errors"]))
    assert (result.participants, result.difference) == (1, -2.0)
    with pytest.raises(ValueError, match="no participant has both"):
        evaluate.compared(rows[2:], "side", "agents", "tree", lambda row: float(row["errors"]))


def test_groups_are_alike() -> None:
    counts = Counter(plan.assigned(18, 1))
    assert sorted(counts) == [1, 2, 3, 4]
    assert max(counts.values()) - min(counts.values()) <= 1
    assert plan.assigned(18, 1) == plan.assigned(18, 1) != plan.assigned(18, 2)
    for first, second in plan.GROUPS:
        assert {first.split()[0], second.split()[0]} == {"agents", "tree"}
        assert {first.split()[1], second.split()[1]} == {"A", "B"}
