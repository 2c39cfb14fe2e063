"""The texts of the repository avoid phrases that do not read like a native writer's."""

from pathlib import Path

import pytest
from phrases import findings, tracked

pytestmark = pytest.mark.slow


def test_no_text_uses_a_phrase_to_avoid() -> None:
    found = [
        f"{each.path}:{each.line}: {each.phrase!r}; instead: {each.instead}" for each in findings(tracked())
    ]
    assert found == []


@pytest.mark.parametrize(
    ("name", "text", "phrase"),
    [
        ("page.md", "The failure is told to the agent.\n", "is told"),
        ("module.py", '"""Whoever calls this waits."""\n', "Whoever"),
        ("test_it.py", "def test_nobody_waits() -> None: ...\n", "nobody"),
        ("module.py", 'MESSAGE = f"{1} is no number"\n', "is no"),
    ],
)
def test_a_phrase_is_found_in_pages_docstrings_names_and_messages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str, phrase: str
) -> None:
    monkeypatch.setattr("phrases.ROOT", tmp_path)
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert [each.phrase for each in findings([path])] == [phrase]


def test_code_without_prose_is_not_searched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phrases.ROOT", tmp_path)
    path = tmp_path / "module.py"
    path.write_text("nobody = is_told = None\n", encoding="utf-8")
    assert list(findings([path])) == []
