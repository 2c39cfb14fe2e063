"""``jacaros port FILE.java``."""

import os
from functools import partial
from pathlib import Path

import click

from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.outputs import write_output
from jacaros.runtime.cli.usage import counted, examples, not_found, usage_error
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import file_text, is_file

_MOST_LINES = 10
"""Number of lines that a summary names."""


@click.command(
    "port",
    epilog=examples(
        "jacaros port src/env/devices/HVAC.java",
        "jacaros port RoomEnv.java -o room.py",
    ),
)
@click.argument("path", metavar="FILE.java", type=PATH)
@option(
    "-o --output FILE.py",
    "Python file to write; it must not exist (default: print it).",
    PATH,
    name="output",
)
def command(path: Path, output: Path | None) -> None:
    """Write a first Python version of the artifacts in FILE.java, or of an environment of Jason.

    Classes that it uses from other files of its folder are ported, too.

    A statement without translation becomes a comment with its line in Java, and the operation fails there.
    """  # fmt: skip
    if output is not None:
        _check(output)
    text = _read(path)
    from jacaros.porting import port  # here: it imports artifacts

    ported = port(path.name, text, partial(_beside, path))
    if output is None:
        click.echo(ported.text, nl=False)
    else:
        try:
            output.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise usage_error(
                f"cannot make `{output.parent}`: {error.strerror}", "name another folder"
            ) from error
        write_output(output, ported.text)
    done = ported.lines - len(ported.left) - len(ported.windows)
    names = ", ".join(ported.artifacts)
    click.echo(f"ported {names}: {done} of {counted(ported.lines, 'line')}", err=True)
    if ported.left:
        click.echo(f"left to you: {_listed(ported.left, path.name)}", err=True)
    if ported.windows:
        click.echo(f"left out, windows: {_listed(ported.windows, path.name)}", err=True)


def _check(output: Path) -> None:
    if os.path.exists(output):
        raise usage_error(f"`{output}` already exists", "name another file, or delete it")


def _read(path: Path) -> str:
    if path.suffix != ".java":
        raise usage_error(f"unsupported file type: `{path}`", "expected .java")
    if not is_file(path):
        raise not_found(path, (".java",))
    try:
        return file_text(path)
    except (OSError, UnicodeError) as error:
        raise JacarosError(f"cannot read `{path}`: {error}") from error


def _listed(places: list[tuple[str, int]], own: str) -> str:
    """Return lines as ranges: ``lines 3, 7-9``; those of other files after them, with their names."""
    ranges: list[tuple[str, int, int]] = []
    for file, line in sorted(places, key=lambda place: (place[0] != own, place)):
        if ranges and ranges[-1][0] == file and line == ranges[-1][2] + 1:
            ranges[-1] = (file, ranges[-1][1], line)
        else:
            ranges.append((file, line, line))
    shown = [
        (f"{first}" if first == last else f"{first}-{last}") + (f" of {file}" if file != own else "")
        for file, first, last in ranges[:_MOST_LINES]
    ]
    more = ["..."] if len(ranges) > _MOST_LINES else []
    return f"{'line' if len(places) == 1 else 'lines'} {', '.join([*shown, *more])}"


def _beside(path: Path, name: str) -> str | None:
    try:
        return file_text(path.with_name(name))
    except (OSError, ValueError):
        return None
