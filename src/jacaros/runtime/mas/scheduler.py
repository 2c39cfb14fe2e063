"""The scheduler: ready agents take turns on the event loop.

While no agent is ready, nothing runs and nothing is polled, so an idle system uses no CPU.

Between two rounds of turns, the loop polls its sockets and runs due callbacks. In real time, the duration of a round is
limited, so a sensor message is read within about two milliseconds however busy the agents are. On the virtual clock,
the number of cycles is limited instead: the speed of the machine must not change the order of events.

A scheduler can be paused, also in the middle of a turn. The round then continues where it was interrupted: with the
same agent, and with its remaining cycles.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import NamedTuple, Protocol

from jacaros.agents.mind.state.act import Activity, TimerHandle
from jacaros.runtime.clock import Clock, real_time, run_context
from jacaros.runtime.mas.console import entered


class Runnable(Protocol):
    """An agent, as the scheduler sees it: keeps minds out of the scheduler."""

    queued: bool
    """Whether it is in the queue. Set by the scheduler."""

    @property
    def cycles(self) -> int:
        """Number of its reasoning cycles so far."""

    @property
    def is_held(self) -> bool:
        """Whether it is held before the end of its turn."""

    def run(self, fuel: int) -> bool:
        """Run up to *fuel* reasoning cycles. Return whether there is more to do."""


class _Interrupted(NamedTuple):
    """A round that was paused.

    Attributes:
        agent: the agent whose turn it was; None between two turns.
        queued: whether it waits for another turn after this one.
        fuel: remaining cycles of the turn.
        cycles: cycles of the earlier turns in this round.
    """

    agent: Runnable | None
    queued: bool
    fuel: int
    cycles: int


class Scheduler:
    """Gives ready agents their turns, first come, first served.

    Args:
        clock: notified of the cycles, so that a virtual clock advances while agents are busy.
        on_idle: called whenever the last ready agent has run out of things to do.
        on_error: called with exceptions that escape from an agent: defects of JaCaROS itself.
        idle_work: in real time, does a little deferred work while no agent is ready. Returns False when none is left.
        real_time: seconds of a steady clock, which limit a round of turns unless *clock* is virtual.

    Attributes:
        paused: whether no agent has a turn.
        turn_ended: called with an agent that has used up its turn, if something may pause in the middle of a turn; or None.
        busy_for_long: called with an agent after each `TURNS_UNTIL_LOOK` turns in which it always had more to do, and
            whether it is the first time since it had not.
    """

    QUANTUM = 50
    """Maximum number of reasoning cycles of one agent in one turn: enough to make switching between agents cheap."""
    TURNS_UNTIL_LOOK = 10_000
    """Turns, of mostly 50 cycles, after which a busy agent is looked at."""
    CYCLES_PER_ROUND = 1000
    """On the virtual clock: cycles of all agents between two polls of timers, sockets and callbacks of the event loop."""
    SECONDS_PER_ROUND = 0.001
    """In real time: seconds between two polls, unless a single cycle takes longer."""
    PASSES = 4
    """In real time: passes of the event loop between two rounds, enough for a message from a socket to reach its agent."""

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
        self._context = run_context()
        self.paused = False
        self.turn_ended: Callable[[Runnable], None] | None = None
        self.busy_for_long: Callable[[Runnable, bool], None] = lambda _agent, _is_first: None
        self._busy_turns: dict[Runnable, int] = {}
        self._interrupted: _Interrupted | None = None

    @property
    def idle(self) -> bool:
        """Whether no agent is ready. False while paused, because it is unknown what agents have yet to do."""
        return not self._queue and not self.paused

    def pause(self) -> None:
        """Give no agent another turn until `resume`. The current turn continues until the agent yields."""
        self.paused = True

    def resume(self) -> None:
        """Continue with the interrupted turn, or with the next one."""
        if not self.paused:
            return
        self.paused = False
        if self._stopped:
            return
        if self._interrupted is not None:
            self._loop_in_use().call_soon(self._continue_round, context=self._context)
        elif self._queue and not self._due:
            self._call_soon()
        elif not self._due:
            self._on_idle()

    def _continue_round(self) -> None:
        """Finish the interrupted round, and what follows a round."""
        if self.paused:
            return
        if self._due:  # the next round is scheduled already
            self._round()
        else:
            self._turns()

    def make_ready(self, agent: Runnable) -> None:
        """Give *agent* a turn soon. No effect if it already waits for one."""
        if agent.queued or self._stopped:
            return
        agent.queued = True
        self._queue.append(agent)
        if not self._due:
            self._call_soon()

    def hurry(self) -> None:
        """Give the ready agents their turns now instead of in the next pass of the loop, unless one has its turn."""
        if self._queue and not self._taking_turns and not self.paused:
            self._round()

    def poll_soon(self) -> None:
        """In real time, end the round after the current turn, because the loop has work that an agent started."""
        self._poll_soon = not self._clock.virtual

    def stop(self) -> None:
        """Give no more turns."""
        self._stopped = True
        self._queue.clear()
        self._interrupted = None

    def _call_soon(self) -> None:
        self._due = True
        (self._loop or self._loop_in_use()).call_soon(self._turns, context=self._context)

    def _loop_in_use(self) -> asyncio.AbstractEventLoop:
        if self._loop is None:
            self._loop = asyncio.get_running_loop()
        return self._loop

    def _turns(self) -> None:
        if not self.paused:
            self._round()
        self._due = False
        if self.paused:
            return
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
        """Do a little deferred work, and continue after the next poll unless an agent is ready by then."""
        self._works_idly = False
        if self._due or self._stopped or self.paused:
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

        The loop polls its sockets and queues their callbacks after those that are already scheduled. A message then
        makes some hops, each in a pass of its own. If a round ran between them, each hop would wait for it.
        """
        self._due = True
        if passes:
            assert self._loop is not None
            self._loop.call_soon(self._call_after, passes - 1, context=self._context)
        else:
            self._call_soon()

    def _round(self) -> None:
        """Give the ready agents their turns until it is time to poll."""
        self._taking_turns = True
        self._poll_soon = False
        cycles = 0
        try:
            cycles = self._virtual_turns() if self._clock.virtual else self._real_turns()
        except Exception as error:
            self._report(error)
        finally:
            self._taking_turns = False
        if not self.paused:
            self._clock.busy(cycles)

    def _virtual_turns(self) -> int:
        """Give turns until the limit of cycles is reached. Return the number of cycles."""
        queue, quantum, cycles = self._queue, self.QUANTUM, 0
        if self._interrupted is not None:
            cycles = self._finish_turn(self._interrupted)
        while queue and cycles < self.CYCLES_PER_ROUND and not self.paused:
            agent = queue.popleft()
            agent.queued = False
            if self.turn_ended is not None:
                cycles = self._counted_turn(self.turn_ended, agent, quantum, cycles)
            elif agent.run(quantum):
                cycles += quantum
                self._requeue(agent)
            else:
                cycles += self._rests(agent)
        if self.paused and self._interrupted is None:
            self._interrupted = _Interrupted(None, False, 0, cycles)
        return cycles

    def _counted_turn(
        self, turn_ended: Callable[[Runnable], None], agent: Runnable, fuel: int, cycles: int
    ) -> int:
        """Give a turn that a pause may interrupt. Return the cycles of the round, including this turn if it has ended."""
        before = agent.cycles
        more = agent.run(fuel)
        if self.paused and agent.is_held:
            left = fuel - (agent.cycles - before)
            self._interrupted = _Interrupted(agent, agent.queued, left, cycles)
            agent.queued = True  # it gets the rest of its turn in any case
            return cycles
        if more:
            self._requeue(agent)
        turn_ended(agent)
        return cycles + (self.QUANTUM if more else self._rests(agent))

    def _finish_turn(self, interrupted: _Interrupted) -> int:
        """Give an agent the rest of its turn. Return the cycles of the round so far."""
        self._interrupted = None
        agent, queued, fuel, cycles = interrupted
        if agent is None or self.turn_ended is None:
            return cycles
        agent.queued = queued
        return self._counted_turn(self.turn_ended, agent, fuel, cycles)

    def _requeue(self, agent: Runnable) -> None:
        """Give an agent that has more to do another turn."""
        turns = self._busy_turns.get(agent, 0) + 1
        self._busy_turns[agent] = turns
        if turns % self.TURNS_UNTIL_LOOK == 0:
            self.busy_for_long(agent, turns == self.TURNS_UNTIL_LOOK)
        if not agent.queued and not self._stopped:
            agent.queued = True
            self._queue.append(agent)

    def _rests(self, agent: Runnable) -> int:
        """Note that an agent has nothing more to do. Return the cycles that its turn counts."""
        self._busy_turns.pop(agent, None)
        return 1

    def _real_turns(self) -> int:
        """Give turns until it is time to poll. Return the number of cycles."""
        queue, now = self._queue, self._real_time
        look = quantum = self._quantum
        cycles = 0
        began = moment = now()
        while queue and not self.paused:
            agent = queue.popleft()
            agent.queued = False
            if agent.run(quantum):
                cycles += quantum
                self._requeue(agent)
            else:
                cycles += self._rests(agent)
            if self.turn_ended is not None:
                self.turn_ended(agent)
            if cycles >= look or self._poll_soon:
                before, moment = moment, now()
                quantum = self._fitting_quantum(moment - before)
                if self._poll_soon or moment - began >= self.SECONDS_PER_ROUND:
                    break
                look = cycles + quantum
        return cycles

    def _fitting_quantum(self, seconds: float) -> int:
        """Adapt the quantum to the duration of the last one, so that a round with long cycles ends in time."""
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


