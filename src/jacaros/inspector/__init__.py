"""Observe a run: recorder, replay page, still picture, live pages, and a live view in the terminal."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jacaros.inspector.live.view import view
    from jacaros.inspector.page import write_replay
    from jacaros.inspector.picture import write_picture
    from jacaros.inspector.recorder import Recorder
    from jacaros.inspector.recording import Frame, Recording
    from jacaros.inspector.run_recording import record
    from jacaros.inspector.scene import RobotView, views_of
    from jacaros.inspector.terminal_view import TerminalView
    from jacaros.inspector.watch import Watch, Watcher

_HOMES = {
    "Frame": "jacaros.inspector.recording",
    "Recorder": "jacaros.inspector.recorder",
    "Recording": "jacaros.inspector.recording",
    "RobotView": "jacaros.inspector.scene",
    "TerminalView": "jacaros.inspector.terminal_view",
    "Watch": "jacaros.inspector.watch",
    "Watcher": "jacaros.inspector.watch",
    "record": "jacaros.inspector.run_recording",
    "view": "jacaros.inspector.live.view",
    "views_of": "jacaros.inspector.scene",
    "write_picture": "jacaros.inspector.picture",
    "write_replay": "jacaros.inspector.page",
}
"""The module of each name: recording a run must not import servers, terminals or pictures."""

__all__ = [
    "Frame",
    "Recorder",
    "Recording",
    "RobotView",
    "TerminalView",
    "Watch",
    "Watcher",
    "record",
    "view",
    "views_of",
    "write_picture",
    "write_replay",
]


def __getattr__(name: str) -> object:
    """Import a name on first use.

    Raises:
        AttributeError: the name is unknown.
    """
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return found
