"""Files and folders that a command line names."""

import difflib
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from jacaros.errors import UsageError
from jacaros.text_files import is_file

if TYPE_CHECKING:
    from jacaros.inspector.recording import Recording

_KINDS = (".asl", ".mas2j", ".jcm")


def no_programs(named: Iterable[Path]) -> UsageError:
    """The error of folders in which nothing is found: to look at nothing and be content would hide a wrong path."""
    return UsageError(f"no agent programs in {', '.join(map(str, named))}")


def existing(path: Path, kinds: tuple[str, ...] = _KINDS) -> Path:
    """*path*, which must be a folder or a file of one of *kinds*.

    Raises:
        UsageError: it is not; with the names of similar files beside it.
    """
    if path.is_dir():
        return path
    if not is_file(path):
        beside = [each.name for each in path.parent.glob("*.*") if each.suffix in kinds]
        near = difflib.get_close_matches(path.name, beside, n=2)
        help = f"; did you mean {' or '.join(str(path.parent / name) for name in near)}?" if near else ""
        raise UsageError(f"file not found: {path}{help}")
    if path.suffix not in kinds:
        raise UsageError(f"unsupported file type: {path} (expected {', '.join(kinds)})")
    return path


def read_recording(path: Path) -> "Recording":
    """Read a recording of any name; what is wrong with it, but can be left out, is printed as warnings.

    Raises:
        UsageError: it does not exist or is a folder; with the names of similar files beside it.
        JacarosError: it is not a recording.
        OSError: it cannot be read.
    """
    if path.is_dir():
        raise UsageError(f"error: `{path}` is a folder\n  = help: name a recording in it")
    if not is_file(path):
        beside = [each.name for each in path.parent.glob("*.*") if _RECORDINGS.intersection(each.suffixes)]
        near = difflib.get_close_matches(path.name, beside, n=1)
        help = f"did you mean `{path.parent / near[0]}`?" if near else f"jacaros run FILE --record {path}"
        raise UsageError(f"error: recording not found: `{path}`\n  = help: {help}")
    from jacaros.inspector.recording import Recording  # here: numpy and the simulator come with it

    recording = Recording.read(path)
    for warning in recording.warnings:
        click.echo(f"warning: {warning}", err=True)
    return recording


_RECORDINGS = {".jsonl", ".gz"}
"""Suffixes that recordings usually have."""
