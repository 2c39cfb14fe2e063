"""The baselines of the experiment, run on the virtual clock and judged by the checkers of the examples."""

import ast
import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.robots.world import GroundTruth
from jacaros.runtime.errors import JacarosError

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from scenarios import SCENARIOS
from virtual_run import main, run_baseline

LIBRARIES = {"math", "operator", "py_trees", "rclpy", "tf2_ros"}


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_baseline_imports_ros_and_py_trees_alone(name: str) -> None:
    tree = ast.parse(SCENARIOS[name].baseline.read_text(encoding="utf-8"))
    imported = {
        module.split(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for module in (
            [node.module or ""] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
        )
    }
    assert {module for module in imported if not module.endswith("_msgs")} <= LIBRARIES


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("name", SCENARIOS)
def test_the_baseline_passes_the_checker_of_the_example(name: str, seed: int) -> None:
    result = run_baseline(name, seed=seed)
    verdict = SCENARIOS[name].judge(result)
    print(f"{result.seconds:.1f} s", *verdict.lines(), sep="\n")
    assert verdict.complaints == []
    assert result.errors == []
    assert result.exit_code == 0


def test_the_baseline_passes_without_noise() -> None:
    world = "name: calm\nsize: [6, 6]\nrobots:\n  - {name: turtlebot}\n"
    for name in ("out_and_back", "square"):
        assert SCENARIOS[name].judge(run_baseline(name, world)).complaints == []


def path_of(name: str, seed: int, faults: str | None = None) -> list[object]:
    truth: GroundTruth = run_baseline(name, seconds=30.0, seed=seed, faults=faults).ground_truth
    return [*truth.path(), *truth.events]


@pytest.mark.parametrize("name", ["out_and_back", "patrol"])
def test_the_same_seed_gives_the_same_run(name: str) -> None:
    assert path_of(name, seed=3) == path_of(name, seed=3)
    assert path_of(name, seed=3) != path_of(name, seed=4)


def test_random_faults_follow_the_seed_and_lose_commands() -> None:
    faults = "faults:\n  deaf: {kind: lost, topic: /cmd_vel, share: 0.5, at: 0}\n"
    assert path_of("square", 3, faults) == path_of("square", 3, faults)
    assert path_of("square", 3, faults) != path_of("square", 3)
    faults = "faults:\n  deaf: {kind: dead, topic: /cmd_vel, at: 0}\n"
    result = run_baseline("out_and_back", seconds=20.0, faults=faults)
    assert result.ground_truth.odometer() == 0.0


def test_a_patrol_whose_way_is_blocked_asks_for_help(tmp_path: Path) -> None:
    world = tmp_path / "blocked.yaml"
    text = (EXAMPLES / "04_patrol/patrol.yaml").read_text(encoding="utf-8")
    wall = "walls:\n  - box: {from: [1.8, -0.2], to: [2.2, 0.2]}\n"
    world.write_text(text.replace("walls:\n", wall, 1), encoding="utf-8")
    result = run_baseline("patrol", world)
    assert result.exit_code == 1
    assert result.lines == ["[patrol] I need help: Corner 1 cannot be reached"]


def test_a_program_that_does_not_end_is_ended() -> None:
    result = run_baseline("patrol", seconds=5.0)
    assert (result.exit_code, result.seconds) == (0, pytest.approx(5.0))


def test_genuine_modules_are_not_hidden_afterwards() -> None:
    before = {name for name in sys.modules if name.split(".")[0] in ("rclpy", "tf2_ros", "geometry_msgs")}
    run_baseline("out_and_back", seconds=1.0)
    after = {name for name in sys.modules if name.split(".")[0] in ("rclpy", "tf2_ros", "geometry_msgs")}
    assert after == before


def test_a_wrong_fault_file_is_an_error() -> None:
    with pytest.raises(JacarosError, match="no_such"):
        run_baseline("square", faults="faults:\n  odd: {kind: no_such}\n")


def test_the_command_judges_the_run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys, "argv", ["virtual_run.py", "out_and_back", "--for", "3"])
    assert main() == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["[out_and_back] driving out", "3.0 seconds, exit code 0"]
    assert "FAILED: the robot turned around 0 times, not twice" in lines
