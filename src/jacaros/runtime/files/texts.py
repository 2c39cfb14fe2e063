"""Texts of users: read within limits, quoted in messages, and compared for "did you mean"."""

import os
import re
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from heapq import nlargest
from itertools import islice
from pathlib import Path
from typing import Final

LARGEST: Final = 64 * 2**20
"""Maximum number of bytes of a program, project, mapping, world or parameter file."""
_FOLDER: Final = "it is a directory"
_SKIPPED: Final = frozenset({"__pycache__", "node_modules", "build", "dist"})


_unsaved: ContextVar[Mapping[str, str]] = ContextVar("unsaved")


@contextmanager
def unsaved(texts: Mapping[str, str]) -> Iterator[None]:
    """Read these texts instead of the files, in this thread or task only: an editor has not saved them.

    Args:
        texts: by the real path of the file (`os.path.realpath`). The file may be missing.
    """
    token = _unsaved.set(texts)
    try:
        yield
    finally:
        _unsaved.reset(token)


def _unsaved_text(path: Path | str) -> str | None:
    texts = _unsaved.get(None)
    return texts.get(os.path.realpath(path)) if texts else None


class UnusableFile(OSError):
    """A file that exists but cannot be used; ``str()`` says why."""


def files_below(folder: Path, suffixes: Sequence[str]) -> Iterator[Path]:
    """Return the files of these kinds in a folder and its subfolders, without hidden and generated ones, sorted."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or path.name in _SKIPPED:
            continue
        if path.is_dir():
            yield from files_below(path, suffixes)
        elif path.suffix in suffixes:
            yield path


def is_file(path: Path) -> bool:
    """Return whether a path leads to a file; False for a name that no file can have."""
    try:
        return path.is_file() or _unsaved_text(path) is not None
    except (OSError, ValueError):
        return False


def file_bytes(path: Path | str, largest: int = LARGEST) -> bytes:
    """Return the content of a regular file.

    Args:
        path: of the file.
        largest: maximum number of bytes.

    Raises:
        FileNotFoundError: it does not exist.
        UnusableFile: it is not a regular file, too large, or cannot be read.
    """
    if (text := _unsaved_text(path)) is not None:
        return text.encode("utf-8", "replace")  # an editor may send half a surrogate pair
    try:
        # A pipe without a writer, and some files of the kernel, would block.
        file = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as fault:
        if isinstance(fault, PermissionError) and os.path.isdir(path):  # Windows does not open folders
            raise UnusableFile(_FOLDER) from fault
        raise UnusableFile(getattr(fault, "strerror", None) or str(fault)) from fault
    try:
        return _content(file, largest)
    finally:
        os.close(file)


def _content(file: int, largest: int) -> bytes:
    status = os.fstat(file)
    if stat.S_ISDIR(status.st_mode):
        raise UnusableFile(_FOLDER)
    if not stat.S_ISREG(status.st_mode):
        raise UnusableFile("it is not a regular file")
    pieces: list[bytes] = []
    left = largest + 1
    try:
        while left > 0 and (piece := os.read(file, min(left, 2**20))):
            pieces.append(piece)
            left -= len(piece)
    except BlockingIOError:
        raise UnusableFile("it is not a regular file: reading it would wait") from None
    except OSError as fault:
        raise UnusableFile(fault.strerror or str(fault)) from fault
    if left <= 0:
        raise UnusableFile(f"it is larger than {largest // 2**20} MiB")
    return b"".join(pieces)


def file_text(path: Path | str, largest: int = LARGEST) -> str:
    """Return the text of a file in UTF-8, without the byte order mark that some editors put in front.

    Raises:
        FileNotFoundError: it does not exist.
        UnusableFile: as `file_bytes`.
        UnicodeError: it is not UTF-8, or contains a NUL; the message names the line.
    """
    return text_of(file_bytes(path, largest))


def text_of(data: bytes) -> str:
    """Return the content of a text file as `file_text` does.

    Raises:
        UnicodeError: it is not UTF-8, or contains a NUL; the message names the line.
    """
    at = data.find(0)
    if at >= 0:
        raise UnicodeError(f"line {_line(data, at)} contains a NUL byte; this is not a text file")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise UnicodeError(
            f"line {_line(fault.object, fault.start)} contains a byte (0x{fault.object[fault.start]:02x})"
            " that is not UTF-8; save the file as UTF-8"
        ) from fault
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def _line(data: bytes, at: int) -> int:
    return data.count(b"\n", 0, at) + 1


def shown_from(folder: Path, file: Path) -> str:
    """Return how a file in *folder* names another file: the path from there with forward slashes, on every system.

    On Windows no relative path leads to another drive; then it is the whole path.
    """
    try:
        return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return file.resolve().as_posix()


def kept_files() -> Path | None:
    """Return the folder for files that are kept between runs to save time; None to keep none.

    It is ``$JACAROS_CACHE``, by default ``jacaros`` in ``$XDG_CACHE_HOME`` or ``~/.cache``; ``JACAROS_CACHE=0`` keeps
    none.
    """
    given = os.environ.get("JACAROS_CACHE")
    if given:
        return None if given == "0" else Path(given)
    caches = os.environ.get("XDG_CACHE_HOME", "")
    try:
        return (Path(caches) if os.path.isabs(caches) else Path.home() / ".cache") / "jacaros"
    except RuntimeError:  # a user without a home
        return None


# Excerpts of files in messages: unsafe characters are escaped, and everything has a limited length.


WIDTH: Final = 100
"""Maximum number of characters of a line in an excerpt."""

LONGEST: Final = 500
"""Maximum number of characters of a message line."""

MOST: Final = 100
"""Maximum number of messages printed about one file (or one call); the rest is only counted."""

_UNSAFE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff]"
)
"""Characters that a terminal obeys or hides: control characters, direction marks, parts of surrogate pairs."""


_OBEYED: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]|\r(?!\n)"
)
"""Characters that a terminal obeys: control characters without tabs and line ends, and direction marks."""


def visible(text: str) -> str:
    r"""Return *text* with characters that a terminal obeys replaced by escapes such as ``\x1b`` and ``\u202e``.

    JSON without escapes for them stays JSON: it contains none below ``\u007f``.
    """
    return _OBEYED.sub(_escape, text)


def is_worth_a_line(count: int, more: int = 1) -> bool:
    """Return whether a repeated message is printed: it is the 1st, 10th, 100th, … or one of the *more* last ones was."""
    before = count - more
    return not before or len(str(before)) < len(str(count))


def escaped(text: str) -> str:
    r"""Return *text* with unsafe characters replaced by escapes such as ``\x1b`` and ``\u202e``."""
    return _UNSAFE.sub(_escape, text)


def _escape(found: re.Match[str]) -> str:
    code = ord(found.group())
    return f"\\x{code:02x}" if code < 0x20 else f"\\u{code:04x}"


def printable(text: str) -> str:
    """Return a message with unsafe characters escaped and each line cut to `LONGEST` characters."""
    return "\n".join(_cut(line) for line in escaped(text).split("\n"))


def _cut(line: str) -> str:
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."


def help_line(text: str) -> str:
    """Return the ``help:`` line of a message."""
    return f"  = help: {printable(text)}"


def marked(line: str, column: int, end: int | None = None) -> tuple[str, str]:
    """Return the part of a line around a place, and the carets below it.

    Args:
        line: of a file, without its end.
        column: where the carets begin, counted from 1.
        end: the column after the carets; one caret if None.
    """
    first = max(0, min(column - 1 - WIDTH // 2, len(line) - WIDTH))
    last = first + WIDTH
    begin = min(column - 1, len(line))
    before = ("..." if first else "") + escaped(line[first:begin])
    meant = escaped(line[begin : min(last, begin + 1 if end is None else end - 1)])
    behind = escaped(line[begin:last]) + ("..." if last < len(line) else "")
    # Tabs are repeated below, so that the carets are aligned at any tab width.
    indent = "".join("\t" if char == "\t" else " " for char in before)
    return before + behind, indent + "^" * max(1, len(meant))


# Suggestions for unknown names: the one rule for "did you mean", and for how similar two names must be.


ALIKE: Final = 0.66
"""Least similarity of two names, from 0 to 1 (`difflib.SequenceMatcher.ratio`): a slip in a name of three letters."""
MOST_KNOWN: Final = 2000
"""Maximum number of names that one name is compared with: comparing is slow."""
_PARTS: Final = re.compile("[./:]+")


def close_matches(name: str, known: Iterable[str], most: int = 1) -> list[str]:
    """Return the known names most similar to *name*, the most similar first; none that is less than `ALIKE`."""
    candidates = islice(dict.fromkeys(known), MOST_KNOWN)
    found = nlargest(most, ((_similarity(name, each), each) for each in candidates))
    return [each for similarity, each in found if similarity >= ALIKE]


def _similarity(name: str, other: str) -> float:
    """Return how similar two names are: as their least similar parts, so that a common package counts for nothing."""
    parts, others = _PARTS.split(name), _PARTS.split(other)
    if len(parts) != len(others):
        return _likeness(name, other)
    return min(
        1.0 if one.isdigit() and two.isdigit() else _likeness(one, two)
        for one, two in zip(parts, others, strict=True)
    )


def _likeness(name: str, other: str) -> float:
    from difflib import SequenceMatcher  # here: only mistakes need it

    matcher = SequenceMatcher(None, other, name)
    if other.startswith(f"{name}_"):
        return max(ALIKE, matcher.ratio())
    for limit in (matcher.real_quick_ratio, matcher.quick_ratio):  # quick upper limits
        if limit() < ALIKE:
            return 0.0
    return matcher.ratio()


class Suggestion(str):
    """The question for names that may be meant, for an editor that writes one of them.

    Attributes:
        names: the names that may be meant.
    """

    names: tuple[str, ...] = ()


def did_you_mean(names: Iterable[str], otherwise: str = "") -> str:
    """Return the question for *names* that may be meant; without any, *otherwise*."""
    meant = tuple(names)
    if not meant:
        return otherwise
    listed = " or ".join(f"`{name}`" for name in meant)
    question = Suggestion(f"did you mean {listed}?")
    question.names = meant
    return question


def suggestion(name: str, known: Iterable[str], otherwise: str = "", most: int = 1) -> str:
    """Return the help for an unknown name: the *known* names that may be meant; without any, *otherwise*."""
    return did_you_mean(close_matches(name, known, most), otherwise)


def aside(name: str, known: Iterable[str]) -> str:
    """Return a suggestion of at most three names as the end of a message, ``; did you mean …?``; empty without any."""
    found = suggestion(name, known, most=3)
    return f"; {found}" if found else ""
