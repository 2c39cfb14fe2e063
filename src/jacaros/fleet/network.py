"""How the members of a fleet reach each other: the configuration of Zenoh's session of each.

Without keys, only members of the same user on the same computer reach each other, over Unix sockets. With keys, members
listen on all interfaces, with mutual TLS, and find each other by multicast. A member with routers connects to one of them
alone, and everything goes through it: Zenoh's routers do not forward between peers, which they expect to reach each other.
"""

import json
import re
import socket
import zlib
from dataclasses import dataclass
from ipaddress import ip_address
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.fleet.access import access_rules
from jacaros.fleet.keys import CA, CERTIFICATE, KEY, NO_EXTRA, Keys, read_keys
from jacaros.fleet.names import ROUTER, check_name
from jacaros.fleet.rendezvous import rendezvous
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.texts import help_line, printable

if TYPE_CHECKING:
    import zenoh

PORT = 7447
"""Default port of routers."""
LARGEST_MESSAGE = 64 << 20
"""Bytes. Larger messages are dropped where they arrive."""
_SCOUTING_PORT = 7446
_KEEP_ALIVES = 4
"""Signs of life in a lease."""
_RETRY = {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 2.0}
"""How soon a router, or a member on the same computer, that does not answer is tried again."""
_ESTABLISHED = 3000
"""Milliseconds within which a stranger that connects must have shown its certificate."""


class NoRouter(JacarosError):
    """None of a member's routers answers. The text says why, for each address."""


@dataclass(frozen=True, slots=True)
class Network:
    """What a member needs to know to join its fleet.

    Attributes:
        fleet: name of the fleet.
        member: name of the member, unique in the fleet.
        keys: folder of the member's keys; None: only this user on this computer.
        routers: addresses of routers, such as ``192.168.1.5:7447``, by default at port 7447. One of them is used at a time.
        listen: port for members of other computers; None: any free one. Only with keys, without routers.
        lease: seconds without a sign of life after which a member is lost.
    """

    fleet: str
    member: str
    keys: Path | None = None
    routers: tuple[str, ...] = ()
    listen: int | None = None
    lease: float = 2.0

    def __post_init__(self) -> None:
        check_name("fleet", self.fleet)
        if self.member != ROUTER:
            check_name("member", self.member)
        if self.listen is not None and self.routers:
            raise UsageError(
                "error: a member that uses routers does not listen\n  = help: omit the port, or the routers"
            )


def session_config(network: Network) -> "zenoh.Config":
    """Return the configuration of a member's session.

    Each call is for one new session: without keys it also creates the name of the session's socket.

    Raises:
        UsageError: keys do not fit, the address of a router is invalid or needs keys, or Zenoh is not installed.
    """
    keys = None if network.keys is None else read_keys(network.keys, network.fleet, network.member)
    if network.routers:
        return _config("client", network, keys, [], _endpoints(network))
    if keys is not None:
        return _config("peer", network, keys, [f"tls/{_anywhere()}:{network.listen or 0}"], [])
    own, others = rendezvous(network.fleet)
    return _config("peer", network, None, [_socket(own)], [_socket(each) for each in others])


def router_config(network: Network, address: str | None = None) -> "zenoh.Config":
    """Return the configuration of a router's session.

    Args:
        network: of a fleet. Without keys, members of this computer alone can use the router.
        address: to listen on; None: port 7447, with keys on all interfaces.

    Raises:
        UsageError: as `session_config`.
    """
    keys = None if network.keys is None else read_keys(network.keys, network.fleet, ROUTER)
    address = address or f"{'127.0.0.1' if keys is None else _anywhere()}:{PORT}"
    return _config("router", network, keys, [_endpoint(address, keys is not None)], _endpoints(network))


def address_of(router: "zenoh.Config") -> tuple[str, str]:
    """Return host and port on which the router of a configuration listens."""
    host, _, port = _shown(json.loads(router.get_json("listen/endpoints"))[0]).rpartition(":")
    return host, port


def open_session(config: "zenoh.Config") -> "zenoh.Session":
    """Open a session. Blocks for up to half a second, with routers for three seconds.

    Later, a session that loses its router keeps trying to connect.

    Raises:
        NoRouter: no router answers; try again later.
        UsageError: the session cannot listen where it should.
    """
    import zenoh

    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        why = _reason(str(error))
    if json.loads(config.get_json("mode")) == "client":
        routers = [_shown(each) for each in json.loads(config.get_json("connect/endpoints"))]
        raise NoRouter("; ".join(f"{each}: {_silence(each)}" for each in routers))
    where = " and ".join(map(_shown, json.loads(config.get_json("listen/endpoints"))))
    help = "another program may use the port: `ss -ltnp` lists them"
    raise UsageError(f"error: cannot listen on {where}: {why}\n{help_line(help)}")


