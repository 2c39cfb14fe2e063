"""Watching a run: recorder, replay page, still picture, live pages, and a live view in the terminal."""

from jacaros.inspector.live.view import view
from jacaros.inspector.page import write_replay
from jacaros.inspector.picture import write_picture
from jacaros.inspector.record import record
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.recording import Frame, Recording
from jacaros.inspector.scene import RobotView, views_of
from jacaros.inspector.terminal_view import TerminalView
from jacaros.inspector.watch import Watch, Watcher

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
