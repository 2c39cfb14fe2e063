"""``jacaros world show|export``: pictures of worlds, and their maps."""

import sys
from pathlib import Path

import click

from jacaros.robots.world.data.world import WorldDescription
from jacaros.robots.world.files.world import load_world
from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.outputs import check_output, write_output
from jacaros.runtime.cli.usage import counted, examples, usage_error
from jacaros.runtime.output import beneath

_WIDTH = 640
"""Width of a picture, in pixels."""
_ROWS = 48
"""Height of a picture in characters when the output is not a terminal, in lines."""


@click.group("world")
def command() -> None:
    """Show and export world files.

    WORLD is a world file, a map file of ROS's map_server, or the name of a shipped world.
    """  # fmt: skip


@command.command(
    "show",
    short_help="Draw a world in the terminal, or as SVG.",
    epilog=examples("jacaros world show house", "jacaros world show world.yaml --output world.svg"),
)
@click.argument("world")
@option("--output FILE.svg", "Write a picture to FILE.svg.", PATH)
def show_command(world: str, output: Path | None) -> None:
    """Draw WORLD in the terminal, with docks, closed doors and robots, or write a picture of it."""
    if output is None:
        _draw(load_world(world))
        return
    if output.suffix.lower() != ".svg":
        raise usage_error(
            f"expected a file name with the suffix .svg, found `{output}`",
            f"--output {output.with_suffix('.svg')}",
        )
    check_output(output, "picture")
    from jacaros.look.page.picture import picture_svg  # here: only for pictures
    from jacaros.look.records.recording import Recording

    _write(output, picture_svg(Recording(world=load_world(world).drawing()), _WIDTH))


@command.command(
    "export",
    short_help="Write a world as a map for ROS's map_server.",
    epilog=examples("jacaros world export house house_map.yaml"),
)
@click.argument("world")
@click.argument("file", metavar="FILE.yaml", type=PATH)
def export_command(world: str, file: Path) -> None:
    """Write the map of WORLD to FILE.yaml and FILE.pgm, in the format of ROS's map_server. Doors are open in the map."""
    if file.suffix not in (".yaml", ".yml"):
        raise usage_error(
            f"expected a file name with the suffix .yaml, found `{file}`",
            f"name it {file.with_suffix('.yaml')}",
        )
    image = file.with_suffix(".pgm")
    check_output(file, "map")
    check_output(image, "map image")
    from jacaros.robots.world.files.map import map_of_world

    text, pixels = map_of_world(load_world(world), image.name)
    _write(file, text)
    _write(image, pixels)


def _summary(world: WorldDescription) -> str:
    left, bottom, right, top = world.bounds
    parts = {
        "room": world.rooms,
        "wall": world.segments,
        "door": world.doors,
        "dock": world.docks,
        "robot": world.robots,
    }
    listed = [counted(len(things), what) for what, things in parts.items()]
    if world.people:
        listed.append(counted(len(world.people), "person", "people"))
    return f"{world.name}: {right - left:g} x {top - bottom:g} m, {', '.join(listed)}"


def _draw(world: WorldDescription) -> None:
    from jacaros.look.page.scene import views_of
    from jacaros.look.page.terminal_console import TerminalConsole  # here: it imports rich
    from jacaros.look.page.terminal_view import TerminalView
    from jacaros.robots.world import World

    height = None if sys.stdout.isatty() else _ROWS + 2 * len(world.robots)
    console = TerminalConsole(file=beneath(sys.stdout), height=height)
    view = TerminalView(console, wall=lambda: 0.0)
    view.world(world.drawing())
    view.frame(0.0, views_of(World(world)))
    console.print(view.map())
    click.echo(_summary(world))


def _write(path: Path, content: str | bytes) -> None:
    write_output(path, content)
    click.echo(f"wrote {path}")
