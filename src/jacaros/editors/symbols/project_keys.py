"""Keys of project files, by the tables that read them, and the names that their values refer to."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.editors.symbols.model import Completion, Position
from jacaros.robots.registry import BUILT_IN
from jacaros.robots.world.files.world import shipped_worlds
from jacaros.runtime.mas.project.cursor import ProjectCursor, ProjectToken
from jacaros.runtime.mas.project.jcm import BLOCKS, JcmReader
from jacaros.runtime.mas.project.mas2j import Mas2jReader

_REFERS: Final = {
    "focus": "artifact",
    "join": "workspace",
    "parent": "workspace",
    "focused-by": "agent",
    "agents": "agent",
    "node": "node",
}
"""Keys whose values are names that the file declares, with the keyword of the declaration."""
_FORMS: Final = {
    "agent": "agent ${1:name} : ${2:program.asl}",
    "workspace": "workspace ${1:name} {\n    $0\n}",
    "artifact": "artifact ${1:name} : ${2:Type}($0)",
    "node": "node ${1:name}",
}


_WORDS: Final = {"verbose": ("0", "1", "2"), "platform": ("cartago", "local")}


def project_completions(file: SourceFile, at: Position) -> list[Completion]:
    """Return the keys, keywords and names that can be written at a position of a project file."""
    offset = sum(len(each) + 1 for each in file.text.split("\n")[: at.line - 1]) + at.column - 1
    tokens = [each for each in ProjectCursor(file, []).tokens if each.kind != "end"]
    before = [each for each in tokens if each.start < offset]
    prefix = ""
    if before and before[-1].stop >= offset and before[-1].kind in ("word", "string"):
        prefix = file.text[before.pop().start : offset]
    replaces = Span(file, at.line, at.column - len(prefix), at.line, at.column)
    value = _key_of_value(before)
    words = _keys(file, before) if value is None else dict.fromkeys(_names(value, tokens))
    return [
        Completion(word, "key" if value is None else "value", insert or word, replaces)
        for word, insert in words.items()
        if word.startswith(prefix.strip('"'))
    ]


def _key_of_value(before: Sequence[ProjectToken]) -> str | None:
    """Return the key, or the keyword of the declaration, whose value is written after these tokens; None for none."""
    for number in range(len(before) - 1, 0, -1):
        token = before[number]
        if token.kind == ":":
            is_declared = number > 1 and before[number - 2].text in _FORMS
            return before[number - 2 if is_declared else number - 1].text
        if token.kind != "," and before[number - 1].kind not in (",", ":"):
            return None
    return None


def _names(key: str, tokens: Sequence[ProjectToken]) -> Iterator[str]:
    """Yield what a value can be."""
    if key == "artifact":
        yield from BUILT_IN
    elif key == "world":
        yield from shipped_worlds()
    yield from _WORDS.get(key, ())
    for keyword, name in pairwise(tokens):
        if keyword.text == _REFERS.get(key) and name.kind == "word":
            yield name.text


def _keys(file: SourceFile, before: Sequence[ProjectToken]) -> dict[str, str]:
    """Return what begins an entry, with the text to insert."""
    if not file.name.endswith(".jcm"):
        return {each: f"{each}: " for each in Mas2jReader.sections} if _depth(before) == 1 else {}
    block = BLOCKS.get(_owner(before))
    outside = JcmReader.sections if _depth(before) == 1 else ()
    names = outside if block is None else (*block.keys, *block.entries)
    return {each: _FORMS.get(each, f"{each}: ") for each in names}


def _depth(before: Sequence[ProjectToken]) -> int:
    return sum((each.kind == "{") - (each.kind == "}") for each in before)


def _owner(before: Sequence[ProjectToken]) -> str:
    """Return the keyword of the declaration whose block is open."""
    closed = 0
    for number in range(len(before) - 1, -1, -1):
        kind = before[number].kind
        closed += (kind == "}") - (kind == "{")
        if closed < 0:
            keywords = [
                each.text for each in before[:number] if each.text in (*BLOCKS, "mas") and each.kind == "word"
            ]
            return keywords[-1] if keywords else ""
    return ""
