"""`jacaros check` reports mistakes in programs that have no other one."""

from pathlib import Path

import pytest
from corpus import BY_NAME, CORPUS, EQUAL, read, with_mistake
from measuring import table, unreported
from mutations import Mistake
from run_mistakes import silent

LEAST = 0.95
"""Part of the mistakes that `check` reports at the right place."""
SAMPLE = slice(None, None, 7)
SILENT = 1
"""How many of the 22 mistakes of the sample neither `check` nor a run reports."""


@pytest.fixture(scope="module")
def missed(tmp_path_factory: pytest.TempPathFactory) -> list[Mistake]:
    """Return the mistakes that `check` does not report."""
    return unreported(read(), tmp_path_factory.mktemp("checked"))


def test_check_reports_most_mistakes_at_their_place(missed: list[Mistake]) -> None:
    mistakes = read()
    print(table(mistakes, missed))
    assert len(missed) <= (1 - LEAST) * len(mistakes), table(mistakes, missed)


def test_check_or_a_run_reports_most_of_a_sample(missed: list[Mistake], tmp_path: Path) -> None:
    sample = read()[SAMPLE]
    left = list(silent([each for each in sample if each in missed], tmp_path))
    assert len(left) <= SILENT, table(sample, left)


@pytest.mark.parametrize("path", [CORPUS, EQUAL], ids=lambda path: path.stem)
def test_every_line_of_the_table_is_in_its_program(path: Path) -> None:
    for each in read(path):
        with_mistake(BY_NAME[each.program].files()[each.file], each)


def test_the_table_has_150_mistakes_of_13_kinds() -> None:
    mistakes = read()
    assert len(mistakes) == 150
    assert len({each.kind for each in mistakes}) == 13
    assert len({each.program for each in mistakes}) >= 40
