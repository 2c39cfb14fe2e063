"""``jacaros world check|show|new|export``: world files."""

import sys
from pathlib import Path

import click

from jacaros.cli.outputs import check_output, wrong_output
from jacaros.errors import UsageError
from jacaros.sim.description import WorldDescription, WorldError

_IMAGES = (".pgm", ".png")
_WIDTH = 640
"""Pixels of a picture."""
_RESOLUTION = 0.05
"""Metres per pixel of an image without a map file."""
_ROWS = 48
"""Height of a text picture without a terminal, in lines."""


@click.group("world", short_help="Check, show, make and export world files.")
def command() -> None:
    """Check, show, make and export world files.

    WORLD is the path of a world file, of a map of ROS's map_server, or the name of a shipped world.
    """  # fmt: skip


@command.command("check", short_help="Report all mistakes of world files.")
@click.argument("worlds", metavar="WORLD...", nargs=-1, required=True)
def check_command(worlds: tuple[str, ...]) -> int:
    """Report all mistakes of each WORLD, or a summary. The exit code is 1 if there is a mistake."""
    from jacaros.sim.files.world import load_world  # here: YAML takes its time to load

    code = 0
    for name in worlds:
        try:
            click.echo(_summary(load_world(name)))
        except WorldError as wrong:
            click.echo(str(wrong))
            code = 1
    return code


@command.command("show", short_help="Draw a world in the terminal, or as SVG or PNG.")
@click.argument("world")
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write a picture to FILE.svg or FILE.png.",
)
@click.option(
    "--width",
    type=click.IntRange(100, 10_000),
    default=_WIDTH,
    show_default=True,
    help="Pixels of the picture.",
)
def show_command(world: str, output: Path | None, width: int) -> None:
    """Draw WORLD in the terminal, with docks, closed doors and robots; or write a picture of it."""
    from jacaros.sim.files.world import load_world

    if output is None:
        _draw(load_world(world))
        return
    kind = output.suffix.lower()
    if kind not in (".svg", ".png"):
        raise wrong_output(
            f"not the name of an SVG or PNG picture: `{output}`", f"--output {output.with_suffix('.svg')}"
        )
    check_output(output, "picture")
    from jacaros.inspector.picture import picture_svg  # here: only for pictures
    from jacaros.inspector.recording import Recording

    svg = picture_svg(Recording(world=load_world(world).drawing()), width)
    _write(output, svg if kind == ".svg" else _png(svg))


def _png(svg: str) -> bytes:
    """An SVG picture as PNG."""
    try:
        from resvg_py import svg_to_bytes  # here: an extra, and only for PNG
    except ImportError:
        raise UsageError(
            "error: resvg, which draws PNG pictures, is not installed\n  = help: pip install 'jacaros[maps]', or "
            "--output FILE.svg"
        ) from None
    # The font that nearly every Linux has; elsewhere resvg's own choice is there.
    font = "DejaVu Sans" if sys.platform == "linux" else None
    return bytes(svg_to_bytes(svg_string=svg, background="white", sans_serif_family=font))


@command.command("new", short_help="Write a new world file.")
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--map",
    "map_file",
    type=click.Path(path_type=Path),
    metavar="MAP",
    help="Build the world on a map: a file of ROS's map_server (.yaml) or its image (.pgm, .png).",
)
@click.option(
    "--resolution",
    type=click.FloatRange(0.001, 10.0),
    metavar="M",
    help="Metres per pixel, with an image (default: 0.05).",
)
def new_command(file: Path, map_file: Path | None, resolution: float | None) -> None:
    """Write FILE, a commented world file to start from: two rooms, or the walls of a map.

    For an image alone, FILE_map.yaml is written too; its lower left corner is the origin. No file is overwritten.
    """  # fmt: skip
    if resolution is not None and (map_file is None or map_file.suffix not in _IMAGES):
        raise UsageError(
            "error: --resolution is for the image of a map\n  = help: --map MAP.pgm --resolution 0.05"
        )
    from jacaros.sim.files.template import described_map, new_world, world_of_map

    described, files = map_file, [file]
    if map_file is not None and map_file.suffix in _IMAGES:
        described = file.with_name(f"{file.stem}_map.yaml")
        files.append(described)
    _refuse_existing(files)
    if map_file is not None and described is not None and described != map_file:
        _write(described, described_map(map_file, described, resolution or _RESOLUTION))
    _write(file, new_world(file.stem) if described is None else world_of_map(file, described))


@command.command("export", short_help="Write a world as a map of ROS's map_server.")
@click.argument("world")
@click.argument("file", metavar="FILE.yaml", type=click.Path(path_type=Path))
def export_command(world: str, file: Path) -> None:
    """Write the map of WORLD as FILE.yaml and FILE.pgm, as ROS's map_server reads them; doors are open in it."""
    if file.suffix not in (".yaml", ".yml"):
        raise wrong_output(f"not the name of a map: `{file}`", f"name it {file.with_suffix('.yaml')}")
    image = file.with_suffix(".pgm")
    check_output(file, "map")
    check_output(image, "map image")
    from jacaros.sim.files.map import map_of_world
    from jacaros.sim.files.world import load_world

    text, pixels = map_of_world(load_world(world), image.name)
    _write(file, text)
    _write(image, pixels)


def _summary(world: WorldDescription) -> str:
    left, bottom, right, top = world.bounds
    parts = [
        _count(len(world.rooms), "room"),
        _count(len(world.segments), "wall"),
        _count(len(world.doors), "door"),
        _count(len(world.docks), "dock"),
        _count(len(world.robots), "robot"),
    ]
    if world.people:
        parts.append(f"{len(world.people)} {'person' if len(world.people) == 1 else 'people'}")
    return f"{world.name}: {right - left:g} x {top - bottom:g} m, {', '.join(parts)}"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _draw(world: WorldDescription) -> None:
    from rich.console import Console  # here: only for pictures in the terminal

    from jacaros.inspector.scene import views_of
    from jacaros.inspector.terminal_view import TerminalView
    from jacaros.sim import World

    console = Console() if sys.stdout.isatty() else Console(height=_ROWS + 2 * len(world.robots))
    view = TerminalView(console, wall=lambda: 0.0)
    view.world(world.drawing())
    view.frame(0.0, views_of(World(world)))
    console.print(view.map())
    click.echo(_summary(world))


def _refuse_existing(paths: list[Path]) -> None:
    for path in paths:
        if path.exists():
            raise wrong_output(
                f"file exists, and is not overwritten: `{path}`", "name another file, or delete it"
            )
        if path.suffix not in (".yaml", ".yml"):
            raise wrong_output(
                f"not the name of a world file: `{path}`", f"name it {path.with_suffix('.yaml')}"
            )


def _write(path: Path, content: str | bytes) -> None:
    try:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise wrong_output(f"cannot write `{path}`: {error.strerror}", "name another file") from error
    click.echo(f"wrote {path}")
