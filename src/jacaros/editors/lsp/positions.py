"""Places of our texts as places of an editor: lines from 0, columns in the units that were negotiated."""

from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls import uris
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import SourceFile, Span

START: Final = types.Range(types.Position(0, 0), types.Position(0, 0))
"""The beginning of any text."""


def path_of(uri: str) -> Path | None:
    """Return the file of a document; None for one that is not in a file yet."""
    found = uris.to_fs_path(uri) if uri.startswith("file:") else None
    return Path(found).resolve() if found else None


def uri_of(path: Path) -> str:
    """Return the address of a file as a client expects it."""
    return uris.from_fs_path(path.as_posix()) or path.as_uri()


class Positions:
    """Converts places in one text.

    Args:
        file: the text.
        codec: knows the client's unit of columns.
    """

    def __init__(self, file: SourceFile, codec: PositionCodec) -> None:
        self._lines, self._codec = file.lines, codec

    def to_client(self, line: int, column: int) -> types.Position:
        """Return a place that counts from 1."""
        row = max(0, line - 1)
        text = self._lines[row] if row < len(self._lines) else ""
        before = text[: max(0, column - 1)]
        return types.Position(row, len(before) if before.isascii() else self._codec.client_num_units(before))

    def range(self, span: Span) -> types.Range:
        """Return a range of the text."""
        return types.Range(
            self.to_client(span.line, span.column), self.to_client(span.end_line, span.end_column)
        )

    def from_client(self, place: types.Position) -> tuple[int, int]:
        """Return line and column, counted from 1; a place outside the text is moved to its nearest end."""
        if place.line >= len(self._lines):
            return len(self._lines), len(self._lines[-1]) + 1
        text, left, column = self._lines[place.line], place.character, 0
        while left > 0 and column < len(text):
            left -= self._codec.client_num_units(text[column])
            column += 1
        return place.line + 1, column + 1
