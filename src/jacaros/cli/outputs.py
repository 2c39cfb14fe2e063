"""What a run is written to, apart from what the agents print."""

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path

from jacaros.errors import UsageError

OUTPUT_GONE = 141
"""Exit code when the reader of the output is gone, as in ``| head``: 128 and the number of SIGPIPE."""
LOOPBACK = "127.0.0.1"
RECORD_LIMIT = 500
"""Megabytes that a recording may have."""

_BEGINNINGS = {
    "recording": (b'{"kind": "', b"\x1f\x8b\x08", b"\x89mcap0"),
    "replay page": (b"<!doctype html>",),
    "ground truth": (b'{"kind": "',),
    "JUnit report": (b"<?xml", b"<testsuite"),
    "picture": (b"<svg",),
    "map": (b"image:",),
    "map image": (b"p5",),
}
"""How a file of each kind begins: no other file is overwritten."""


@dataclass(frozen=True, slots=True)
class Outputs:
    """What the command line asks for.

    Attributes:
        record: file for the recording, or None.
        replay: file for the page, or None.
        ground_truth: file for what truly happens in the world, or None.
        view: show the run: ``page`` in a browser, ``terminal`` in the terminal, "" not at all.
        view_address, view_port, view_token: where the page is served; see `jacaros.inspector.live.run_view.Place`.
        record_limit: bytes that the recording may have.
    """

    record: Path | None = None
    replay: Path | None = None
    ground_truth: Path | None = None
    view: str = ""
    view_address: str = LOOPBACK
    view_port: int = 0
    view_token: str | None = None
    record_limit: int = RECORD_LIMIT * 1_000_000

    @property
    def any(self) -> bool:
        """Whether the run is watched at all."""
        return bool(self.view) or any(
            path is not None for path in (self.record, self.replay, self.ground_truth)
        )

    def check(self) -> None:
        """Refuse what cannot be written, before the run.

        Raises:
            UsageError: a folder is missing, a file is not one of ours, or two outputs are one file.
        """
        if self.replay is not None and self.replay.suffix.lower() not in (".html", ".htm"):
            raise wrong_output(
                f"not the name of a page: `{self.replay}`", f"--replay {self.replay.with_suffix('.html')}"
            )
        paths = {"recording": self.record, "replay page": self.replay, "ground truth": self.ground_truth}
        known: dict[Path, str] = {}
        for kind, path in paths.items():
            if path is None:
                continue
            check_output(path, kind)
            if kind == "recording" and path.with_name(f"{path.name}.1").exists():
                check_output(path.with_name(f"{path.name}.1"), kind)
            before = known.setdefault(path.resolve(), kind)
            if before != kind:
                raise wrong_output(f"`{path}` cannot be both {before} and {kind}", "name two files")
        if self.view == "page":
            check_view(self.view_address, self.view_token)


def check_view(address: str, token: str | None) -> None:
    """Refuse a view that others can reach without a token that the user has chosen.

    Raises:
        UsageError: there is none, or it is too short; or the library that serves pages is not installed.
    """
    from importlib.util import find_spec  # here: few runs have a page

    with contextlib.suppress(ModuleNotFoundError):
        if find_spec("websockets.asyncio") is not None:
            _check_access(address, token)
            return
    raise UsageError(
        "error: websockets, which serves pages, is not installed, or is older than 15\n"
        "  = help: pip install 'websockets>=15', or --view=terminal, or --record RUN.jsonl"
    )


def _check_access(address: str, token: str | None) -> None:
    from jacaros.inspector.live.access import SHORTEST_TOKEN, Access  # here: few runs have a page

    if Access(address, token).exposed and token is None:
        raise UsageError(
            "error: a view for other machines needs a token\n"
            f"  = help: set JACAROS_VIEW_TOKEN, or add --view-token TOKEN (at least {SHORTEST_TOKEN} characters)"
        )


def check_output(path: Path, kind: str, make_folder: bool = False) -> None:
    """Refuse a path to which an output of *kind* (a key of `_BEGINNINGS`) cannot be written.

    Args:
        path: of the file.
        kind: what is to be written.
        make_folder: the folder is made when the file is written.

    Raises:
        UsageError: its folder does not exist, it is a folder, it cannot be written, or another file is there.
    """
    try:
        if path.is_dir():
            raise wrong_output(f"`{path}` is a folder", f"name a file in it for the {kind}")
        if not path.exists():
            if make_folder:
                return
            if not path.parent.is_dir():
                raise wrong_output(f"folder does not exist: `{path.parent}`", f"mkdir -p {path.parent}")
            if not os.access(path.parent, os.W_OK):
                raise wrong_output(f"no permission to write to `{path.parent}`", "name another folder")
        elif not os.access(path, os.W_OK):
            raise wrong_output(f"no permission to write `{path}`", "name another file")
        elif path.is_file():
            _check_content(path, kind)
    except (OSError, ValueError) as error:
        raise wrong_output(f"cannot write `{path}`: {error}", "name another file") from error


def _check_content(path: Path, kind: str) -> None:
    with path.open("rb") as file:
        begins = file.read(64)
    if begins and not begins.lstrip().lower().startswith(_BEGINNINGS[kind]):
        raise wrong_output(f"not a {kind}, and not overwritten: `{path}`", "name another file, or delete it")


def wrong_output(what: str, help_text: str) -> UsageError:
    """The error about an output that cannot be written."""
    return UsageError(f"error: {what}\n  = help: {help_text}")
