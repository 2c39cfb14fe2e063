"""The size of the house is limited; see tools/budget.toml."""

from typing import Any

import pytest
from loading import loaded


@pytest.fixture
def budget() -> Any:
    return loaded("budget")


def test_every_package_keeps_its_budget(budget: Any) -> None:
    assert budget.excesses() == []


def test_a_budget_belongs_to_a_package(budget: Any) -> None:
    assert set(budget.limits()) == set(budget.sizes())


def test_a_package_above_its_budget_or_without_one_is_named(budget: Any, monkeypatch) -> None:
    monkeypatch.setattr(budget, "sizes", lambda: {"terms": (11, 2), "new": (1, 1)})
    monkeypatch.setattr(budget, "limits", lambda: {"terms": (10, 2)})
    assert budget.excesses() == [
        "terms: 11 lines of code, the budget is 10",
        "new: has no budget in tools/budget.toml",
    ]


def test_blank_lines_comments_and_docstrings_are_not_code(budget: Any) -> None:
    module = '''"""What it is.

Said on three lines.
"""

LIMIT = 3
"""Why three."""


def double(number):  # once more
    """Return twice the number."""
    # a comment
    return (
        2 * number
    )
'''
    assert budget.lines_of_code(module) == 5
