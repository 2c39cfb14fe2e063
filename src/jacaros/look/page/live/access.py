"""What a request may get: access control by the token in the path, and the page's files.

The token keeps out other users and programs of the machine.
"""

import hmac
import secrets
from collections.abc import Mapping

from jacaros.look.page.page import STATIC
from jacaros.runtime.errors import UsageError
from jacaros.serving.access import LOOPBACK, SHORTEST_TOKEN, Hosts, is_token


class Access(Hosts):
    """Access rules of one server.

    Args:
        address: address that the server is bound to.
        token: token in the path; random by default.
        framed: whether other pages may show this one in a frame, as editors do in a tab.

    Attributes:
        token, framed: as given.

    Raises:
        UsageError: the token is too short, or contains characters with a meaning in URLs.
    """

    def __init__(self, address: str = LOOPBACK, token: str | None = None, framed: bool = False) -> None:
        super().__init__(address)
        self.framed = framed
        self.token = token if token is not None else secrets.token_urlsafe(24)
        if not is_token(self.token):
            raise UsageError(
                f"error: invalid view token\n  = help: use at least {SHORTEST_TOKEN} letters, digits or any of `-._~`"
            )

    def path(self, target: str) -> str | None:
        """Return what follows the token in the target of a request, without its query; None with another token."""
        given, _, rest = target.partition("?")[0].removeprefix("/").partition("/")
        right = hmac.compare_digest(given.encode("utf-8", "replace"), self.token.encode())
        return rest if right else None


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


def security_headers(host: str, framed: bool = False) -> Mapping[str, str]:
    """Return the headers of every response: no caching, framing, type guessing, or loading from other sites.

    *framed*: allow framing by any page. The origin of an editor's tab is not known beforehand; only a page that knows the
    token can frame this one.
    """
    ancestors = "*" if framed else "'none'"
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        f"connect-src 'self' ws://{host} wss://{host}; base-uri 'none'; form-action 'none'; "
        f"frame-ancestors {ancestors}"
    )
    return {
        **({} if framed else {"X-Frame-Options": "DENY"}),
        "Content-Security-Policy": policy,
        "Cache-Control": "no-store",
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
    }
