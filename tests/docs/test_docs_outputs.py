"""Every example with an output prints exactly that output."""

import difflib
from pathlib import Path

import pytest
from examples import examples, run, shown
from pages import PAGES, ROOT, name_of

WITH_OUTPUT = [page for page in PAGES if any(examples(page))]


@pytest.mark.parametrize("page", WITH_OUTPUT, ids=name_of)
def test_examples_print_the_output_shown(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    wrong = []
    for example in examples(page):
        result = run(example, tmp_path)
        expected = (example.output, example.errors)
        found = shown(result)
        if found != expected or (result.exit_code and not example.errors):
            wrong.append(f"{name_of(page)}:{example.line}\n" + _difference(expected, found))
    assert not wrong, "\n\n".join(wrong)


def _difference(expected: tuple[str, str], found: tuple[str, str]) -> str:
    return "\n".join(
        line
        for kind, wanted, printed in zip(("output", "errors"), expected, found, strict=True)
        for line in difflib.unified_diff(
            wanted.split("\n"), printed.split("\n"), f"{kind} on the page", f"{kind} of the run", lineterm=""
        )
    )


def test_the_reference_of_the_language_has_examples() -> None:
    folders = (ROOT / "docs" / "reference" / "language", ROOT / "docs" / "reference" / "internal_actions")
    for folder in folders:
        for page in folder.glob("*.md"):
            assert page.name == "index.md" or page in WITH_OUTPUT, f"{name_of(page)} has no example"
