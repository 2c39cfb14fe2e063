"""Read files: regular files of a limited size; never devices, pipes or endless ones."""

import os
import stat
from itertools import takewhile
from pathlib import Path, PurePath, PurePosixPath
from typing import Final

LARGEST: Final = 64 * 2**20
"""Maximum number of bytes of a program, project, mapping, world or parameter file."""
_FOLDER: Final = "it is a directory"


class UnusableFile(OSError):
    """A file that exists but cannot be used; ``str()`` says why."""


def is_file(path: Path) -> bool:
    """Return whether a path leads to a file; False for a name that no file can have."""
    try:
        return path.is_file()
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
    return path_between(folder.resolve(), file.resolve())


def path_between(folder: PurePath, file: PurePath) -> str:
    """Return what `shown_from` returns, for absolute paths without symbolic links."""
    pairs = zip(folder.parts, file.parts, strict=False)
    common = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
    if not common:
        return file.as_posix()
    return PurePosixPath(*[".."] * (len(folder.parts) - common), *file.parts[common:]).as_posix()


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
