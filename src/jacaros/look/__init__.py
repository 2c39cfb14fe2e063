"""Observe a run: recorder, replay page, still picture, live pages, and a live view in the terminal."""

from typing import TYPE_CHECKING

from jacaros.runtime.exports import exported

if TYPE_CHECKING:
    from jacaros.look.page.live.run_view import view
    from jacaros.look.page.page import write_replay
    from jacaros.look.page.picture import write_picture
    from jacaros.look.page.recorder import Recorder, record
    from jacaros.look.page.scene import RobotView, views_of
    from jacaros.look.page.terminal_view import TerminalView
    from jacaros.look.page.watch import Watch, Watcher
    from jacaros.look.records.recording import Recording
    from jacaros.look.records.records import Frame

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
    "jacaros.look.page.live.run_view": "view",
    "jacaros.look.page.page": "write_replay",
    "jacaros.look.page.picture": "write_picture",
    "jacaros.look.page.recorder": "Recorder record",
    "jacaros.look.records.recording": "Recording",
    "jacaros.look.page.scene": "RobotView views_of",
    "jacaros.look.page.terminal_view": "TerminalView",
    "jacaros.look.page.watch": "Watch Watcher",
    "jacaros.look.records.records": "Frame",
}
"""Loaded on first use: recording a run must not import servers, terminals or pictures."""

__getattr__ = exported(__name__, _MODULES)
