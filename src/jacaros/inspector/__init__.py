"""Observe a run: recorder, replay page, still picture, live pages, and a live view in the terminal."""

from typing import TYPE_CHECKING

from jacaros.exports import exported

if TYPE_CHECKING:
    from jacaros.inspector.live.run_view import view
    from jacaros.inspector.page import write_replay
    from jacaros.inspector.picture import write_picture
    from jacaros.inspector.recorder import Recorder, record
    from jacaros.inspector.recording import Recording
    from jacaros.inspector.scene import RobotView, views_of
    from jacaros.inspector.terminal_view import TerminalView
    from jacaros.inspector.watch import Watch, Watcher
    from jacaros.mas.history.records import Frame

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

_MODULES = {
    "jacaros.inspector.live.run_view": "view",
    "jacaros.inspector.page": "write_replay",
    "jacaros.inspector.picture": "write_picture",
    "jacaros.inspector.recorder": "Recorder record",
    "jacaros.inspector.recording": "Recording",
    "jacaros.inspector.scene": "RobotView views_of",
    "jacaros.inspector.terminal_view": "TerminalView",
    "jacaros.inspector.watch": "Watch Watcher",
    "jacaros.mas.history.records": "Frame",
}
"""Loaded on first use: recording a run must not import servers, terminals or pictures."""

__getattr__ = exported(__name__, _MODULES)
