"""``jacaros fleet``: the systems of a fleet, its router and its keys."""

import click

from jacaros.runtime.cli.fleet_keys import keys_command
from jacaros.runtime.cli.fleet_list import list_command, ping_command, stop_command
from jacaros.runtime.cli.fleet_router import router_command


@click.group("fleet", short_help="Look at a fleet, and set up its keys and routers.")
def command() -> None:
    """Connect systems on several computers as a fleet, look at its members, and stop them."""


for each in (list_command, ping_command, stop_command, keys_command, router_command):
    command.add_command(each)
