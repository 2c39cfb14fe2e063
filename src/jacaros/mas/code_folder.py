"""Generated code in a folder of the user: programs that have run before start without compilation."""

import marshal
import os
import stat
import sys
import threading
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import MAGIC_NUMBER
from pathlib import Path
from threading import Thread

from jacaros.asl.nodes import Plan
from jacaros.bdi.engines import is_plain
from jacaros.text_files import kept_files
from jacaros.version import VERSION

LARGEST = 64 << 20
"""Maximum size of the folder in bytes. The least recently used files are removed first."""
PATIENCE = 1.0
"""Maximum number of seconds that the end of a run waits for a disk."""
_DECIDING = ("terms", "asl", "bdi")
"""The packages whose sources decide which code is generated."""
_OF_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_DIGEST = 32


def code_folder() -> "CodeFolder | None":
    """Return the user's folder ``plans`` in `kept_files`; None if nothing is to be kept, or nothing is compiled.

    Windows keeps nothing: its files have no owners in Python, so nothing there can be trusted.
    """
    root = None if is_plain() or sys.platform == "win32" else kept_files()
    return None if root is None else CodeFolder(root / "plans")


class CodeFolder:
    """One file for each program. Its name is a hash of the text of the program, the sources of the generator and the
    version of Python, so any change leads to a new file.

    The contents are executed. So a folder or file that belongs to another user, or that others may write, is ignored; an
    incomplete file, too. Disk errors are not reported: the program is compiled as without the folder.

    Args:
        path: path of the folder, created on demand.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._programs: dict[Path, ProgramCode] = {}
        self._writers: list[Thread] = []

    def of_program(self, plans: Iterable[Plan]) -> "ProgramCode":
        """Return the code of a program. It is read now, so that no agent waits for a disk later."""
        files = {plan.span.file for plan in plans if plan.span is not None}
        text = repr(sorted((file.name, file.text) for file in files))
        path = self.path / sha256(_own_build() + text.encode()).hexdigest()
        if path not in self._programs:
            self._programs[path] = ProgramCode(_read(path) if _is_own(self.path) else {})
        return self._programs[path]

    def write(self) -> None:
        """Begin to write new code in a thread, so that agents do not wait for a disk."""
        changed = {path: code.taken() for path, code in self._programs.items() if code.changed}
        if changed:
            writer = Thread(target=self._write, args=(changed,), daemon=True)
            writer.start()
            self._writers.append(writer)

    def close(self) -> None:
        """Write new code, waiting at most `PATIENCE` seconds for the disk."""
        self.write()
        for writer in self._writers:
            writer.join(PATIENCE)

    def _write(self, changed: dict[Path, dict[bytes, bytes]]) -> None:
        with suppress(OSError):
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
            if _is_own(self.path):
                for path, entries in changed.items():
                    _replace(path, entries)
                _remove_oldest(self.path)


class ProgramCode:
    """The code of one program, in memory. See `jacaros.bdi.state.engine.CodeCache`.

    Attributes:
        changed: whether something was put since it was `taken`.
    """

    def __init__(self, entries: dict[bytes, bytes]) -> None:
        self._entries = entries
        self.changed = False

    def get(self, key: bytes) -> bytes | None:
        """Return the entry of a key, or None."""
        return self._entries.get(key)

    def put(self, key: bytes, entry: bytes) -> None:
        self._entries[key] = entry
        self.changed = True

    def taken(self) -> dict[bytes, bytes]:
        """Return a copy of all entries, to be written."""
        self.changed = False
        return dict(self._entries)


@cache
def _own_build() -> bytes:
    return build(Path(__file__).parent.parent)


def build(root: Path) -> bytes:
    """Return what determines the code besides the program:

    Python, and the sources of the generator in the package *root*.
    """
    digest = sha256(repr((VERSION, sys.version, sys.implementation.cache_tag, sys.flags.optimize)).encode())
    digest.update(MAGIC_NUMBER)
    for package in _DECIDING:
        for source in sorted((root / package).rglob("*.py")):
            digest.update(repr(str(source.relative_to(root))).encode() + source.read_bytes())
    return digest.digest()


def _is_own(path: Path) -> bool:
    """Return whether a folder belongs to the user, and others cannot write it."""
    try:
        return _trusted(path.stat())
    except OSError:
        return False


def _trusted(status: os.stat_result) -> bool:
    return sys.platform != "win32" and status.st_uid == os.geteuid() and not status.st_mode & _OF_OTHERS


def _read(path: Path) -> dict[bytes, bytes]:
    """Return the entries in a file; empty if it is missing, incomplete or not trusted."""
    if sys.platform == "win32":
        return {}
    try:
        with open(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
            status = os.fstat(file.fileno())
            if not (_trusted(status) and stat.S_ISREG(status.st_mode) and status.st_size <= LARGEST):
                return {}
            data = file.read()
        if data[:_DIGEST] != _seal(path, data[_DIGEST:]):
            return {}
        with suppress(OSError):
            os.utime(path)  # for `_remove_oldest`
        entries: dict[bytes, bytes] = marshal.loads(data[_DIGEST:])
    except OSError:
        return {}
    return entries


def _replace(path: Path, entries: dict[bytes, bytes]) -> None:
    """Write a file atomically: other processes see the old one or the new one.

    Raises:
        OSError: it cannot be written.
    """
    if sys.platform == "win32":
        return
    body = marshal.dumps(entries)
    # Unique to this process and thread.
    aside = path.with_suffix(f".{os.getpid()}-{threading.get_ident()}.part")
    try:
        with open(os.open(aside, os.O_CREAT | os.O_WRONLY | os.O_TRUNC | os.O_NOFOLLOW, 0o600), "wb") as file:
            file.write(_seal(path, body) + body)
        os.replace(aside, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(aside)
        raise


def _seal(path: Path, body: bytes) -> bytes:
    """Return a checksum that shows that a file is complete and has its own name."""
    return sha256(path.name.encode() + body).digest()


def _remove_oldest(folder: Path) -> None:
    """Remove files until the folder is within `LARGEST` bytes."""
    files = []
    for entry in os.scandir(folder):
        with suppress(OSError):  # another process has removed it
            status = entry.stat(follow_symlinks=False)
            files.append((status.st_mtime, status.st_size, entry.path))
    total = 0
    for _, size, path in sorted(files, reverse=True):
        total += size
        if total > LARGEST:
            with suppress(OSError):
                os.unlink(path)
