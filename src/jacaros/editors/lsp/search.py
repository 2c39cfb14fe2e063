"""Search the parts of all programs and projects below the open folders by their names."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.lsp.membership import PROGRAM
from jacaros.editors.lsp.outline import Entry, outline_of
from jacaros.editors.lsp.positions import Positions, uri_of
from jacaros.runtime.files.texts import file_text, files_below, unsaved
from jacaros.runtime.mas.checks.files import PROJECTS

_MOST: Final = 500


def search(
    roots: Iterable[Path], query: str, texts: Mapping[Path, str], codec: PositionCodec
) -> list[types.WorkspaceSymbol]:
    """Return the parts whose names contain the letters of the query in this order, at most 500."""
    found: list[types.WorkspaceSymbol] = []
    with unsaved({str(path): text for path, text in texts.items()}):
        for path in _files(roots):
            try:
                file = SourceFile(path.as_posix(), file_text(path))
            except (OSError, UnicodeError):
                continue
            positions = Positions.of(file, codec)
            for entry in _all(outline_of(file)):
                if fits(query, entry.name):
                    where = types.Location(uri_of(path), positions.range(entry.chosen))
                    found.append(
                        types.WorkspaceSymbol(where, entry.name, entry.kind, container_name=path.name)
                    )
                    if len(found) == _MOST:
                        return found
    return found


def fits(query: str, name: str) -> bool:
    """Return whether a name contains the letters of a query in this order, in any case."""
    letters = iter(name.lower())
    return all(letter in letters for letter in query.lower())


def _files(roots: Iterable[Path]) -> Iterator[Path]:
    for root in roots:
        try:
            yield from files_below(root, (PROGRAM, *PROJECTS))
        except OSError:  # a folder that others must not read
            continue


def _all(entries: Iterable[Entry]) -> Iterator[Entry]:
    for each in entries:
        yield each
        yield from _all(each.children)
