"""Who may reach a server of a run: host names and origins of requests.

Checking host names prevents DNS rebinding, in which a foreign page reaches this server under its own name. Checking the
origin stops scripts of other pages.
"""

import ipaddress
import re
import socket
from collections.abc import Sequence
from urllib.parse import urlsplit

from jacaros.runtime.errors import UsageError

LOOPBACK = "127.0.0.1"
SHORTEST_TOKEN = 16
"""Minimum length of a token chosen by the user."""
_TOKEN = re.compile(r"[A-Za-z0-9._~-]+")
_HOST = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(:[0-9]{1,5})?")
_HERE = frozenset({"127.0.0.1", "localhost", "::1"})


def listening_socket(what: str, address: str, port: int, help: str, backlog: int = 64) -> socket.socket:
    """Return a listening socket; port 0 selects a free port.

    Args:
        what: what is served, for the message.
        help: how to choose another address.

    Raises:
        UsageError: the address is not an address of this machine, or the port is in use.
    """
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    try:
        found = socket.create_server((address, port), family=family, backlog=backlog)
    except (OSError, OverflowError) as error:
        # Python 3.11 repeats the address after the reason.
        why = (
            str(error.strerror).partition(" (while")[0]
            if isinstance(error, OSError)
            else "the port must be in 0 to 65535"
        )
        raise UsageError(f"error: cannot serve {what} at {address}:{port}: {why}\n  = help: {help}") from None
    # Connections inherit it. asyncio does not set it for sockets of the protocol 0, as here, and then a response waits
    # 40 ms between header and body.
    found.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return found


def is_token(text: str) -> bool:
    """Return whether a text can be a token: it is long enough, and has no characters with a meaning in URLs."""
    return len(text) >= SHORTEST_TOKEN and _TOKEN.fullmatch(text) is not None


class Hosts:
    """Host names and origins that requests to one server may name.

    Args:
        address: address that the server is bound to.
    """

    def __init__(self, address: str = LOOPBACK) -> None:
        self._address = address

    @property
    def exposed(self) -> bool:
        """Whether other machines can reach the server."""
        return not _is_loopback(self._address)

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
