"""Who reasons next: the agents that have something to do take turns on the loop.

Nothing runs, and nothing is asked, while no agent is ready: an idle system costs nothing.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Protocol

from jacaros.clock import Clock


class Runnable(Protocol):
    """An agent as the scheduler sees it."""

    queued: bool
    """True while it stands in the queue; kept by the scheduler."""

    def run(self, fuel: int) -> bool:
        """Make up to *fuel* reasoning cycles; True when there is more to do."""


class Scheduler:
    """Gives ready agents their turns, first come first served.

    Args:
        clock: told of the cycles, so that a virtual one moves although nobody gets idle.
        on_idle: called whenever the last ready agent has run out of things to do.
        on_error: told of what escapes from an agent: a defect of JaCaROS itself.
    """

    QUANTUM = 50
    """Reasoning cycles of one agent in one turn: enough to make the change of agents cheap."""
    CYCLES_PER_CALL = 1000
    """Cycles of all agents between two looks at timers, sockets and other callbacks of the loop."""

    def __init__(
        self,
        clock: Clock,
        on_idle: Callable[[], None] = lambda: None,
        on_error: Callable[[BaseException], None] | None = None,
    ) -> None:
        self._clock = clock
        self._on_idle = on_idle
        self._on_error = on_error
        self._queue: deque[Runnable] = deque()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._due = False
        self._taking_turns = False
        self._stopped = False

    @property
    def idle(self) -> bool:
        """True when no agent is ready."""
        return not self._queue

    def make_ready(self, agent: Runnable) -> None:
        """Let *agent* have a turn soon; nothing happens when it already waits for one."""
        if agent.queued or self._stopped:
            return
        agent.queued = True
        self._queue.append(agent)
        if not self._due:
            self._call_soon()

    def hurry(self) -> None:
        """Let the ready agents have their turns now and not in the next round of the loop, unless one has its turn."""
        if self._queue and not self._taking_turns:
            self._take_turns()

    def stop(self) -> None:
        """Let nobody have a turn any more."""
        self._stopped = True
        self._queue.clear()

    def _call_soon(self) -> None:
        self._due = True
        if self._loop is None:
            self._loop = asyncio.get_running_loop()
        self._loop.call_soon(self._turns)

    def _turns(self) -> None:
        self._take_turns()
        self._due = False
        if self._queue:
            self._call_soon()
        elif not self._stopped:
            self._on_idle()

    def _take_turns(self) -> None:
        queue, quantum = self._queue, self.QUANTUM
        left = self.CYCLES_PER_CALL
        self._taking_turns = True
        try:
            while queue and left > 0:
                agent = queue.popleft()
                agent.queued = False
                if agent.run(quantum):
                    left -= quantum
                    if not agent.queued and not self._stopped:
                        agent.queued = True
                        queue.append(agent)
                else:
                    left -= 1
        except Exception as error:
            self._report(error)
        finally:
            self._taking_turns = False
        self._clock.busy(self.CYCLES_PER_CALL - left)

    def _report(self, error: Exception) -> None:
        self.stop()
        if self._on_error is None:
            raise error
        self._on_error(error)
