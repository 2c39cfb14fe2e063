"""A formatted text as edits of the lines that change, so that an editor keeps its cursor and its marks."""

from collections.abc import Iterator
from difflib import SequenceMatcher

from lsprotocol import types

from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.formatting import format_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.errors import InternalError


def formatting(file: SourceFile) -> list[types.TextEdit]:
    """Return the edits that format a program; none if it has errors."""
    try:
        after = format_program(file.name, file.text, STANDARD)
    except (AslError, InternalError):  # the diagnostics say what is wrong
        return []
    return list(_edits(file.text.split("\n"), after.split("\n")))


def _edits(before: list[str], after: list[str]) -> Iterator[types.TextEdit]:
    for kind, first, last, begin, end in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind == "equal":
            continue
        lines = after[begin:end]
        if last < len(before):
            where = types.Range(types.Position(first, 0), types.Position(last, 0))
            yield types.TextEdit(where, "".join(f"{line}\n" for line in lines))
        elif first:  # the last line has no end: change the one before it
            where = types.Range(_end(first - 1), _end(last - 1))
            yield types.TextEdit(where, "".join(f"\n{line}" for line in lines))
        else:
            yield types.TextEdit(types.Range(types.Position(0, 0), _end(last - 1)), "\n".join(lines))


def _end(line: int) -> types.Position:
    """Return the end of a line: the protocol moves a column beyond it back."""
    return types.Position(line, 2**31 - 1)
