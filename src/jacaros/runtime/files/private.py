"""The folder of the user's sockets, which no other user of the computer can access."""

import os
import stat
import sys
import tempfile
from pathlib import Path

from jacaros.runtime.errors import UsageError


def private_folder(purpose: str) -> Path:
    """Return the folder, with mode 700.

    Args:
        purpose: what goes through it, for the message.

    Raises:
        UsageError: it belongs to another user, others can access it, or the system has no such folders.
    """
    if sys.platform == "win32":
        raise UsageError(f"error: {purpose} need Unix sockets, which Python lacks on Windows")
    folder = Path(tempfile.gettempdir()) / f"jacaros-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise UsageError(f"{folder}: expected a folder of yours with mode 700; {purpose} go through it")
    return folder
