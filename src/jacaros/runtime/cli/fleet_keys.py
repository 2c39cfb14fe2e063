"""``jacaros fleet keys``."""

from pathlib import Path

import click

from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.usage import examples


@click.command(
    "keys",
    short_help="Create the keys of a fleet.",
    epilog=examples("jacaros fleet keys lab robot1 robot2 desk"),
)
@click.argument("fleet")
@click.argument("members", nargs=-1, metavar="[MEMBER]...")
@option("--folder DIR", "Folder of the keys (default: ~/.config/jacaros/fleets/FLEET).", PATH)
def keys_command(fleet: str, members: tuple[str, ...], folder: Path | None) -> None:
    """Create the keys of MEMBERs, with which they reach each other over a network.

    Each member gets a folder to copy to its computer, under the same path. So do routers (`router`), and you for commands
    such as `jacaros fleet list` (`operator`). The folder `authority` stays on this computer: you add members with it later.
    Existing keys are kept. Members ignore other members that are not in their file `members.txt`.
    """  # fmt: skip
    from jacaros.fleet.authority import create_keys, members_in  # here: it imports cryptography
    from jacaros.fleet.keys import MEMBERS, fleet_folder

    place = fleet_folder(fleet) if folder is None else folder
    before = members_in(place)
    for name in create_keys(place, fleet, members):
        click.echo(f"created {place / name}")
    known = members_in(place)
    click.echo(f"members of fleet {fleet}: {', '.join(known) or 'none'}")
    if before and before != known:
        click.echo(
            f"copy {MEMBERS} of {', '.join(before)} and router to their computers again, and restart them"
        )
