"""Whether a Python agent is busy, for the idleness of the run."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from jacaros.artifacts.presence.presence import Account
from jacaros.mas.idleness import Activity


class TaskActivity(Account):
    """Counts the tasks of one agent. The agent is busy unless all of them wait for others.

    A task waits for others while it is in `waiting`: for a message, a signal, a condition. A task that waits for
    anything else, such as a thread or a socket, is busy. But if it has started tasks that are not the agent's own (with
    ``asyncio.gather`` or a task group), and all of them wait for others, so does it.

    Args:
        activity: activity of the run.
        settled: called whenever the agent may have become idle.
    """

    def __init__(self, activity: Activity, settled: Callable[[], None]) -> None:
        self._activity = activity
        self._settled = settled
        self._own: set[asyncio.Task[Any]] = set()
        self._others: set[asyncio.Task[Any]] = set()
        self._waiting: dict[asyncio.Task[Any], int] = {}
        self._counted = False

    def begin(self) -> None:
        """An operation, or something else with an end, has begun."""
        self._activity.begin()

    def end(self) -> None:
        """It has ended."""
        self._activity.end()
        self._settled()

    @contextmanager
    def under_way(self) -> Iterator[None]:
        """Context of something with an end."""
        self.begin()
        try:
            yield
        finally:
            self.end()

    def add(self, task: "asyncio.Task[Any]") -> None:
        """Add a task of the agent."""
        self._own.add(task)
        task.add_done_callback(self._gone)
        self._count()

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Context of a wait that something else must end."""
        task = asyncio.current_task()
        assert task is not None
        if task not in self._own and task not in self._others:
            self._others.add(task)
            task.add_done_callback(self._gone)
        self._waiting[task] = self._waiting.get(task, 0) + 1
        self._count()
        try:
            yield
        finally:
            self._waiting[task] -= 1
            if not self._waiting[task]:
                del self._waiting[task]
            self._count()

    def _gone(self, task: "asyncio.Task[Any]") -> None:
        self._own.discard(task)
        self._others.discard(task)
        self._count()

    def _count(self) -> None:
        busy = self._is_busy()
        if busy and not self._counted:
            self._activity.begin()
        elif not busy and self._counted:
            self._activity.end()
            self._settled()
        self._counted = busy

    def _is_busy(self) -> bool:
        if any(task not in self._waiting for task in self._others):
            return True
        return not self._others and any(task not in self._waiting for task in self._own)
