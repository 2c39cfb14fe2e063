"""The benchmark of reactivity: its program stops for every bump, and its table shows what was measured."""

from pathlib import Path

import pytest
import reactivity


@pytest.fixture(autouse=True)
def sources(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3] / "src"))


@pytest.mark.parametrize("urgent", [True, False])
def test_every_bump_is_answered_beside_busy_intentions(urgent: bool) -> None:
    found = reactivity.once("memory", "steady", urgent, 3, None)
    assert (len(found["times"]), found["lost"]) == (3, 0)


def test_every_bump_is_answered_when_percepts_wait() -> None:
    found = reactivity.once("memory", "burst", True, 1, None)
    assert (len(found["times"]), found["lost"]) == (1, 0)


def test_the_bumper_plan_has_urgency_or_not(tmp_path: Path) -> None:
    texts = [reactivity.written(tmp_path, urgent).read_text(encoding="utf-8") for urgent in (True, False)]
    assert ["urgency" in text for text in texts] == [True, False]
    assert texts[0].replace(reactivity.LABEL, "") == texts[1]


def test_figures_are_percentiles_of_the_reaction_times() -> None:
    times = [number / 1000 for number in range(200, 0, -1)]
    found = reactivity.summary(times, lost=1)
    assert found == {"bumps": 200, "lost": 1, "p50": 0.101, "p99": 0.199, "most": 0.2}


def test_a_measurement_without_answers_has_dashes() -> None:
    figure = {"graph": "memory", "load": "intentions", "urgent": True}
    found = figure | reactivity.summary([], lost=2)
    assert reactivity.table([found]).splitlines()[-1] == (
        "| memory | intentions | with | – | – | – | 0, 2 lost |"
    )


def test_missing_graphs_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(reactivity.graphs, "python_of", lambda kind: tmp_path / kind)
    found = reactivity.measured(["ros1", "ros2-jazzy", "rosbridge"], True, None, print)
    assert found["figures"] == []
    assert [note.partition(":")[0] for note in found["notes"]] == ["ros1", "ros2-jazzy", "rosbridge"]