class AgentTimer:
    """A timer of an agent, counted until it fires or is cancelled."""

    __slots__ = ("_activity", "_callback", "_timer")

    def __init__(self, clock: Clock, activity: Activity, delay: float, callback: Callable[[], None]) -> None:
        self._activity = activity
        self._callback = callback
        activity.begin()
        self._timer: TimerHandle | None = clock.call_later(delay, self._ring)

    def cancel(self) -> None:
        """Cancel the timer. No effect after it has fired."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self._activity.end()

    def _ring(self) -> None:
        if self._timer is not None:
            self._timer = None
            self._activity.end()
            self._callback()


_HOPS = 8
"""Number of idle turns of the event loop before a run counts as idle: a message of the in-process ROS graph takes a few
turns to become a belief.
"""


class Idleness:
    """Detects when a run is idle. Costs nothing without listeners.

    Args:
        activity: counts what the agents wait for.

    Attributes:
        turns: the scheduler of the agents. Set before the first check.
    """

    turns: Scheduler

    def __init__(self, activity: Activity) -> None:
        self._activity = activity
        self._watchers: list[Callable[[], None]] = []
        self._looks = 0

    def watch(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* whenever the run has become idle. Return a function that ends this."""
        return entered(self._watchers, callback)

    def stop(self) -> None:
        """Remove all listeners."""
        self._watchers.clear()

    def look(self) -> None:
        """Check whether the run is idle, after the last agent has run out of things to do."""
        if self._watchers:
            self._looks += 1
            self._look_again(self._looks, _HOPS)

    def _look_again(self, look: int, hops: int) -> None:
        if look != self._looks or self._activity.pending or not self.turns.idle:
            return
        if hops:
            asyncio.get_running_loop().call_soon(self._look_again, look, hops - 1)
            return
        for callback in tuple(self._watchers):
            callback()
