"""Intentions as threads, and their stacks of plans as stack frames."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.circumstance import HeldEvent
from jacaros.agents.mind.state.intention import EVENT_GOAL, EVENT_INTENTION, Frame, Intention
from jacaros.look.records.words import shown_event
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.history.intentions import levels_of, place_in_stack, shown_goal
from jacaros.runtime.mas.system import System

NO_INTENTION = 0
"""Stands for the agent itself: it handles an event of its environment, or waits for one."""


@dataclass(frozen=True)
class Level:
    """A stack frame that the editor knows.

    Attributes:
        host: the agent.
        intention: its intention, or None.
        frame: the frame of the plan; None for an agent without one.
    """

    host: AgentHost
    intention: Intention | None
    frame: Frame | None


class Threads:
    """The intentions of all agents. An intention keeps the number of its thread.

    Args:
        system: the run.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        self._known: dict[tuple[str, int], int] = {}
        self._levels: list[Level] = []

    def forget(self) -> None:
        """Drop the stack frames: the run continues."""
        self._levels.clear()

    def id(self, agent: str, intention: int = NO_INTENTION) -> int:
        """Return the number of a thread."""
        return self._known.setdefault((agent, intention), len(self._known) + 1)

    def all(self) -> list[dict[str, Any]]:
        """Return all threads."""
        found: list[dict[str, Any]] = []
        for host in self._system.directory:
            names = _names(host)
            failure = self._system.debugger.failure
            if failure is not None and failure.agent == host.name:
                names.pop(NO_INTENTION, None)
                names.setdefault(failure.intention, _name(host, failure.frames))
            found += [{"id": self.id(host.name, number), "name": name} for number, name in names.items()]
        return found

    def of(self, thread: int) -> tuple[AgentHost, Intention | None]:
        """Return agent and intention of a thread; None for the agent itself, and for an intention that has ended.

        Raises:
            UsageError: the thread is unknown, or its agent has ended.
        """
        agent, number = next((key for key, each in self._known.items() if each == thread), ("", 0))
        host = self._system.directory.find(agent)
        if host is None:
            raise UsageError(f"unknown thread: {thread}")
        return host, None if host.mind is None else host.mind.alive.get(number)

    def stopped(self) -> int:
        """Return the thread that the run stopped for: the agent's, or that of the first agent."""
        debugger = self._system.debugger
        if debugger.failure is not None:
            return self.id(debugger.failure.agent, debugger.failure.intention)
        state = debugger.state
        if not state.agent:
            return next((each["id"] for each in self.all()), self.id(""))
        host = self._system.directory.find(state.agent)
        held = None if host is None or host.mind is None else host.mind.held
        waits = held.event[EVENT_INTENTION] if isinstance(held, HeldEvent) else None
        return self.id(state.agent, state.intention if waits is None else waits.id)

    def stack(self, thread: int) -> list[dict[str, Any]]:
        """Return the stack frames of a thread, the current plan first."""
        host, intention = self.of(thread)
        failure = self._system.debugger.failure
        if failure is not None and thread == self.id(failure.agent, failure.intention):
            frames, line = failure.frames, failure.line
        else:
            frames, line = [] if intention is None else intention.frames, 0
        levels = levels_of(frames)
        shown = [self._shown(Level(host, intention, frame), above) for frame, above in reversed(levels)]
        if shown and line:
            shown[0]["line"] = line
        if not shown:
            shown = [self._without_plan(Level(host, intention, None))]
        return shown

    def level(self, frame: int) -> Level:
        """Return a stack frame by its number.

        Raises:
            UsageError: it is unknown: the run has continued.
        """
        if not 0 < frame <= len(self._levels):
            raise UsageError(f"unknown stack frame: {frame}")
        return self._levels[frame - 1]

    def _shown(self, level: Level, above: Frame | None) -> dict[str, Any]:
        assert level.frame is not None
        span = place_in_stack(level.frame, above)
        shown = self._numbered(level, shown_goal(level.frame))
        if span is not None and os.path.exists(path := Path(span.file.name)):
            place = {"line": span.line, "column": span.column}
            shown |= {"source": {"name": path.name, "path": str(path.resolve())}, **place}
        return shown

    def _without_plan(self, level: Level) -> dict[str, Any]:
        held = None if level.host.mind is None else level.host.mind.held
        told = shown_event(held.event[EVENT_GOAL]) if isinstance(held, HeldEvent) else "no plan"
        return self._numbered(level, told) | {"presentationHint": "label"}

    def _numbered(self, level: Level, name: str) -> dict[str, Any]:
        self._levels.append(level)
        return {"id": len(self._levels), "name": name, "line": 0, "column": 0}


def _names(host: AgentHost) -> dict[int, str]:
    """Return the names of an agent's threads by intention; the agent itself if it has none, or handles an event."""
    mind = host.mind
    if not isinstance(mind, Mind):
        return {NO_INTENTION: f"{host.name} (Python)"}
    names = {number: _name(host, each.frames) for number, each in list(mind.alive.items())}
    held = mind.held
    if isinstance(held, HeldEvent) and held.event[EVENT_INTENTION] is None:
        return {NO_INTENTION: f"{host.name}: {shown_event(held.event[EVENT_GOAL])}", **names}
    return names or {NO_INTENTION: host.name}


def _name(host: AgentHost, frames: Sequence[Frame]) -> str:
    levels = levels_of(frames)
    return f"{host.name}: {shown_goal(levels[0][0])}" if levels else f"{host.name}: new goal"
