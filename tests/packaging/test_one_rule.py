"""A rule of the language stands once: speed is generated from it, or at its head, never written by hand beside it."""

import io
import re
import tokenize
from pathlib import Path

import pytest

AGENTS = Path(__file__).parents[2] / "src" / "jacaros" / "agents"
COPY = re.compile(r"\binlined?\b|\bwritten out\b|\b[Rr]eplaces `jacaros")
"""How a function is described that repeats another one."""
FILES = sorted(file for folder in ("terms", "language", "mind") for file in (AGENTS / folder).rglob("*.py"))


def texts(source: str) -> str:
    """Return the comments and docstrings of a module."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return "\n".join(each.string for each in tokens if each.type in (tokenize.COMMENT, tokenize.STRING))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.relative_to(AGENTS).as_posix())
def test_no_function_is_a_copy_of_another(file: Path) -> None:
    assert COPY.findall(texts(file.read_text(encoding="utf-8"))) == []


def test_a_copy_is_found() -> None:
    assert COPY.findall(texts('def f():\n    """`g` inlined for speed."""\n    # written out: g\n')) == [
        "inlined",
        "written out",
    ]
