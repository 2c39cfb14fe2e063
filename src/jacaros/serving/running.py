"""Private files that say where the runs of this user serve callers, for the console."""

import json
import os
import re
import socket
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from urllib.parse import urlsplit

from jacaros.runtime.files.texts import kept_files


@dataclass(frozen=True)
class RunningService:
    """A run that serves callers.

    Attributes:
        name: name of the project.
        pid: number of the process.
        url: where it serves.
        token: a token of an operator.
        certificate: file of the certificate, if it serves over TLS.
    """

    name: str
    pid: int
    url: str
    token: str
    certificate: str = ""

    @property
    def answers(self) -> bool:
        """Whether something listens at its address."""
        place = urlsplit(self.url)
        try:
            socket.create_connection((place.hostname or "", place.port or 0), timeout=1.0).close()
        except ConnectionError:
            return False
        except OSError:
            return True  # it is slow
        return True


def _folder() -> Path | None:
    """Return the folder of the files; None if this user has none."""
    given = os.environ.get("XDG_RUNTIME_DIR", "")
    if os.path.isabs(given):
        return Path(given) / "jacaros"
    kept = kept_files()
    return None if kept is None else kept / "running"


def write(service: RunningService) -> Path | None:
    """Write the file of a run, which only this user can read. Return its path; None if it cannot be written."""
    folder = _folder()
    if folder is None:
        return None
    path = folder / f"{re.sub(r'[^A-Za-z0-9_.-]', '_', service.name)}-{service.pid}.json"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            json.dump(asdict(service), file)
    except OSError:
        return None
    return path


def remove(path: Path) -> None:
    """Remove the file of a run."""
    with suppress(OSError):
        path.unlink()


def services() -> list[RunningService]:
    """Return the runs of this user that serve callers, the newest first. Files of dead runs are removed."""
    folder = _folder()
    found: list[tuple[float, RunningService]] = []
    for path in [] if folder is None else folder.glob("*.json"):
        try:
            age, given = path.stat().st_mtime, json.loads(path.read_text())
            service = RunningService(**given) if isinstance(given, Mapping) else None
        except (OSError, ValueError, TypeError):
            continue
        if service is not None and service.answers:
            found.append((age, service))
        else:
            remove(path)
    return [service for _, service in sorted(found, key=lambda each: each[0], reverse=True)]
