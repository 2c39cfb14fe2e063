"""``jacaros fleet router``."""

import asyncio
import socket
from pathlib import Path

import click

from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.usage import examples
from jacaros.runtime.clock import WallClock, run


@click.command(
    "router",
    short_help="Run a router, for networks without multicast.",
    epilog=examples("jacaros fleet router lab", "jacaros fleet router lab --listen 192.168.1.5:7447"),
)
@click.argument("fleet")
@option("--listen ADDRESS", "HOST:PORT (default: all interfaces, or 127.0.0.1 without keys; port 7447).")
@option("--router ADDRESS...", "Address of another router to connect to. Repeatable.", name="routers")
@option("--keys DIR", "Folder of the router's keys (default: ~/.config/jacaros/fleets/FLEET/router).", PATH)
def router_command(fleet: str, listen: str | None, routers: tuple[str, ...], keys: Path | None) -> None:
    """Forward messages between members of FLEET that cannot reach or find each other, until you press Ctrl+C.

    Without keys, only members on this computer can use the router.
    """  # fmt: skip
    from jacaros.fleet.keys import find_keys
    from jacaros.fleet.names import ROUTER
    from jacaros.fleet.network import Network, address_of, open_session, router_config

    network = Network(fleet, ROUTER, keys or find_keys(fleet, ROUTER), routers)
    config = router_config(network, listen)
    host, port = address_of(config)

    async def main() -> None:
        session = await asyncio.to_thread(open_session, config)
        click.echo(
            f"router of fleet {fleet}: members connect to {_reachable(host)}:{port}; press Ctrl+C to stop"
        )
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            session.close()  # type: ignore[no-untyped-call]  # the stub of Zenoh says nothing of it

    run(main, WallClock())


def _reachable(host: str) -> str:
    """Return the address at which other computers reach a router that listens on all interfaces."""
    if host not in ("[::]", "0.0.0.0"):
        return host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends nothing: it selects the interface of the default route
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])
