"""Errors of wrong usage, files named on the command line, and the examples at the end of help texts."""

import gc
import os
import sys
from collections.abc import Container, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import close_matches, did_you_mean, help_line, is_file, printable, suggestion

if TYPE_CHECKING:
    from jacaros.look.records.recording import Recording

_PROGRAMS = (".asl", ".mas2j", ".jcm")
_RECORDINGS = {".jsonl", ".gz"}
"""Usual suffixes of recordings."""
_MOST_NAMES = 8


def usage_error(what: str, help: str = "") -> UsageError:
    """Return the error for a wrong command line.

    Args:
        what: what is wrong, with names in backquotes.
        help: what to write instead; empty for no advice.
    """
    lines = [f"error: {printable(what)}"]
    if help:
        lines.append(help_line(help))
    return UsageError("\n".join(lines))


def in_our_form(wrong: click.ClickException) -> UsageError:
    """Return an error of click in the form of all other errors."""
    path = wrong.ctx.command_path if isinstance(wrong, click.UsageError) and wrong.ctx else "jacaros"
    overview = f"`{path} --help` lists the options"
    if isinstance(wrong, click.NoSuchOption):
        known = [opt for each in wrong.ctx.command.params for opt in each.opts] if wrong.ctx else []
        return usage_error(
            f"unknown option: `{wrong.option_name}`", suggestion(wrong.option_name, known, overview, 3)
        )
    if isinstance(wrong, click.MissingParameter) and wrong.param is not None:
        is_option = isinstance(wrong.param, click.Option)
        name = (
            wrong.param.opts[0] if is_option else wrong.param.make_metavar(click.Context(click.Command("")))
        )
        return usage_error(f"missing {'option' if is_option else 'argument'}: `{name}`", overview)
    place = f"{wrong.param.opts[0]}: " if isinstance(wrong, click.BadParameter) and wrong.param else ""
    text = wrong.message if place else wrong.format_message()
    return usage_error(f"{place}{text[:1].lower()}{text[1:].rstrip('.')}", overview)


def examples(*commands: str) -> str:
    """Return the end of a help text: commands to copy, one a line."""
    return "\n".join(["\b", "Examples:", *(f"  {command}" for command in commands)])


def listed(names: Iterable[object]) -> str:
    """Return the first names of many, for a message."""
    every = list(map(str, names))
    return ", ".join(every[:_MOST_NAMES]) + (", ..." if len(every) > _MOST_NAMES else "")


def counted(number: int, what: str, plural: str = "") -> str:
    """Return a number of things as text: ``1 file``, ``2 files``."""
    return f"{number} {what if number == 1 else plural or f'{what}s'}"


def has_colours() -> bool:
    """Return whether to colour the output: it is a terminal, and NO_COLOR is not set."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def no_programs(named: Iterable[Path]) -> UsageError:
    """Return the error for folders without programs: success would hide a wrong path."""
    return usage_error(f"no agent programs in {', '.join(f'`{path}`' for path in named)}")


def existing(path: Path, kinds: tuple[str, ...] = _PROGRAMS) -> Path:
    """Return *path*, a folder or a file with one of the suffixes *kinds*.

    Raises:
        UsageError: the file does not exist (the error suggests similar names), or has another suffix.
    """
    if os.path.isdir(path):
        return path
    if not is_file(path):
        raise not_found(path, kinds)
    if path.suffix not in kinds:
        raise usage_error(f"unsupported file type: `{path}`", f"expected {', '.join(kinds)}")
    return path


def not_found(path: Path, kinds: tuple[str, ...]) -> UsageError:
    """Return the error for a missing file: files beside it that may be meant, first one of the same stem."""
    beside = [each for each in path.parent.glob("*.*") if each.suffix in kinds]
    same = [str(each) for each in beside if each.stem == path.name]
    near = same or close_matches(str(path), map(str, beside), 2)
    return usage_error(f"file not found: `{path}`", did_you_mean(near))


def read_recording(path: Path) -> "Recording":
    """Read a recording, whatever its suffix; print a warning for each part that is skipped because it is damaged.

    Raises:
        UsageError: the file does not exist (the error suggests similar names), or is a folder.
        JacarosError: the file is not a recording.
        OSError: the file cannot be read.
    """
    from jacaros.look.records.recording import Recording  # here: it imports numpy and the simulator

    recording = Recording()
    with no_gc():
        recording.events.extend(recorded_events(path, recording))
    return recording


def recorded_events(
    path: Path, into: "Recording", without: Container[str] = (), is_plain: bool = True
) -> Iterator[tuple[float, str, Any]]:
    """Read a recording like `read_recording`, and yield its events, which *into* does not keep (`Recording.streamed`)."""
    if os.path.isdir(path):
        raise usage_error(f"`{path}` is a folder", "name a recording in it")
    if not is_file(path):
        beside = [str(each) for each in path.parent.glob("*.*") if _RECORDINGS.intersection(each.suffixes)]
        help = suggestion(str(path), beside, f"jacaros run FILE --record {path}")
        raise usage_error(f"recording not found: `{path}`", help)
    yield from into.streamed(path, without, is_plain)
    for warning in into.warnings:
        click.echo(f"warning: {warning}", err=True)


@contextmanager
def no_gc() -> Iterator[None]:
    """Do not look for cycles, of which a recording has none: it takes a third of the time."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
