"""The recorded programs in this process, plain and fast: for `tools/mutants.py`, which changes the code in memory.

`tools/check_conformance.py` runs the same programs with the command `jacaros run`, one process each.
"""

import sys
from pathlib import Path

import pytest

from jacaros.testing import run_project

CASES = Path(__file__).parent
sys.path.insert(0, str(CASES))

from check import Case, by_agent, find_cases  # noqa: E402

RECORDED: list[Case] = [
    *find_cases(str(CASES))[0],
    *find_cases(str(CASES.parent / "conformance_environment"))[0],
]


@pytest.mark.parametrize("plain", [False, True], ids=["fast", "plain"])
@pytest.mark.parametrize("case", RECORDED, ids=lambda case: case.key)
def test_a_program_prints_what_was_recorded(case: Case, plain: bool) -> None:
    found = run_project(case.project, seconds=600, plain=plain)
    lines = [line.rstrip() for line in found.lines]
    wanted = by_agent(case.lines) if case.per_agent else case.lines
    assert (by_agent(lines) if case.per_agent else lines) == wanted
    assert (found.exit_code == 0) == (case.error is None), found.errors
    other = "\n".join(found.errors)
    assert [words for words in case.warnings if not any(_has(words, line) for line in other.splitlines())] == []
    assert f":{case.error or ''}" in other or case.error is None


def _has(words: list[str], line: str) -> bool:
    return all(word.lower() in line.lower() for word in words)
