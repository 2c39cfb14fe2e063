"""The agent tests of the examples pass, and fail for a broken program."""

import shutil
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.testing.suites import Suite, collect
from jacaros.testing.trial import run_suite

FOLDERS = sorted(path for path in EXAMPLES.iterdir() if (path / "tests").is_dir())


def failed(suites: list[Suite]) -> set[str]:
    """Names of the tests that failed; the suites must be there and can be run."""
    assert suites
    assert [suite.error for suite in suites if suite.error is not None] == []
    return {outcome.test.name for suite in suites for outcome in run_suite(suite) if not outcome.passed}


def test_every_example_has_tests() -> None:
    assert len(FOLDERS) == 8
    tests = {folder.name: sum(len(suite.tests) for suite in collect([folder])) for folder in FOLDERS}
    assert [name for name, number in tests.items() if number < 2] == []


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_the_tests_of_an_example_pass(folder: Path) -> None:
    suites = collect([folder])
    assert failed(suites) == set()
    assert [warning for suite in suites for warning in suite.warnings] == []


@pytest.mark.parametrize(
    ("example", "old", "new", "noticed"),
    [
        ("01_out_and_back", "rotate(180)", "rotate(90)", "drives_out_and_back"),
        ("02_square", ".range(Side, 1, 4)", ".range(Side, 1, 3)", "has_four_sides"),
        ("03_fake_battery", "+battery(0)", "+battery(1)", "stops_when_the_battery_is_empty"),
        ("04_patrol", '+diagnostics("Low Battery")', "+diagnostics(_)", "does_not_charge_for_other_news_of_the_battery"),
        ("04_patrol", "!charge_first[", "!dock_and_charge[", "stops_on_its_way_and_goes_on_to_the_same_corner"),
        ("04_patrol", "operationRecharge; ", "", "goes_to_the_dock_when_the_battery_is_low"),
        ("04_patrol", "Percent < Least", "Percent > Least", "remembers_the_lowest_percentage_only"),
        ("05_house_cleaning", "     !return.", "     .print(lost).", "comes_back_to_its_room_after_a_recharge"),
        ("09_three_robots", "     !hand_over;\n", "", "charges_in_its_dock_when_the_battery_is_low"),
        ("07_shared_robot", "     hand_over;\n", "", "takes_the_robot_when_the_battery_is_low_and_gives_it_back_full"),
    ],
)  # fmt: skip
def test_a_spoilt_example_is_noticed(tmp_path: Path, example: str, old: str, new: str, noticed: str) -> None:
    copy = tmp_path / example
    shutil.copytree(EXAMPLES / example, copy)
    texts = {path: path.read_text(encoding="utf-8") for path in copy.glob("*.asl")}
    (program,) = (path for path, text in texts.items() if old in text)
    assert texts[program].count(old) == 1
    program.write_text(texts[program].replace(old, new), encoding="utf-8")
    assert noticed in failed([suite for suite in collect([copy]) if suite.path.suffix == ".asl"])
