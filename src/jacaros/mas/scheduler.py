"""Who reasons next: the agents that have something to do take turns on the loop.

Nothing runs, and nothing is asked, while no agent is ready: an idle system costs nothing.

Between two rounds of turns the loop polls its sockets and calls what is due.  In real time a round is bounded in time, so a
sensor's message is read within some two milliseconds however busy the agents are.  On the virtual clock it is bounded in
cycles: the machine's speed must not change the order in which things happen.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Protocol

from jacaros.clock import Clock, real_time


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
        idle_work: in real time, does a little of what can wait whenever no agent is ready; False when nothing is left.
        real_time: seconds of a steady clock, which bound a round of turns unless *clock* is virtual.
    """

    QUANTUM = 50
    """Reasoning cycles of one agent in one turn, at most: enough to make the change of agents cheap."""
    CYCLES_PER_ROUND = 1000
    """On the virtual clock: cycles of all agents between two polls of timers, sockets and other callbacks of the loop."""
    SECONDS_PER_ROUND = 0.001
    """In real time: seconds between two polls, unless a single cycle takes longer."""
    PASSES = 4
    """In real time: passes of the loop between two rounds, enough for a message on its way from socket to agent."""

    def __init__(
        self,
        clock: Clock,
        on_idle: Callable[[], None] = lambda: None,
        on_error: Callable[[BaseException], None] | None = None,
        real_time: Callable[[], float] = real_time,
        idle_work: Callable[[], bool] = lambda: False,
    ) -> None:
        self._clock = clock
        self._on_idle = on_idle
        self._on_error = on_error
        self._real_time = real_time
        self._idle_work = idle_work
        self._works_idly = False
        self._quantum = self.QUANTUM
        self._queue: deque[Runnable] = deque()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._due = False
        self._taking_turns = False
        self._poll_soon = False
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
        """Let the ready agents have their turns now and not in the next pass of the loop, unless one has its turn."""
        if self._queue and not self._taking_turns:
            self._round()

    def poll_soon(self) -> None:
        """In real time, end the round with the current turn: what an agent has begun is waiting for the loop."""
        self._poll_soon = not self._clock.virtual

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
        self._round()
        self._due = False
        if self._queue:
            if self._clock.virtual:
                self._call_soon()
            else:
                self._call_after(self.PASSES - 1)
        elif not self._stopped:
            self._on_idle()
            if not (self._clock.virtual or self._works_idly):
                self._work_idly()

    def _work_idly(self) -> None:
        """Do a little of what can wait, and go on after the next poll, unless an agent has something to do by then."""
        self._works_idly = False
        if self._due or self._stopped:
            return
        try:
            more = self._idle_work()
        except Exception as error:
            self._report(error)
            return
        if more:
            assert self._loop is not None
            self._works_idly = True
            self._loop.call_soon(self._work_idly)

    def _call_after(self, passes: int) -> None:
        """Schedule the next round some passes of the loop later.

        The loop polls its sockets, and puts their callbacks behind those that are scheduled already.  A message then makes
        some hops, each in a pass of its own.  If a round came between them, each would wait for it.
        """
        self._due = True
        if passes:
            assert self._loop is not None
            self._loop.call_soon(self._call_after, passes - 1)
        else:
            self._call_soon()

    def _round(self) -> None:
        """Let the ready agents have their turns until it is time to poll."""
        queue, virtual, now = self._queue, self._clock.virtual, self._real_time
        quantum, cycles = self.QUANTUM if virtual else self._quantum, 0
        look = self.CYCLES_PER_ROUND if virtual else quantum
        began = moment = 0.0 if virtual else now()
        self._taking_turns = True
        self._poll_soon = False
        try:
            while queue:
                agent = queue.popleft()
                agent.queued = False
                if agent.run(quantum):
                    cycles += quantum
                    if not agent.queued and not self._stopped:
                        agent.queued = True
                        queue.append(agent)
                else:
                    cycles += 1
                if cycles >= look or self._poll_soon:
                    if virtual:
                        break
                    before, moment = moment, now()
                    quantum = self._fitting_quantum(moment - before)
                    if self._poll_soon or moment - began >= self.SECONDS_PER_ROUND:
                        break
                    look = cycles + quantum
        except Exception as error:
            self._report(error)
        finally:
            self._taking_turns = False
        self._clock.busy(cycles)

    def _fitting_quantum(self, seconds: float) -> int:
        """The quantum, now that the last one took *seconds*: long cycles make it smaller, so that a round ends in time."""
        if seconds > self.SECONDS_PER_ROUND / 2:
            self._quantum = max(1, self._quantum // 2)
        elif self._quantum < self.QUANTUM and seconds < self.SECONDS_PER_ROUND / 8:
            self._quantum = min(self.QUANTUM, 2 * self._quantum)
        return self._quantum

    def _report(self, error: Exception) -> None:
        self.stop()
        if self._on_error is None:
            raise error
        self._on_error(error)
