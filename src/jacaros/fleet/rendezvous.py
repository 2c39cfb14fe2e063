"""How the members of one fleet on one computer find each other without a server: by their sockets in a folder.

The folder is private, so members of other users neither see nor reach them, and it needs no network interface at all. A
new member connects to all sockets in the folder; it keeps trying while one is frozen. A file beside its own socket is in
the folder before it looks, so of two members that start together at least one sees the other. (Zenoh replaces the file of
the socket itself.) Nothing depends on any one member.
"""

import errno
import secrets
import socket
import sys
import time
from contextlib import suppress
from pathlib import Path

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.private import private_folder

_STARTING = 10.0
"""Seconds after which a socket that refuses connections is that of a dead member; before, it may still be starting."""
_MARK = ".member"
_LONGEST = 103
"""Bytes of a path of a socket on macOS; 107 on Linux."""


def rendezvous(fleet: str) -> tuple[Path, list[Path]]:
    """Return the socket for a new member of *fleet*, and those of the others, in a folder without those of dead ones.

    Raises:
        UsageError: the system has no such folder, or its path is too long.
    """
    folder = private_folder("fleets without keys") / fleet
    folder.mkdir(mode=0o700, exist_ok=True)
    own = folder / f"{secrets.token_hex(4)}.sock"
    if len(str(own).encode()) > _LONGEST:
        raise UsageError(
            f"error: the path `{own}` is too long for a socket\n  = help: set TMPDIR to a shorter one"
        )
    mark = own.with_suffix(_MARK)
    mark.touch(mode=0o600)
    others = [each for each in sorted(folder.glob(f"*{_MARK}")) if each != mark and _is_live(each)]
    return own, [each.with_suffix(".sock") for each in others]


def _is_live(mark: Path) -> bool:
    """Return whether a member is or may be behind a socket; otherwise remove its files."""
    if sys.platform == "win32":
        return False  # there is no private folder
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.settimeout(0.1)  # a frozen member may have no place left for connections
        if probe.connect_ex(str(mark.with_suffix(".sock"))) not in (errno.ECONNREFUSED, errno.ENOENT):
            return True
    with suppress(OSError):
        if time.time() - mark.stat().st_mtime < _STARTING:
            return True
    for suffix in (".sock", ".sock.lock", _MARK):
        with suppress(OSError):
            mark.with_suffix(suffix).unlink()
    return False
