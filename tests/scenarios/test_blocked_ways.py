"""A way is blocked: the examples go on when it opens or a person helps, and otherwise end with exit status 1."""

from pathlib import Path

import pytest
from examples_lab import EXAMPLES, LONGEST, world_with

import jacaros.robots.world
from jacaros.artifacts import Session
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project

HOUSE = Path(jacaros.robots.world.__file__).parent / "worlds" / "house.yaml"
STUDY = "{name: study, segment: [[1.6, 2.3], [2.6, 2.3]], open: true}"
BATHROOM = "{name: bathroom, segment: [[1, 1.6], [1, 2.5]], open: true}"


def blocked(example: str, folder: Path, seconds: float, answer_at: float | None = None) -> RunResult:
    """Run an example whose way is blocked for some seconds; a person may answer `retry` then."""
    project, world, old, new, fault = CASES[example]

    def person_comes(mas: System) -> None:
        if answer_at is not None:
            person = Session(mas.environment, "person")
            person.join("house")
            mas.clock.call_later(answer_at, lambda: person.begin("answer", 1, "retry", artifact="operator"))

    faults = f"faults:\n  f: {{{fault}, for: {seconds}}}\n"
    changed = world_with(folder, world, old, new)
    return run_project(
        EXAMPLES / project, world=changed, faults=faults, seconds=LONGEST, when_started=person_comes
    )


CASES = {
    "explore": (
        "10_explore/explore.jcm",
        EXAMPLES / "10_explore/explore.yaml",
        "\nrobots:",
        f"\ndoors: [{STUDY}]\nrobots:",
        "kind: closed_door, door: study, at: 0",
    ),
    "parcels": (
        "08_parcels/parcels.jcm",
        HOUSE,
        "\nrobots:",
        f"\ndoors: [{BATHROOM}]\nrobots:",
        "kind: closed_door, door: bathroom, at: 3",
    ),
    "shared robot": (
        "07_shared_robot/shared_robot.jcm",
        EXAMPLES / "07_shared_robot/shared_robot.yaml",
        "level: 100",
        "level: 24.5",
        "kind: person_in_the_way, robot: turtlebot, at: 6",
    ),
}
"""Project, world, a change of the world, and what is in the way, by the names of the examples."""
slow = pytest.mark.slow


@pytest.mark.parametrize(
    ("example", "seconds", "last"),
    [
        pytest.param("explore", 20, "[robot] at the place called home", marks=slow),
        ("parcels", 20, "[customer] all 14 parcels have arrived"),
        pytest.param(
            "shared robot", 10, "[supervisor] the robot is at home: 4 rounds, 3 recharges", marks=slow
        ),
    ],
)
def test_they_go_on_when_the_way_opens(example: str, seconds: float, last: str, tmp_path: Path) -> None:
    result = blocked(example, tmp_path, seconds)
    assert (result.lines[-1], result.exit_code) == (last, 0)
    assert not [line for line in result.lines if "I am stuck" in line]


@slow
@pytest.mark.parametrize("example", CASES)
def test_they_tell_and_end_with_status_1_without_an_answer(example: str, tmp_path: Path) -> None:
    result = blocked(example, tmp_path, LONGEST)
    assert [line for line in result.lines if "question 1: I am stuck: " in line]
    assert result.exit_code == 1
    assert result.seconds < 500


@slow
def test_they_go_on_when_a_person_has_cleared_the_way(tmp_path: Path) -> None:
    result = blocked("parcels", tmp_path, 120, answer_at=130)
    assert (result.lines[-1], result.exit_code) == ("[customer] all 14 parcels have arrived", 0)
    assert [line for line in result.lines if "question 1: I am stuck: " in line]
