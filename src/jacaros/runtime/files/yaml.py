"""YAML with places: nodes with lines, and why a file is not YAML."""

import math
import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any, Final

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.constructor import ConstructorError, RoundTripConstructor, SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, SequenceNode

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import MOST, escaped, file_bytes, help_line, marked, printable, suggestion


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
        message = f"this {what} is never closed"
        return Problem(opened.line + 1, opened.column + 1, message, f"close the {what}")
    problem = _explained(told, line, column)
    if opened is not None and "flow" in str(error.context) and "but got '['" not in told:
        where = f"the bracket of line {opened.line + 1}, column {opened.column + 1}"
        help = "check commas, quotes and brackets"
        return Problem(line, column, f"{problem.message}, within {where}", help)
    return problem


def _explained(told: str, line: int, column: int) -> Problem:
    for pattern, message, help in _EXPLAINED:
        if (found := re.search(pattern, told)) is not None:
            parts = found.groups()
            meaning = f"not YAML: {message.format(*parts, problem=told)}"
            return Problem(line, column, meaning, help.format(*parts))
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
        message = f"the byte {data[error.start]:#04x} is not UTF-8"
        return text, Problem(line, column, message, "save the file as UTF-8")


# YAML values with their place in the file, and readers that collect errors instead of stopping at the first.
#
# World files and mapping files are read with it.


LARGEST = 1_000_000
"""Maximum number of values of a document, including those that aliases repeat."""


class YamlFileError(JacarosError):
    """A YAML file with errors; ``str()`` shows every error with its file, line, excerpt and help.

    Attributes:
        file: name of the file.
        problems: the errors, in the order of the lines.
    """

    def __init__(self, file: str, text: str, problems: list[Problem]) -> None:
        self.file = file
        self.problems = sorted(problems, key=lambda problem: (problem.line, problem.column))
        lines = text.splitlines()
        told = [shown(file, lines, problem, "error: ") for problem in self.problems[:MOST]]
        if len(self.problems) > MOST:
            told.append(f"{escaped(file)}: {len(self.problems) - MOST} more problems")
        super().__init__("\n".join(told))


def shown(file: str, lines: list[str], problem: Problem, level: str = "") -> str:
    """Return an error in the *lines* of a file as text; *level* such as ``error: `` precedes the message."""
    told = [f"{escaped(file)}:{problem.line}:{problem.column}: {level}{printable(problem.message)}"]
    if 0 < problem.line <= len(lines):
        number = f"{problem.line:>5} | "
        excerpt, caret = marked(lines[problem.line - 1], problem.column)
        told += [number + excerpt, " " * len(number) + caret]
    if problem.help:
        told.append(help_line(problem.help))
    return "\n".join(told)


