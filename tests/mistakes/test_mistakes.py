"""`jacaros check` reports mistakes in programs that have no other one."""

from pathlib import Path

import pytest
from corpus import BY_NAME, CORPUS, EQUAL, read, with_mistake
from measuring import table, unreported

LEAST = 0.83
"""Part of the mistakes that `check` reports at the right place."""


def test_check_reports_most_mistakes_at_their_place(tmp_path: Path) -> None:
    mistakes = read()
    missed = unreported(mistakes, tmp_path)
    print(table(mistakes, missed))
    assert len(missed) <= (1 - LEAST) * len(mistakes), table(mistakes, missed)


@pytest.mark.parametrize("path", [CORPUS, EQUAL], ids=lambda path: path.stem)
def test_every_line_of_the_table_is_in_its_program(path: Path) -> None:
    for each in read(path):
        with_mistake(BY_NAME[each.program].files()[each.file], each)


def test_the_table_has_150_mistakes_of_13_kinds() -> None:
    mistakes = read()
    assert len(mistakes) == 150
    assert len({each.kind for each in mistakes}) == 13
    assert len({each.program for each in mistakes}) >= 40