def _config(
    mode: str, network: Network, keys: Keys | None, listen: list[str], connect: list[str]
) -> "zenoh.Config":
    try:
        import zenoh
    except ImportError:
        raise UsageError(NO_EXTRA) from None
    settings = _settings(network, keys is not None) | {
        "mode": mode,
        "listen/endpoints": listen,
        "connect/endpoints": connect,
        "connect/timeout_ms": 0
        if mode == "client"
        else -1,  # for ever: in the background, which a client cannot
        "connect/exit_on_failure": mode == "client",
    }
    if keys is not None:
        settings |= _secured(network, keys)
    config = zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


def _settings(network: Network, secured: bool) -> dict[str, Any]:
    protocols = ["tls"] if secured else ["unixsock-stream", "tcp"]
    return {
        "connect/retry": _RETRY,
        "scouting/multicast/enabled": secured,
        "adminspace/enabled": False,
        "plugins_loading/enabled": False,
        "transport/shared_memory/enabled": False,
        "transport/unicast/open_timeout": _ESTABLISHED,
        "transport/unicast/accept_timeout": _ESTABLISHED,
        "transport/link/protocols": protocols,
        "transport/link/tx/lease": round(network.lease * 1000),
        "transport/link/tx/keep_alive": _KEEP_ALIVES,
        "transport/link/rx/max_message_size": LARGEST_MESSAGE,
    }


def _secured(network: Network, keys: Keys) -> dict[str, Any]:
    return {
        "scouting/multicast/address": _scouting_address(network.fleet),
        "scouting/multicast/interface": ",".join(name for _, name in socket.if_nameindex()),
        "transport/link/tls": {
            "root_ca_certificate": keys.path(CA),
            "enable_mtls": True,
            "listen_certificate": keys.path(CERTIFICATE),
            "listen_private_key": keys.path(KEY),
            "connect_certificate": keys.path(CERTIFICATE),
            "connect_private_key": keys.path(KEY),
            "verify_name_on_connect": False,  # the addresses of robots change; the authority is the fleet's own
            "close_link_on_expiration": True,
        },
        "access_control": access_rules(network.fleet, keys.members),
    }


def _scouting_address(fleet: str) -> str:
    """Return a multicast group for each fleet: members of two fleets in one network need not refuse each other."""
    mark = zlib.crc32(fleet.encode())
    return f"239.255.{mark >> 8 & 255}.{mark & 255}:{_SCOUTING_PORT}"


def _anywhere() -> str:
    return "[::]" if socket.has_dualstack_ipv6() else "0.0.0.0"


def _socket(path: Path) -> str:
    return f"unixsock-stream/{path}"


def _address(text: str) -> str:
    """Return an address as HOST:PORT."""
    host, colon, port = text.rpartition(":")
    if not colon or text.endswith("]"):
        host, port = text, str(PORT)
    bare = host.removeprefix("[").removesuffix("]")
    plain = host == bare and ":" not in host
    if (
        not bare
        or "/" in bare
        or not (plain or host == f"[{bare}]")
        or not (port.isdecimal() and 0 < int(port) < 65536)
    ):
        help = "write HOST or HOST:PORT, such as 192.168.1.5:7447 or [fd00::5]:7447"
        raise UsageError(f"error: invalid address: `{printable(text)}`\n{help_line(help)}")
    return f"{host}:{port}"


def _endpoints(network: Network) -> list[str]:
    return [_endpoint(each, network.keys is not None) for each in network.routers]


def _endpoint(text: str, secured: bool) -> str:
    """Return the endpoint of an address, which must be one of this computer if it is not secured by keys."""
    address = _address(text)
    host = address.rpartition(":")[0].strip("[]")
    if not (secured or host == "localhost" or _is_loopback(host)):
        raise UsageError(
            f"error: {printable(text)}: a fleet without keys stays on its computer\n"
            f"{help_line('create keys: `jacaros fleet keys FLEET MEMBER...`')}"
        )
    return f"{'tls' if secured else 'tcp'}/{address}"


def _silence(address: str) -> str:
    """Return why no router answers at an address."""
    host, _, port = address.rpartition(":")
    try:
        socket.create_connection((host.strip("[]"), int(port)), 1.0).close()
    except OSError as error:
        return (error.strerror or "no answer").lower()
    return "what answers there is not a router of this fleet, or has keys of another authority"


def _reason(text: str) -> str:
    """Return what went wrong, without the places in Zenoh's code that its errors name."""
    by_system = re.search(r"(\w[^:\[\]]*) \(os error \d+\)", text)
    return printable(by_system[1].lower() if by_system else re.sub(r" at \S+:\d+\.", "", text))


def _shown(endpoint: str) -> str:
    return endpoint.partition("/")[2]


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False
