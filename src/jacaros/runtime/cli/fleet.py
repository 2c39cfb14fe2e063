"""``jacaros fleet``: the systems of a fleet, its router and its keys."""

import click

from jacaros.runtime.cli.fleet_keys import keys_command
from jacaros.runtime.cli.fleet_router import router_command


@click.group("fleet", short_help="Set up a fleet: keys and routers.")
def command() -> None:
    """Connect systems on several computers as a fleet."""


command.add_command(keys_command)
command.add_command(router_command)
