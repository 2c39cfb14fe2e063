"""Where a position of a YAML text is, whether the text parses or not: the keys around it, and those beside it.

>>> text = "robots:\\n  - name: a\\n    battery: {level: 1, dra"
>>> place_in(text)
Place(path=('robots', 0, 'battery'), key='', partial='dra')
>>> keys_in(text)[("robots", 0)]
{'name': 'a', 'battery': ''}
"""

import re
from typing import Final, NamedTuple

_KEY: Final = re.compile(r"""["']?([\w$./-]+)["']?\s*:(?=\s|$)""")
_TOKEN: Final = re.compile(r""""[^"]*"?|'[^']*'?|[][{},]|[^][{},"'\s]+|\s+""")
_COMMENT: Final = re.compile(r"(?:^|\s)#.*")
Path = tuple[str | int, ...]
"""Keys, and numbers of items of lists, from the top."""


class Place(NamedTuple):
    """Where the end of a text is.

    Attributes:
        path: of the mapping around it.
        key: whose value is written there; empty where a key is written.
        partial: the key or value so far.
    """

    path: Path
    key: str
    partial: str


class _Frame:
    """A mapping or list that is open."""

    def __init__(self, path: Path, indent: int, is_list: bool, is_flow: bool = False) -> None:
        self.path, self.indent, self.is_list, self.is_flow = path, indent, is_list, is_flow
        self.key, self.count = "", -1 + is_flow

    @property
    def inner(self) -> Path:
        """The path of what is written now."""
        return (*self.path, self.count if self.is_list else self.key)


class _Scanner:
    """Reads a text line by line."""

    def __init__(self) -> None:
        self.frames = [_Frame((), 0, is_list=False)]
        self.keys: dict[Path, dict[str, str]] = {}
        self.partial = ""

    def line(self, text: str) -> None:
        text = _COMMENT.sub("", text)
        self.partial = ""
        if self.frames[-1].is_flow:
            self._flow(text)
            return
        indent = len(text) - len(text.lstrip())
        rest = text[indent:]
        while rest == "-" or rest.startswith("- "):
            self._leave(indent, for_item=True)
            top = self.frames[-1]
            if not top.is_list:
                self.frames.append(_Frame(top.inner if top.key else top.path, indent, is_list=True))
            self.frames[-1].count += 1
            blanks = len(rest) - len(rest[1:].lstrip())
            indent, rest = indent + max(blanks, 2), rest[1:].lstrip()
        self._leave(indent)
        if not rest:
            return
        found = _KEY.match(rest)
        if found is None and rest[:1] not in "{[":
            self.partial = rest
            return
        if found is not None:
            self._enter(indent)
            self._note(found[1])
            rest = rest[found.end() :].lstrip()
        self._flow(rest)

    def _leave(self, indent: int, for_item: bool = False) -> None:
        """Close what is indented further."""
        while len(self.frames) > 1:
            top = self.frames[-1]
            ends = top.indent > indent or (top.indent == indent and top.is_list and not for_item)
            if not ends:
                return
            self.frames.pop()

    def _enter(self, indent: int) -> None:
        top = self.frames[-1]
        if top.is_list or (top.indent < indent and top.key):
            self.frames.append(_Frame(top.inner, indent, is_list=False))

    def _note(self, key: str, value: str = "") -> None:
        top = self.frames[-1]
        top.key = key
        self.keys.setdefault(top.path, {})[key] = value

    def _flow(self, text: str) -> None:
        """Read a value, or a part of one in brackets."""
        words = ""
        for token in _TOKEN.findall(text):
            top = self.frames[-1]
            if token in "{[" and not words.strip():
                inner = top.inner if top.key or top.is_list else top.path
                self.frames.append(_Frame(inner, top.indent, token == "[", is_flow=True))
            elif token in ",}]" and top.is_flow:
                self._value(words)
                words = ""
                if token == ",":
                    top.count, top.key = top.count + 1, "" if not top.is_list else top.key
                else:
                    self.frames.pop()
            elif top.is_flow and not top.is_list and not top.key and token.endswith(":"):
                self._note(token[:-1].strip("\"'"))
                words = ""
            else:
                words += token
        self._value(words)
        self.partial = words.lstrip()

    def _value(self, words: str) -> None:
        top = self.frames[-1]
        if top.key and words.strip():
            self.keys.setdefault(top.path, {})[top.key] = words.strip().strip("\"'")


def place_in(text: str) -> Place:
    """Return where the end of a text is."""
    scanner = _scanned(text)
    top, last = scanner.frames[-1], text.rpartition("\n")[2]
    indent = len(last) - len(last.lstrip())
    if top.is_flow:
        return Place(top.path if not top.is_list else top.inner, top.key, scanner.partial)
    if _KEY.search(_COMMENT.sub("", last)) is not None:
        return Place(top.path, top.key, scanner.partial)
    is_inside = top.is_list or (top.key and top.indent < indent)
    return Place(top.inner if is_inside else top.path, "", scanner.partial)


def keys_in(text: str) -> dict[Path, dict[str, str]]:
    """Return the keys of each mapping, with their values as far as these are plain."""
    return _scanned(text).keys


def _scanned(text: str) -> _Scanner:
    scanner = _Scanner()
    for line in text.split("\n"):
        scanner.line(line)
    return scanner