class YamlNode:
    """One value of a YAML document with its place; every reader returns a usable value, even after an error.

    Attributes:
        value: as the YAML reader returns it.
        line, column: its place, counted from 1.
        problems: the document's list of errors.
    """

    __slots__ = ("column", "line", "problems", "value", "what")

    def __init__(self, value: Any, line: int, column: int, problems: list[Problem], what: str) -> None:
        self.value, self.line, self.column, self.problems, self.what = value, line, column, problems, what

    def wrong(self, message: str, help: str = "") -> None:
        """Record an error at this value."""
        self.problems.append(Problem(self.line, self.column, message, help))

    def mapping(
        self, *known: str, required: tuple[str, ...] = (), anchors: bool = False
    ) -> dict[str, "YamlNode"]:
        """Return the entries of a mapping that has only *known* keys and all *required* ones.

        With *anchors*, keys that begin with ``x-`` are free for the author, for example for values that aliases repeat.
        """
        if self.value is None:
            if required:
                self.wrong(f"{self.what} is empty", f"write its keys below it, indented: {', '.join(known)}")
            return {}
        if not isinstance(self.value, CommentedMap):
            self.wrong(f"{self.what} must be a mapping of keys to values", f"keys: {', '.join(known)}")
            return {}
        for key in self.value:
            if known and key not in known and not (anchors and str(key).startswith("x-")):
                help = suggestion(str(key), known, f"known keys: {', '.join(known)}")
                self.problems.append(Problem(*self._place(key), f"{self.what} has no key '{key}'", help))
        for key in required:
            if key not in self.value:
                self.wrong(f"{self.what} lacks the key '{key}'", f"add '{key}: ...'")
        return {str(key): self._entry(key) for key in self.value if not known or key in known}

    def _entry(self, key: object) -> "YamlNode":
        # The place of a missing value would be that of the next thing.
        place = self._place(key, at_value=self.value[key] is not None)
        return YamlNode(self.value[key], *place, self.problems, f"'{key}'")

    def _place(self, key: object, at_value: bool = False) -> tuple[int, int]:
        """Return line and column of a key or its value; those of the mapping for one that a YAML merge brought in."""
        places = self.value.lc
        if key not in (places.data or {}):
            return self.line, self.column
        line, column = places.value(key) if at_value else places.key(key)
        return line + 1, column + 1

    def entries(self) -> Iterator[tuple["YamlNode", "YamlNode"]]:
        """Yield names and values of a mapping whose keys the author chooses; nothing for a missing value."""
        if self.value is None:
            return
        if not isinstance(self.value, CommentedMap):
            self.wrong(f"{self.what} must be a mapping of names to values", "write 'name: ...' lines")
            return
        for key in self.value:
            yield YamlNode(key, *self._place(key), self.problems, "a name"), self._entry(key)

    def sequence(self) -> Iterator["YamlNode"]:
        """Yield the items of a list; a missing value is an empty list."""
        if self.value is None:
            return
        if not isinstance(self.value, CommentedSeq):
            self.wrong(f"{self.what} must be a list", "write '- item' lines or [item, item]")
            return
        for index, item in enumerate(self.value):
            line, column = self.value.lc.item(index)
            yield YamlNode(item, line + 1, column + 1, self.problems, f"item {index + 1} of {self.what}")

    def number(self, minimum: float = -math.inf, maximum: float = math.inf, default: float = 0.0) -> float:
        """Return a finite number within the limits (both included)."""
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            self.wrong(f"{self.what} must be a number, not {value!r}", "write a figure such as 0.5")
            return default
        if not minimum <= value <= maximum:
            upper = f"lie between {minimum:g} and {maximum:g}"
            limits = f"be at least {minimum:g}" if maximum == math.inf else upper
            self.wrong(f"{self.what} is {value}, but must {limits}")
            return default
        return float(value)

    def whole(self, minimum: int, default: int) -> int:
        """Return an integer, *minimum* or more."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or self.value < minimum:
            self.wrong(f"{self.what} must be a whole number of at least {minimum}, not {self.value!r}")
            return default
        return int(self.value)

    def text(self) -> str:
        """Return a string; numbers are not strings."""
        if not isinstance(self.value, str):
            self.wrong(f"{self.what} must be a text, not {self.value!r}", 'put it in quotes: "..."')
            return ""
        return str(self.value)

    def choice(self, *choices: str) -> str:
        """Return one of *choices*; the first one after an error."""
        if self.value not in choices:
            self.wrong(f"{self.what} is {self.value!r}", f"choose one of: {', '.join(choices)}")
            return choices[0]
        return str(self.value)

    def truth(self) -> bool:
        """``true`` or ``false``."""
        if not isinstance(self.value, bool):
            self.wrong(f"{self.what} must be true or false, not {self.value!r}")
            return False
        return self.value

    def pair(self) -> tuple[float, float]:
        """Return two numbers: ``[x, y]``."""
        x, y = self.numbers("two", "write [x, y], in metres", (0.0, 0.0))
        return x, y

    def numbers(self, count: str, help: str, default: Sequence[float]) -> Sequence[float]:
        """Return as many numbers as the default has; *count* is their number in a message."""
        numbers = [item.number() for item in self.sequence()]
        if len(numbers) == len(default):
            return numbers
        if isinstance(self.value, list):
            self.wrong(f"{self.what} must be {count} numbers", help)
        return default


def read_document(text: str, problems: list[Problem], what: str) -> YamlNode:
    """Parse *text*; errors that its values turn out to have are collected in *problems*.

    Text that is not YAML is an error as well, and the document is then empty.

    Args:
        text: of the file.
        problems: list for the errors.
        what: the name of the document in messages, such as ``a world``.
    """
    reader = YAML(typ="rt")
    reader.Constructor = _PlacingConstructor
    reader.allow_duplicate_keys = True  # all of them are reported below
    return YamlNode(_loaded(reader, text, problems), 1, 1, problems, what)


def plain_values(text: str) -> tuple[Any, Problem | None]:
    """Return the value of YAML with plain values (numbers, texts, lists, mappings), or its first error."""
    problems: list[Problem] = []
    reader = YAML(typ="safe", pure=True)
    reader.Constructor = _PlacingSafeConstructor
    document = _loaded(reader, text, problems)
    return document, problems[0] if problems else None


def _loaded(reader: YAML, text: str, problems: list[Problem]) -> Any:
    """Return the document; None after an error, which is added to *problems*."""
    twice: list[Problem] = []
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # YAML 1.2 allows an anchor to be given again
            composed = reader.compose(StringIO(text))
            _check(composed, twice)
            document = None if composed is None else reader.constructor.construct_document(composed)
        problems += twice
        return document
    except _Unusable as unusable:
        problems.append(unusable.problem)
    except YAMLError as error:
        problems.append(syntax_problem(error, text))
    except RecursionError:
        problems.append(_TOO_DEEP)
    return None


_TOO_DEEP: Final = Problem(1, 1, "values are nested too deeply", "close all brackets")
_DEEPEST: Final = 100
"""Maximum nesting of values; code that uses a document recurses into it."""


_TAGS: Final = frozenset(
    f"tag:yaml.org,2002:{kind}"
    for kind in ("bool", "float", "int", "map", "merge", "null", "seq", "str", "timestamp", "value")
)
"""Kinds of values; `!robot` and `!!python/object` are others."""


class _Unusable(Exception):
    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.message)
        self.problem = problem


class _Placing:
    """Makes values of nodes, and reports where a value is invalid, such as the date 2001-99-99."""

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        """Return the value of a node; called by the YAML reader."""
        try:
            return super().construct_object(node, deep)  # type: ignore[misc]
        except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError) as error:
            kind = str(node.tag).rpartition(":")[2]
            message = f"not a valid {kind}: {str(error).partition(';')[0]}"
            raise ConstructorError(None, None, message, node.start_mark) from error


class _PlacingConstructor(_Placing, RoundTripConstructor):
    """For documents whose values know their places."""


class _PlacingSafeConstructor(_Placing, SafeConstructor):
    """For plain values."""


def _check(document: Any, twice: list[Problem]) -> None:
    """Check for unknown tags, aliases inside their own values, and aliases that make the document endless.

    Keys that occur twice in one mapping are added to *twice*.

    Raises:
        _Unusable: the document has one of them.
    """
    sizes: dict[int, int] = {}
    depths: dict[int, int] = {}
    within: set[int] = set()

    def measure(node: Any) -> None:
        if id(node) in sizes:
            return
        line, column = node.start_mark.line + 1, node.start_mark.column + 1
        if node.tag not in _TAGS:
            help = "remove the tag: values have no other kinds"
            raise _Unusable(Problem(line, column, f"unknown tag `{node.tag}`", help))
        if id(node) in within:
            raise _Unusable(Problem(line, column, f"&{node.anchor} contains itself", "remove the alias"))
        within.add(id(node))
        parts = node.value if isinstance(node, SequenceNode) else []
        if isinstance(node, MappingNode):
            twice.extend(_twice(node))
            parts = [each for pair in node.value for each in pair]
        for part in parts:
            measure(part)
        within.discard(id(node))
        sizes[id(node)] = size = 1 + sum(sizes[id(part)] for part in parts)
        depths[id(node)] = depth = 1 + max((depths[id(part)] for part in parts), default=0)
        if size > LARGEST:
            raise _Unusable(Problem(line, column, f"it has more than {LARGEST} values", "use fewer aliases"))
        if depth > _DEEPEST:
            raise _Unusable(_TOO_DEEP)

    if document is not None:
        measure(document)


def _twice(mapping: MappingNode) -> Iterator[Problem]:
    """Yield the keys that occur twice in a mapping."""
    seen: dict[str, int] = {}
    for key, _ in mapping.value:
        line, column = key.start_mark.line + 1, key.start_mark.column + 1
        if isinstance(key.value, str) and key.value in seen and key.value != "<<":
            message = f"duplicate key '{key.value}', first in line {seen[key.value]}"
            yield Problem(line, column, message, "rename one of them, or remove it")
        else:
            seen[str(key.value)] = line
