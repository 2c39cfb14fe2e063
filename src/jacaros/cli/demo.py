"""``jacaros demo``."""

import shlex
from pathlib import Path

import click

from jacaros.cli.usage import examples, usage_error
from jacaros.cli.variables import variables

PROGRAM = Path(__file__).with_name("patrol.asl")
ROBOT = ("--world", "patrol", "--mapping", "nav2.yaml", "--mapping", "turtlebot4.yaml")
"""Options of the run: the world of the program, and the mappings of its robot."""


@click.command(
    "demo",
    context_settings={"ignore_unknown_options": True},
    short_help="Show a robot on patrol.",
    epilog=examples("jacaros demo", "jacaros demo --view=terminal", "jacaros demo --save"),
)
@click.option(
    "--save", is_flag=True, help="Write the program to patrol.asl in this folder, and do not run it."
)
@click.argument("options", nargs=-1, type=click.UNPROCESSED, metavar="[OPTIONS OF jacaros run]...")
def command(save: bool, options: tuple[str, ...]) -> int:
    """Run a robot on patrol in the embedded world, and show it on a page in the browser.

    Without a display, the terminal shows it. Press Ctrl+C to stop. Options of `jacaros run` work here, too, such as
    `--view=terminal`, `--clock fast` or `--record run.jsonl`.
    """  # fmt: skip
    if save:
        _save(Path(PROGRAM.name))
        return 0
    from jacaros.cli.pages import has_display  # here: not needed to save the program
    from jacaros.cli.run import command as run

    view = () if _has_view(options) else ("--view" if has_display() else "--view=terminal",)
    arguments = [str(PROGRAM), *ROBOT, *view, *options]
    code: int = run.main(arguments, "jacaros demo", standalone_mode=False, obj=variables())
    return code


def _has_view(options: tuple[str, ...]) -> bool:
    return any(each == "--view" or each.startswith("--view=") for each in options)


def _save(file: Path) -> None:
    try:
        with file.open("xb") as copy:
            copy.write(PROGRAM.read_bytes())
    except FileExistsError as error:
        raise usage_error(f"file exists: `{file}`", "rename it, or change to another folder") from error
    except OSError as error:
        raise usage_error(f"cannot write `{file}`: {error.strerror}", "change to another folder") from error
    click.echo(f"wrote {file}; run it with\n  jacaros run {file} {shlex.join(ROBOT)} --view")
