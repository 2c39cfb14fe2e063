"""Names in the programs of the examples: every one is found where it is written, and renaming keeps the meaning."""

from pathlib import Path

import pytest

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Edit, Position, Symbol
from jacaros.editors.symbols.navigation import occurrence_at
from jacaros.editors.symbols.renaming import rename
from jacaros.runtime.mas.agents.programs import SourcePath

ROOT = Path(__file__).parents[3]
PROGRAMS = sorted(ROOT.glob("examples/*/*.asl"))
NEW = "quite_new_name"


def read(path: Path, texts: dict[str, str]) -> nodes.Program:
    """Return a program with its includes; *texts* replace files, and get those that were read."""
    paths = SourcePath([path.parent])

    def include(name: str, including: str) -> tuple[str, str]:
        found, text = paths.include(name, including)
        return found, texts.setdefault(found, text)

    text = texts.setdefault(path.as_posix(), path.read_text(encoding="utf-8"))
    return read_program(SourceFile(path.as_posix(), text), include)[0]


def applied(edits: list[Edit], texts: dict[str, str]) -> dict[str, str]:
    found = dict(texts)
    for span, text in sorted(edits, key=lambda each: each.span[1:], reverse=True):
        lines = found[span.file.name].split("\n")
        line = lines[span.line - 1]
        lines[span.line - 1] = line[: span.column - 1] + text + line[span.end_column - 1 :]
        found[span.file.name] = "\n".join(lines)
    return found


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda each: f"{each.parent.name}-{each.stem}")
def test_names_are_where_they_are_written_and_can_be_renamed(path: Path) -> None:
    texts: dict[str, str] = {}
    program = read(path, texts)
    index = Index()
    index.put(path.as_posix(), program)
    for each in index.in_file(path.as_posix()):
        assert occurrence_at(index, each.span.file, Position(each.span.line, each.span.column)) == each
    own = [
        each for each in index.symbols("goal", "belief") if is_own(index, each) and not index.offered(each)
    ]
    assert own
    for symbol in own[:4]:
        first = index.of(symbol)[0].span
        edits = rename(index, first.file, Position(first.line, first.column), NEW)
        other = Index()
        other.put(path.as_posix(), read(path, applied(edits, texts)))
        assert len(other.of(symbol._replace(name=NEW))) == len(index.of(symbol))
        assert other.of(symbol) == []


def is_own(index: Index, symbol: Symbol) -> bool:
    return not any(each.span.file.name.startswith("$") for each in index.of(symbol))
