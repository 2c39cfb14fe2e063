"""Explain why a file is not YAML, or not text at all, in the terms of people who write YAML files."""

import re
from dataclasses import dataclass
from pathlib import Path

from ruamel.yaml.error import MarkedYAMLError, YAMLError

from jacaros.text_files import file_bytes


@dataclass(frozen=True, slots=True)
class Problem:
    """One error: where (line and column count from 1), what, and how to fix it."""

    line: int
    column: int
    message: str
    help: str = ""


_TOP_KEY = re.compile(r"^([\w-]+)[ \t]*:", re.MULTILINE)
_QUOTES = 'put texts with such characters in quotes: "..."'
_INDENT = "begin it in the same column as its siblings, or further right than its parent"
_EXPLAINED = (
    (
        r"but got '\['",
        "a bracket within a text of a list",
        'write a text with brackets in quotes: "ranges[0]"',
    ),
    (r"character '\\t'", "a tab in the indent", "indent with spaces"),
    (r"cannot start any token|unknown escape", "{problem}", _QUOTES),
    (
        r"expected <block end>, but found '([\]}])'",
        "unmatched bracket",
        "remove it",
    ),
    (r"expected <block end>|<document start>", "the indent fits none of the lines above", _INDENT),
    (
        r"mapping values are not allowed",
        "a second ':', or an indent that fits none of the lines above",
        'check the indent; put texts that contain ": " in quotes',
    ),
    (r"could not find expected ':'", "a key without ':'", "write it as key: value"),
    (
        r"undefined alias '(.*)'",
        "unknown anchor &{0}",
        "mark the value with &{0}, further up",
    ),
    (r"another document", "a second document begins here", "remove ---, or make two files"),
    (
        r"for merging",
        "<< merges the keys of a mapping, and this is not a mapping",
        "write <<: *name of an anchor",
    ),
    (r"unacceptable character", "invalid character", "save the file as text in UTF-8"),
)
"""Patterns of the parser's messages, what they mean, and how to fix them."""


def syntax_problem(error: YAMLError, text: str) -> Problem:
    """Explain why *text* cannot be parsed."""
    if not isinstance(error, MarkedYAMLError):
        position = getattr(error, "position", 0)
        before = text[: position if isinstance(position, int) else 0]
        return _explained(str(error), before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1)
    mark, opened, told = error.problem_mark or error.context_mark, error.context_mark, str(error.problem)
    line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
    if opened is not None and ("<stream end>" in told or "end of stream" in told):
        what = "quote" if "scalar" in str(error.context) else "bracket"
        return Problem(
            opened.line + 1, opened.column + 1, f"this {what} is never closed", f"close the {what}"
        )
    problem = _explained(told, line, column)
    if opened is not None and "flow" in str(error.context) and "but got '['" not in told:
        where = f"the bracket of line {opened.line + 1}, column {opened.column + 1}"
        return Problem(
            line, column, f"{problem.message}, within {where}", "check commas, quotes and brackets"
        )
    return problem


def _explained(told: str, line: int, column: int) -> Problem:
    for pattern, message, help in _EXPLAINED:
        if (found := re.search(pattern, told)) is not None:
            parts = found.groups()
            return Problem(
                line, column, f"not YAML: {message.format(*parts, problem=told)}", help.format(*parts)
            )
    return Problem(line, column, f"not YAML: {told.splitlines()[0]}", "check indents, colons and quotes")


def top_keys(path: Path) -> frozenset[str]:
    """Return the keys of a file's outermost mapping that are in block style; none of an unreadable file.

    This identifies kinds of YAML files without parsing them, also if they have errors.
    """
    try:
        return frozenset(_TOP_KEY.findall(read_text(path)[0]))
    except OSError:
        return frozenset()


def read_text(path: Path) -> tuple[str, Problem | None]:
    """Return the text of a file, and the place where it is not UTF-8.

    Raises:
        OSError: it cannot be read.
    """
    data = file_bytes(path)
    try:
        return data.decode("utf-8-sig"), None
    except UnicodeDecodeError as error:
        text = data.decode("utf-8", "replace")
        wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
        if wide or b"\0" in data:
            what = "the file is in UTF-16" if wide else "the file is not text"
            return "", Problem(1, 1, what, "save it as UTF-8" if wide else "give a YAML file")
        before = data[: error.start].decode("utf-8", "replace")
        line, column = before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1
        return text, Problem(
            line, column, f"the byte {data[error.start]:#04x} is not UTF-8", "save the file as UTF-8"
        )
