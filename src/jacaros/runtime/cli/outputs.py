"""Output files and pages of a run, and checks that they can be written."""

import os
import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from jacaros.agents.language.offers import OPERATOR
from jacaros.runtime.cli.usage import usage_error

OUTPUT_GONE = 141
"""Exit code when the reader of the output is gone, as in ``| head``: 128 plus the number of SIGPIPE."""
LOOPBACK = "127.0.0.1"
RECORD_LIMIT = 500
"""Default size limit of a recording, in megabytes."""

_BEGINNINGS = {
    "recording": (b'{"kind": "', b"\x1f\x8b\x08"),
    "replay page": (b"<!doctype html>",),
    "ground truth": (b'{"kind": "',),
    "picture": (b"<svg",),
    "MCAP file": (b"\x89mcap0",),
    "layout": (b'{\n "configbyid"',),
    "map": (b"image:",),
    "map image": (b"p5",),
}
"""First bytes of each kind of file: files that begin otherwise are not overwritten."""


@dataclass(frozen=True, slots=True)
class RequestedOutputs:
    """The outputs requested on the command line, by the names of the options.

    Attributes:
        record: file for the recording, or None.
        replay: file for the replay page, or None.
        ground_truth: file for the ground truth of the world, or None.
        view: ``page`` (in the browser), ``terminal``, or None for no view.
        view_address, view_port, view_token, view_role, view_in_frame: where to serve the page, what it may do, and whether
            other pages may frame it; see `jacaros.look.page.live.run_view.RunView`.
        record_limit: size limit of the recording, in megabytes.
    """

    record: Path | None = None
    replay: Path | None = None
    ground_truth: Path | None = None
    view: str | None = None
    view_address: str = LOOPBACK
    view_port: int = 0
    view_token: str | None = None
    view_role: str = OPERATOR
    view_in_frame: bool = False
    record_limit: int = RECORD_LIMIT

    @classmethod
    def taken_from(cls, options: dict[str, Any]) -> "RequestedOutputs":
        """Take the outputs out of the options of a command."""
        return cls(**{each.name: options.pop(each.name) for each in fields(cls)})

    @property
    def any(self) -> bool:
        """Whether any output is requested."""
        return any((self.view, self.record, self.replay, self.ground_truth))

    def check(self) -> None:
        """Check before the run that all outputs can be written.

        Raises:
            UsageError: a folder does not exist, a file of another kind would be overwritten, or two outputs have the same
                name.
        """
        if self.replay is not None and self.replay.suffix.lower() not in (".html", ".htm"):
            raise usage_error(
                f"expected a file name with the suffix .html, found `{self.replay}`",
                f"--replay {self.replay.with_suffix('.html')}",
            )
        paths = {"recording": self.record, "replay page": self.replay, "ground truth": self.ground_truth}
        files = [(path, kind, kind) for kind, path in paths.items() if path is not None]
        if self.record is not None:  # a long one is continued in another file
            older = self.record.parent / f"{self.record.name}.1"
            files.insert(1, (older, "recording", "older part of the recording"))
        known: dict[Path, str] = {}
        for file, kind, what in files:
            check_output(file, kind)
            before = known.setdefault(file.resolve(), what)
            if before != what:
                raise usage_error(f"`{file}` cannot be both {before} and {what}", "name two files")
        if self.view == "page":
            check_view(self.view_address, self.view_token)


def check_view(address: str, token: str | None) -> None:
    """Check that a page can be served, and that other machines need a token chosen by the user.

    Raises:
        UsageError: the token is missing or too short, or websockets is not installed.
    """
    from importlib.util import find_spec  # here: few runs have a page

    try:
        found = find_spec("websockets.asyncio")
    except ModuleNotFoundError:
        found = None
    if found is None:
        raise usage_error(
            "the page needs websockets 15 or later, which is not installed",
            "pip install 'websockets>=15', or --view=terminal, or --record RUN.jsonl",
        )
    from jacaros.look.page.live.access import Access
    from jacaros.serving.access import SHORTEST_TOKEN

    if Access(address, token).exposed and token is None:
        raise usage_error(
            "a view for other machines needs a token",
            f"set JACAROS_VIEW_TOKEN, or add --view-token TOKEN (at least {SHORTEST_TOKEN} characters)",
        )


def has_display() -> bool:
    """Return whether a user can see a browser: standard error is a terminal, on a machine with a display."""
    if sys.stderr is None or not sys.stderr.isatty():
        return False
    if sys.platform.startswith("linux"):
        return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return "SSH_CONNECTION" not in os.environ


def check_output(path: Path, kind: str) -> None:
    """Check that an output can be written.

    Args:
        path: output file.
        kind: what will be written; a key of `_BEGINNINGS`.

    Raises:
        UsageError: the folder does not exist, *path* is a folder or not writable, or a file of another kind exists.
    """
    try:
        if path.is_dir():
            raise usage_error(f"`{path}` is a folder", f"name a file in it for the {kind}")
        if not path.exists():
            if not path.parent.is_dir():
                raise usage_error(f"folder does not exist: `{path.parent}`", f"mkdir -p {path.parent}")
            if not os.access(path.parent, os.W_OK):
                raise usage_error(f"no permission to write to `{path.parent}`", "name another folder")
        elif not os.access(path, os.W_OK):
            raise usage_error(f"no permission to write `{path}`", "name another file")
        elif path.is_fifo() and path.resolve().exists():  # unlike a pipe of the shell, which is open: >(gzip)
            raise usage_error(f"`{path}` is a named pipe, and opening it waits for a reader", "name a file")
        elif path.is_file():
            with path.open("rb") as file:
                begins = file.read(64).lstrip().lower()
            if begins and not begins.startswith(_BEGINNINGS[kind]):
                raise usage_error(f"`{path}` exists and is not a {kind}", "name another file, or delete it")
    except (OSError, ValueError) as error:
        raise usage_error(f"cannot write `{path}`: {error}", "name another file") from error


def write_output(path: Path, content: str | bytes, advice: str = "name another file") -> None:
    """Write a file.

    Raises:
        UsageError: it cannot be written; *advice* says what to do instead.
    """
    try:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise usage_error(f"cannot write `{path}`: {error.strerror}", advice) from error
