"""The files of the page, and responses to plain HTTP requests."""

from collections.abc import Mapping
from pathlib import Path

STATIC = Path(__file__).parent.parent / "static"
START = "page.html"
"""The file at the root of the address."""
_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}


class Pages:
    """The files below one folder, by request path; no other file is readable.

    Args:
        folder: folder with the files.
    """

    def __init__(self, folder: Path = STATIC) -> None:
        self._files = {
            each.relative_to(folder).as_posix(): each for each in folder.rglob("*") if each.suffix in _TYPES
        }
        self._read: dict[str, bytes] = {}

    def find(self, path: str) -> tuple[str, bytes] | None:
        """Return the media type and the content of a file; None for an unknown path."""
        path = path or START
        file = self._files.get(path)
        if file is None:
            return None
        if path not in self._read:
            self._read[path] = file.read_bytes()
        return _TYPES[file.suffix], self._read[path]


def security_headers(host: str) -> Mapping[str, str]:
    """Return the headers of every response: no caching, framing, type guessing, or loading from other sites."""
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        f"connect-src 'self' ws://{host} wss://{host}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    return {
        "Content-Security-Policy": policy,
        "Cache-Control": "no-store",
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
    }
