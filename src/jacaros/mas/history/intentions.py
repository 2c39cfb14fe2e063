"""Records of intentions: changes in those of agents that had a turn, at most ten times a second."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.urgency import Urgent
from jacaros.agents.mind.state.intention import PLAN, STEP, Frame, Intention
from jacaros.agents.mind.state.pending import Waiting
from jacaros.mas.history.programs import PlanNumbers
from jacaros.mas.history.steps import Stacks
from jacaros.mas.history.waiting import waits_for
from jacaros.mas.history.words import shown
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.trace import Cause

PERIOD = 0.1
"""Seconds of the run's clock between two checks of an agent."""
MOST = 100
"""Maximum number of intentions of one agent that are checked."""
MOST_AGENTS = 50
"""Maximum number of agents that are checked per period. Of thousands of busy agents, some are checked later."""

Tell = Callable[[str, Mapping[str, Any]], None]


Moments = Callable[..., float]
"""Returns the seconds from the beginning of the run to a moment of its clock (default: now), with millisecond precision."""


class Looks:
    """Checks agents that had a turn, `PERIOD` seconds after the first of them had it.

    Args:
        clock: clock of the run.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._due: list[Callable[[], None]] = []
        self._timer: Timer | None = None

    def soon(self, look: Callable[[], None]) -> None:
        """Call *look*, which checks an agent, soon."""
        self._due.append(look)
        if self._timer is None:
            self._timer = self._clock.call_later(PERIOD, self.look)

    def look(self) -> None:
        """Check the agents that are due now."""
        self.stop()
        due, self._due = self._due[:MOST_AGENTS], self._due[MOST_AGENTS:]
        if self._due:
            self._timer = self._clock.call_later(PERIOD, self.look)
        for look in due:
            look()

    def stop(self) -> None:
        """Stop checking until an agent has a turn."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class _Seen(NamedTuple):
    """What was recorded of an intention: its stack, step and wait, compared by identity."""

    depth: int
    frame: Frame
    step: object
    waiting: Waiting | None
    suspended: object

    def is_still(self, intention: Intention) -> bool:
        """Return whether nothing of it has changed."""
        frames = intention.frames
        return (
            self.depth == len(frames)
            and self.frame is frames[-1]
            and self.step is frames[-1][STEP]
            and self.waiting is intention.waiting
            and self.suspended is intention.suspended
        )


class IntentionRecords:
    """Records the longer intentions of one agent. Those that begin and end between two checks are left out.

    Args:
        mind: mind of the agent.
        numbers: numbers of its plans.
        cause: returns the cause of an intention's current step.
        t: returns times.
        tell: takes the kind of a record and its data.
        looks: checks the agent after its turns.
    """

    def __init__(
        self,
        mind: Mind,
        numbers: PlanNumbers,
        cause: Callable[[Intention], Cause | None],
        t: Moments,
        tell: Tell,
        looks: Looks,
    ) -> None:
        self._mind, self._cause, self._t = mind, cause, t
        self._stacks = Stacks(numbers)
        self._tell, self._looks = tell, looks
        self._seen: dict[int, _Seen] = {}
        self._is_due = False

    def had_turn(self) -> None:
        """Schedule a check of the agent."""
        if not self._is_due:
            self._is_due = True
            self._looks.soon(self.look)

    def look(self) -> None:
        """Record the intentions that have changed since the last check, and those that have ended."""
        self._is_due = False
        alive = self._mind.alive
        for number in [number for number in self._seen if number not in alive]:
            del self._seen[number]
            self._stacks.forget(number)
            self._tell("intention", {"agent": self._mind.name, "id": number, "state": "over"})
        for _, intention in zip(range(MOST), list(alive.values()), strict=False):
            seen = self._seen.get(intention.id)
            if intention.frames and (seen is None or not seen.is_still(intention)):
                frame = intention.frames[-1]
                new = _Seen(len(intention.frames), frame, frame[STEP], intention.waiting, intention.suspended)
                self._seen[intention.id] = new
                self._record(intention)

    def _record(self, intention: Intention) -> None:
        waiting, cause = intention.waiting, self._cause(intention)
        record = {
            "agent": self._mind.name,
            "id": intention.id,
            "state": "suspended"
            if intention.suspended is not None
            else "waits"
            if waiting is not None
            else "runs",
            "stack": self._stacks.of(intention),
            "waits": "" if waiting is None or waiting.ended else waits_for(waiting),
            "since": self._t(None if waiting is None else waiting.began),
            "reason": "" if intention.suspended is None else shown(intention.suspended),
            "urgency": self._urgency(intention),
            "cause": 0 if cause is None else cause.id,
        }
        self._tell("intention", record)

    def _urgency(self, intention: Intention) -> int:
        selections = self._mind.selections
        if not isinstance(selections, Urgent):
            return 0
        return max(selections.of_plan(frame[PLAN]) for frame in intention.frames)
