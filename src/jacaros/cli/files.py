"""Files and folders named on the command line."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from jacaros.cli.usage import usage_error
from jacaros.errors import UsageError
from jacaros.files.texts import close_matches, did_you_mean, is_file, suggestion

if TYPE_CHECKING:
    from jacaros.inspector.recording import Recording

_KINDS = (".asl", ".mas2j", ".jcm")


def no_programs(named: Iterable[Path]) -> UsageError:
    """Return the error for folders without programs: success would hide a wrong path."""
    return usage_error(f"no agent programs in {', '.join(f'`{path}`' for path in named)}")


def existing(path: Path, kinds: tuple[str, ...] = _KINDS) -> Path:
    """Return *path*, a folder or a file with one of the suffixes *kinds*.

    Raises:
        UsageError: the file does not exist (the error suggests similar names), or has another suffix.
    """
    if path.is_dir():
        return path
    if not is_file(path):
        raise not_found(path, [each for each in path.parent.glob("*.*") if each.suffix in kinds])
    if path.suffix not in kinds:
        raise usage_error(f"unsupported file type: `{path}`", f"expected {', '.join(kinds)}")
    return path


def not_found(path: Path, beside: Iterable[Path]) -> UsageError:
    """Return the error for a missing file: those *beside* it that may be meant, first one of the same stem."""
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
    if path.is_dir():
        raise usage_error(f"`{path}` is a folder", "name a recording in it")
    if not is_file(path):
        beside = [str(each) for each in path.parent.glob("*.*") if _RECORDINGS.intersection(each.suffixes)]
        help = suggestion(str(path), beside, f"jacaros run FILE --record {path}")
        raise usage_error(f"recording not found: `{path}`", help)
    from jacaros.inspector.recording import Recording  # here: it imports numpy and the simulator

    recording = Recording.read(path)
    for warning in recording.warnings:
        click.echo(f"warning: {warning}", err=True)
    return recording


_RECORDINGS = {".jsonl", ".gz"}
"""Usual suffixes of recordings."""
