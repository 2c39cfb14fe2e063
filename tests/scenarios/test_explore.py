"""Exploring an unknown flat with odometry that drifts."""

from pathlib import Path

import pytest
from examples_lab import LONGEST, checker, falsified, run_of, spoilt, unexpected

from jacaros.robots.map.map_files import load, save
from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, run_project

PROJECT = "10_explore/explore.jcm"
module = checker("10_explore")


def judged(truth: GroundTruth, saved: Path) -> Verdict:
    verdict: Verdict = module.check(truth, saved)
    print(*verdict.lines(), sep="\n")
    return verdict


def explored(folder: Path, seed: int, options: str = "") -> tuple[GroundTruth, Path]:
    """A run of the example, with further options of its map, and the map that it saved."""
    project = spoilt(folder, PROJECT, "[cell_size(Size)]", f"[cell_size(Size){options}]")
    saved, robot = folder / "flat.yaml", project.parent / "robot.asl"
    robot.write_text(
        robot.read_text(encoding="utf-8").replace("runs/flat.yaml", str(saved)), encoding="utf-8"
    )
    result = run_project(project, seed=seed, seconds=LONGEST)
    assert unexpected(result.errors) == []
    assert result.ground_truth is not None
    return result.ground_truth, saved


@pytest.mark.parametrize(
    "seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(7, marks=pytest.mark.slow)]
)
def test_the_map_agrees_with_the_world_and_leads_to_the_goal_and_home(seed: int, tmp_path: Path) -> None:
    truth, saved = explored(tmp_path, seed)
    verdict = judged(truth, saved)
    assert verdict.complaints == []
    assert verdict.measured["share of cells that agree"] > 0.97
    assert load(saved).places == {"home": (0.0, 0.0), "goal": (5.6, 4.1)}


def test_the_output_of_the_agent() -> None:
    lines = run_of(PROJECT).lines
    assert lines[0].startswith("[robot] explored, after driving ")
    assert lines[1:] == ["[robot] at the place called goal", "[robot] at the place called home"]


@pytest.mark.slow
def test_without_matching_scans_the_map_is_wrong(tmp_path: Path) -> None:
    truth, saved = explored(tmp_path, 0, ", pose_from(odometry)")
    assert not judged(truth, saved).passed


def test_a_failed_run_is_noticed(tmp_path: Path) -> None:
    truth, saved = explored(tmp_path, 0)
    middle = truth.path()[len(truth.path()) // 2].time
    half = falsified(truth, sample=lambda sample: sample if sample.time < middle else None)
    assert [each for each in judged(half, saved).complaints if "home" in each]
    grid = load(saved).grid.labels(0.1)
    turned = {(x, -y): label for (x, y), label in grid.items()}
    save(tmp_path / "turned.yaml", 0.1, turned, {})
    assert any("agree" in each for each in judged(truth, tmp_path / "turned.yaml").complaints)
    room = {cell: label for cell, label in grid.items() if cell[0] < 10}
    save(tmp_path / "room.yaml", 0.1, room, {})
    assert any("floor" in each for each in judged(truth, tmp_path / "room.yaml").complaints)
