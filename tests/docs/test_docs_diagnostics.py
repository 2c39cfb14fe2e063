"""The page about diagnostics: every code, with a program that triggers it and one that triggers nothing."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from pages import ROOT, blocks

from jacaros.agents.language.diagnostics import LEVELS as LEVEL_OF
from jacaros.runtime.cli.main import call

PAGE = ROOT / "docs" / "reference" / "diagnostics.md"
BETTER = "// better:\n"


def _examples() -> Iterator[tuple[str, str, str]]:
    """Yield kind (`wrong` or `right`), code and text of each program of the page."""
    for block in blocks(PAGE):
        kind, _, code = block.purpose.partition(" ")
        if kind in ("wrong", "right"):
            text, better, right = block.text.partition(BETTER)
            yield kind, code, text
            if better:
                yield "right", code, right


EXAMPLES = list(_examples())
OF_FILES = {
    *(
        "goal-never-posted",
        "not-imported",
        "too-many",
        "no-effect",
        "plan-too-large",
        "unknown-artifact-type",
    ),
    *(
        "unknown-message-type",
        "unknown-operation",
        "unknown-property",
        "unknown-resource",
        "unreadable-file",
        "unbound-argument",
        "unfocused-artifact",
    ),
    *("wrong-mapping", "wrong-world", "wrong-project"),
}
TOO_LONG = {"nested-too-deeply"}
LEVELS = {"Errors": "error", "Warnings": "warning", "Notes": "note"}


def test_every_code_has_its_section_under_its_level() -> None:
    level = ""
    described = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        level = LEVELS.get(line.removeprefix("## "), level) if line.startswith("## ") else level
        if line.startswith("### "):
            described[line.removeprefix("### ")] = level
    assert described == {code: kind for code, kind in LEVEL_OF.items() if code not in OF_FILES}
    assert all(f"`{code}`" in PAGE.read_text(encoding="utf-8") for code in OF_FILES)


def test_every_code_has_examples() -> None:
    shown = {(kind, code) for kind, code, _ in EXAMPLES}
    for code in set(LEVEL_OF) - OF_FILES:
        assert ("right", code) in shown
        assert ("wrong", code) in shown or code in TOO_LONG


@pytest.mark.parametrize(("kind", "code", "text"), EXAMPLES)
def test_an_example_gives_its_code_and_nothing_else(
    kind: str, code: str, text: str, tmp_path: Path, monkeypatch, capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("other.asl").write_text("sum(X, Y, X + Y).\n", encoding="utf-8")
    Path("example.asl").write_text(text, encoding="utf-8")
    assert told(capsys) == ([(code, LEVEL_OF[code])] if kind == "wrong" else [])


def test_nesting_has_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (limit,) = re.findall(r"At most (\d+) levels", PAGE.read_text(encoding="utf-8"))
    for depth, expected in ((int(limit), ["nested-too-deeply"]), (int(limit) - 2, [])):
        Path("example.asl").write_text(f"p({'(' * depth}1{')' * depth}).", encoding="utf-8")
        assert [code for code, _ in told(capsys)] == expected


def told(capsys: pytest.CaptureFixture[str]) -> list[tuple[str, str]]:
    """Return code and level of the diagnostics of example.asl."""
    call(["check", "example.asl", "--format", "json"])
    return [(each["code"], each["level"]) for each in json.loads(capsys.readouterr().out)["diagnostics"]]
