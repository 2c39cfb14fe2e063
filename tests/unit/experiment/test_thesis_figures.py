"""The figures of the thesis in experiment/thesis.yaml agree with each other."""

from pathlib import Path
from typing import Any

import pytest

from counting import MEASURES
from jacaros.runtime.files.yaml import plain_values

FILE = Path(__file__).parents[3] / "experiment" / "thesis.yaml"


@pytest.fixture(scope="module")
def thesis() -> dict[str, Any]:
    figures, problem = plain_values(FILE.read_text(encoding="utf-8"))
    assert problem is None
    return figures


def test_each_table_has_a_measure_and_each_scenario(thesis: dict[str, Any]) -> None:
    assert set(thesis["tables"]) < set(MEASURES)
    for table in thesis["tables"].values():
        assert set(table) == {"source", *thesis["scenarios"]}


def test_totals_are_the_sums_of_agents_and_artifacts(thesis: dict[str, Any]) -> None:
    for table in thesis["tables"].values():
        for name in thesis["scenarios"]:
            row = table[name]
            assert row["total"] == row["agents"] + row["artifacts"]


@pytest.mark.parametrize("side", ["artifacts", "python"])
def test_lines_are_the_sums_of_whole_listings(thesis: dict[str, Any], side: str) -> None:
    for name, parts in thesis["composition"].items():
        lines = sum(thesis["listings"][side][listing]["lines"] for listing in parts[side])
        assert lines == thesis["tables"]["lines"][name][side]


def test_the_programs_alone_are_smaller_than_the_table_says(thesis: dict[str, Any]) -> None:
    python = thesis["listings"]["python"]
    alone = {
        name: sum(python[each]["lines"] for each in parts) for name, parts in thesis["programs_alone"].items()
    }
    assert alone == {"04_patrol": 216, "05_house_cleaning": 439}
    assert sum(each["lines"] for each in python.values() if each.get("library")) == 444


def test_artifacts_were_compressed_together(thesis: dict[str, Any]) -> None:
    sizes = {
        name: row["artifacts"] for name, row in thesis["tables"]["gzip_bytes"].items() if name != "source"
    }
    assert sizes["04_patrol"] < sizes["02_square"] + sizes["03_fake_battery"]
