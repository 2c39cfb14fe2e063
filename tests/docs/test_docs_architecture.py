"""The page about the architecture names each file of the mind."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "explanation" / "architecture.md").read_text(encoding="utf-8")
MIND = ROOT / "src" / "jacaros" / "agents" / "mind"


def _table(package: str) -> str:
    """The part of the page about a package."""
    return PAGE.split(f"\n`agents/mind/{package}`: ")[1].split("\n`agents/mind/")[0].split("\n## ")[0]


@pytest.mark.parametrize("package", ["state", "rules", "generated"])
def test_the_page_has_a_line_for_each_file_of_the_mind_and_no_other(package: str) -> None:
    files = {path.name for path in (MIND / package).glob("*.py")} - {"__init__.py"}
    named = {line.split("`")[1] for line in _table(package).splitlines() if line.startswith("| `")}
    assert named == files
