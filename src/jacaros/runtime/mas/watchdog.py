"""Warn of a step that blocks other agents and the robot: with agent, plan and line, read from the Python frames of the
run's thread.
"""

import asyncio
import os
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from itertools import takewhile
from pathlib import Path
from types import FrameType

from jacaros.agents.language.lowering import format_term
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.add_im import Selection
from jacaros.agents.mind.rules.body_steps import Step
from jacaros.agents.mind.state.plan import FAILED, Plan
from jacaros.runtime.mas.agents.host import AgentHost

INTERVAL = 1.0
"""Seconds between two checks."""
LOOKS = 2
"""Number of further checks that must find the same step."""


class Watchdog:
    """Watches, from a separate thread, what the thread that created it is doing.

    It does not instrument the steps, so it costs them nothing.

    Args:
        tell: takes a line of the log. Called in the watchdog's thread, because the other one is busy.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._watched = threading.get_ident()
        self._end = threading.Event()
        self._task: FrameType | None = None
        self._met = 0
        self._told: set[str] = set()

    def start(self) -> None:
        """Begin to watch."""
        threading.Thread(target=self._watch, name="watchdog", daemon=True).start()

    def stop(self) -> None:
        """Stop watching."""
        self._end.set()

    def _watch(self) -> None:
        while not self._end.wait(INTERVAL):
            frame = sys._current_frames().get(self._watched)
            if self._is_too_long(task_of(frame)):
                self._complain(current_step(frame))

    def _is_too_long(self, task: FrameType | None) -> bool:
        """Return whether the current work was in progress at the last checks, too.

        *task* is its frame, which is unique to the call.
        """
        self._met = self._met + 1 if task is not None and task is self._task else 0
        self._task = task
        return self._met == LOOKS

    def _complain(self, work: str) -> None:
        if work not in self._told:
            self._told.add(work)
            seconds = INTERVAL * LOOKS
            self._tell(
                f"warning: a step has been running for more than {seconds:g} seconds and blocks all agents: {work}"
            )


_LOOP = "asyncio.events"
"""The module whose ``Handle._run`` calls all callbacks of the event loop."""
_STANDARD = str(Path(os.__file__).parent)
"""Folder of Python's own modules."""


def task_of(frame: FrameType | None) -> FrameType | None:
    """Return the frame of the work during which no other agent has a turn.

    That is the step or plan selection of an agent, or else the callback of the event loop. None while the loop waits,
    and while a module is imported, which may take long.
    """
    task = callback = None
    for inner in _outwards(frame):
        module = inner.f_globals.get("__name__", "")
        if module == "importlib._bootstrap":
            return None
        if _place_in_program(inner) is not None:
            task = inner
        if module == _LOOP:
            return task or callback
        callback = inner
    return task


def current_step(frame: FrameType | None) -> str:
    """Return what is being done, for messages: ``agent bob, plan +!find(X) (bob.asl:7)``."""
    frames = list(_in_turn(frame))
    host = next((found for found in map(_host, frames) if found is not None), None)
    places = [found for each in frames if (found := _place_in_program(each)) is not None]
    place = "{}:{}".format(*places[0]) if places else _place_of_python(frames)
    if host is None:
        return place
    plan = _plan_at(host.mind.library.plans, *places[-1]) if places and host.mind is not None else None
    doing = f", plan {format_term(plan.node.trigger)}" if plan is not None else ""
    called = _own_python(frames) if places else None
    inside = f", in {_place(called)}" if called is not None else ""
    return f"agent {host.name}{doing} ({place}{inside})"


def is_of_user(frame: FrameType | None) -> bool:
    """Return whether an agent's cycle or the user's own Python runs, and not the run itself."""
    return any(_host(each) is not None or not _is_library(each) for each in _in_turn(frame))


def _in_turn(frame: FrameType | None) -> Iterator[FrameType]:
    """Iterate over the frames in a turn of the event loop, without the program that started the loop."""
    return takewhile(lambda each: each.f_code is not asyncio.Handle._run.__code__, _outwards(frame))


def _outwards(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def _is_generated(frame: FrameType) -> bool:
    """Return whether the compiler generated the function of a frame, whose file and lines are then those of the program."""
    names = frame.f_globals
    return names.get("FAILED") is FAILED and "__name__" not in names


def _place_in_program(frame: FrameType) -> tuple[str, int] | None:
    """Return file and line of the agent program that a frame executes, compiled or interpreted."""
    if _is_generated(frame):
        return frame.f_code.co_filename, _line(frame)
    node = None
    if frame.f_code is Step.__call__.__code__:
        node = frame.f_locals["self"].node
    elif frame.f_code is Selection._frames_of.__code__:
        node = frame.f_locals["plan"].node
    return None if node is None or node.span is None else (node.span.file.name, node.span.line)


def _host(frame: FrameType) -> AgentHost | None:
    mind = frame.f_locals.get("agent") if frame.f_code is Mind.run.__code__ else None
    return mind.architecture if mind is not None and isinstance(mind.architecture, AgentHost) else None


def _plan_at(plans: Sequence[Plan], file: str, line: int) -> Plan | None:
    for plan in plans:
        span = plan.node.span
        if span is not None and span.file.name == file and span.line <= line <= span.end_line:
            return _plan_at(plan.subplans, file, line) or plan
    return None


def _own_python(frames: Sequence[FrameType]) -> FrameType | None:
    """Return the innermost frame of the project's own Python code above the agent program."""
    for frame in frames:
        if _place_in_program(frame) is not None:
            return None
        if not _is_library(frame):
            return frame
    return None


def _place_of_python(frames: Sequence[FrameType]) -> str:
    own = [frame for frame in frames if not _is_library(frame)] or frames
    return _place(own[0]) if own else "an unknown place"


def _is_library(frame: FrameType) -> bool:
    """Return whether a frame belongs to JaCaROS, Python or an installed package."""
    file = frame.f_code.co_filename
    module = str(frame.f_globals.get("__name__", ""))
    if module.partition(".")[0] in ("jacaros", "asyncio") or file.startswith(("<", _STANDARD)):
        return True
    return "site-packages" in file or "dist-packages" in file


def _place(frame: FrameType) -> str:
    return f"{frame.f_code.co_filename}:{_line(frame)}"


def _line(frame: FrameType) -> int:
    """Return the line of a frame; between two lines, that of its function."""
    return frame.f_lineno or frame.f_code.co_firstlineno
