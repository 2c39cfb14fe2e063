"""What a request may get: access control by the token in the path, the host names and the origin, and the page's files.

The token keeps out other users and programs of the machine. Checking host names prevents DNS rebinding, in which a foreign
page reaches this server under its own name. Checking the origin stops scripts of other pages.
"""

import hmac
import ipaddress
import re
import secrets
import socket
from collections.abc import Mapping, Sequence
from urllib.parse import urlsplit

from jacaros.look.page.page import STATIC
from jacaros.runtime.errors import UsageError

LOOPBACK = "127.0.0.1"
SHORTEST_TOKEN = 16
"""Minimum length of a token chosen by the user."""
_TOKEN = re.compile(r"[A-Za-z0-9._~-]+")
_HOST = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(:[0-9]{1,5})?")
_HERE = frozenset({"127.0.0.1", "localhost", "::1"})


class Access:
    """Access rules of one server.

    Args:
        address: address that the server is bound to.
        token: token in the path; random by default.

    Attributes:
        token: token in the path.

    Raises:
        UsageError: the token is too short, or contains characters with a meaning in URLs.
    """

    def __init__(self, address: str = LOOPBACK, token: str | None = None) -> None:
        self.token = token if token is not None else secrets.token_urlsafe(24)
        if len(self.token) < SHORTEST_TOKEN or not _TOKEN.fullmatch(self.token):
            raise UsageError(
                f"error: invalid view token\n  = help: use at least {SHORTEST_TOKEN} letters, digits or any of `-._~`"
            )
        self._address = address

    @property
    def exposed(self) -> bool:
        """Whether other machines can reach the server."""
        return not _is_loopback(self._address)

    def path(self, target: str) -> str | None:
        """Return what follows the token in the target of a request, without its query; None with another token."""
        given, _, rest = target.partition("?")[0].removeprefix("/").partition("/")
        right = hmac.compare_digest(given.encode("utf-8", "replace"), self.token.encode())
        return rest if right else None

    def knows_host(self, given: Sequence[str]) -> bool:
        """Return whether the values of the header Host name this machine; the port may be that of a tunnel."""
        if len(given) != 1 or (found := _HOST.fullmatch(given[0])) is None:
            return False
        name = found[1].strip("[]").lower()
        if name in _HERE or name == self._address.lower():
            return True
        is_any = self._address in ("0.0.0.0", "::", "")
        return is_any and (_is_number(name) or name == socket.gethostname().lower())

    def knows_origin(self, given: Sequence[str], host: str) -> bool:
        """Return whether a request comes from our own page, or from a program other than a browser (no Origin)."""
        if not given:
            return True
        try:
            parts = urlsplit(given[0])
        except ValueError:
            return False
        return len(given) == 1 and parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()


def _is_loopback(address: str) -> bool:
    if address == "localhost":
        return True
    return _is_number(address) and ipaddress.ip_address(address).is_loopback


def _is_number(name: str) -> bool:
    """Return whether a host name is an IP address, which DNS cannot redirect."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


# ---- files

START = "page.html"
"""The file at the root of the address."""
_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}


class Pages:
    """The files of the page, by request path; no other file is readable."""

    def __init__(self) -> None:
        self._files = {each.name: each for each in STATIC.iterdir() if each.suffix in _TYPES}
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
