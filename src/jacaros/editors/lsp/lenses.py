"""Code lenses above clauses: run the program, run a test, ask a recording why a plan did not run."""

import gzip
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Final

from lsprotocol import types

from jacaros.agents.language import nodes
from jacaros.editors.lsp.membership import files_in
from jacaros.editors.lsp.outline import Entry
from jacaros.editors.lsp.positions import START, Positions, uri_of
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import shown_from

RUN: Final = "jacaros.run"
TEST: Final = "jacaros.test"
WHY: Final = "jacaros.why"
EXPLAIN: Final = "jacaros.explain"
"""The command of the server that answers `WHY`. The client has the others."""
_RECORDINGS: Final = (".jsonl", ".gz")
_BEGINNING: Final = b'{"kind": "world"'


def lenses(
    path: Path, entries: list[Entry], positions: Positions, is_recorded: bool
) -> Iterator[types.CodeLens]:
    """Yield the lenses of a program or project file.

    Args:
        path: of the file.
        entries: its outline.
        positions: of its text.
        is_recorded: whether there is a recording to ask.
    """
    uri = uri_of(path)
    yield types.CodeLens(START, types.Command("Run", RUN, arguments=[uri]))
    for each in entries:
        if not isinstance(each.node, nodes.Plan):
            continue
        where, label = positions.range(each.chosen), each.node.label
        if isinstance(label, nodes.Literal) and _is_test(label):
            yield types.CodeLens(where, types.Command("Test", TEST, arguments=[uri, label.functor]))
        elif is_recorded:
            arguments = [uri, each.chosen.line]
            yield types.CodeLens(where, types.Command("Why did this plan not run?", WHY, arguments=arguments))


def _is_test(label: nodes.Literal) -> bool:
    items = label.annotations.items if label.annotations is not None else ()
    return any(isinstance(each, nodes.Literal) and each.functor == "test" for each in items)


def last_recording(folders: Iterable[Path]) -> Path | None:
    """Return the newest recording in these folders, or None."""
    found = [(path.stat().st_mtime, path) for path in files_in(folders, _RECORDINGS) if _is_recording(path)]
    return max(found, default=(0.0, None))[1]


def _is_recording(path: Path) -> bool:
    """Return whether a file begins like a recording, and can be read."""
    from jacaros.look.records.line_format import MAGIC  # here: it imports much

    with suppress(EOFError, OSError), path.open("rb") as file:
        packed = file.peek().startswith(MAGIC)
        return (gzip.open(file) if packed else file).read(len(_BEGINNING)) == _BEGINNING
    return False


def explain_plan(recording: Path, program: Path, line: int) -> str:
    """Return why the plan at a line of a program did or did not run."""
    from jacaros.look.records.recording import Recording
    from jacaros.look.why.past import UNASKED
    from jacaros.look.why.why import explain

    question = f"plan {program.name}:{line}"
    try:
        answer = explain(Recording().streamed(recording, UNASKED, False), question)
    except (JacarosError, OSError) as wrong:
        return f"{shown_from(Path.cwd(), recording)}: {wrong}"
    return f"{shown_from(Path.cwd(), recording)}: {answer.text()}"
