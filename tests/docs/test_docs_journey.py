"""The journey of a message stays true: every file and every name that it mentions exists."""

import re

import pytest
from pages import ROOT, code_words

SOURCES = ROOT / "src" / "jacaros"
JOURNEY = ROOT / "docs" / "explanation" / "journey-of-a-message.md"
NAME = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")

AGENTSPEAK = {"start", "odom", "crossed", "wheels", "abortMoving"}
"""Words of the agent's program and of its messages."""


def paragraphs() -> list[str]:
    text = re.sub(r"^```.*?^```$", "", JOURNEY.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return [part.strip() for part in text.split("\n\n") if "`" in part]


def files_of(paragraph: str) -> list[str]:
    return re.findall(r"`([\w/]+\.py)`", paragraph)


def defines(source: str, name: str) -> bool:
    """Whether a module defines, or calls an operation, *name*."""
    return bool(
        re.search(
            rf"\b(?:def|class)\s+{name}\b|^\s*(?:self\.)?{name}\s*[:=]|[\"']{name}[\"']", source, re.MULTILINE
        )
    )


def mentions() -> list[tuple[str, list[str]]]:
    """Every name in code font, with the files in which it may be.

    Functions are in a file of their paragraph.  Classes, whose names are unique, may be mentioned again elsewhere.
    """
    everywhere = sorted({file for paragraph in paragraphs() for file in files_of(paragraph)})
    found = []
    for paragraph in paragraphs():
        here = files_of(paragraph)
        for word in re.findall(r"`([^`\n]+)`", paragraph):
            if NAME.fullmatch(word) and word not in AGENTSPEAK and not word.endswith(".py"):
                found.append((word, everywhere if word[0].isupper() or not here else here))
    return found


def test_the_files_of_the_journey_exist() -> None:
    files = {file for paragraph in paragraphs() for file in files_of(paragraph)}
    assert len(files) > 30
    assert sorted(file for file in files if not (SOURCES / file).is_file()) == []


@pytest.mark.parametrize(
    ("name", "files"), mentions(), ids=lambda value: value if isinstance(value, str) else ""
)
def test_a_name_of_the_journey_is_defined_where_it_says(name: str, files: list[str]) -> None:
    sources = [(SOURCES / file).read_text(encoding="utf-8") for file in files]
    parts = name.split(".")
    assert any(all(defines(source, part) for part in parts) for source in sources), f"{name} in {files}"


def test_the_journey_names_many_things() -> None:
    assert len(set(code_words(JOURNEY))) > 70
