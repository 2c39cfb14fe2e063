"""Report a goal that repeats without waiting or acting: the agent never ends its turn, and on a virtual clock time hardly
moves.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING, Final

from jacaros.agents.mind.rules.failure_reason import shown_goal
from jacaros.agents.mind.state.intention import EVENT_GOAL, EVENT_INTENTION, GOAL, PLAN, Intention
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.mind.state.triggers import Goal
from jacaros.runtime.clock import real_time
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.scheduler import Runnable

if TYPE_CHECKING:
    from jacaros.agents.mind.mind import Mind

LOOKED_AT: Final = 10
"""Number of intentions of an agent that are examined."""


@dataclass(slots=True)
class _Busy:
    """An agent since the first look at it.

    Attributes:
        cycles, began: its reasoning cycles, and the seconds of a steady clock, at the first look.
        goals: the goals that it was seen to pursue, see `_goals`.
    """

    cycles: int
    began: float
    goals: set[tuple[str, int]] = field(default_factory=set)


class EndlessLoops:
    """Compares the goals of a busy agent at long intervals: a loop repeats a goal, a long computation has other arguments.

    Args:
        tell: takes a line of the log.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._busy: dict[str, _Busy] = {}
        self._told: set[str] = set()

    def look(self, agent: Runnable, is_first: bool) -> None:
        """Look at an agent that has been busy for a long time; *is_first* since it was idle."""
        if not isinstance(agent, AgentHost) or (mind := agent.mind) is None:
            return
        name = agent.name
        if is_first or name not in self._busy:
            self._busy[name] = _Busy(mind.counts.cycles, real_time())
        busy = self._busy[name]
        now = set(_goals(mind))
        for goal, _ in sorted(now & busy.goals):
            place = goal.rpartition(" (")[2]
            if place not in self._told:
                self._told.add(place)
                cycles, seconds = mind.counts.cycles - busy.cycles, real_time() - busy.began
                self._tell(
                    f"[{name}] warning: goal {goal} repeats without waiting or acting:"
                    f" {cycles:,} cycles in {seconds:.1f} s\n"
                    "  help: wait in the loop, as in `.wait(1000)`, or for what it needs"
                )
        busy.goals |= now


def _goals(mind: "Mind") -> Iterator[tuple[str, int]]:
    """Yield the goals that an agent pursues or has just posted, with the places of their plans.

    Callers outside may give equal goals again and again: theirs come with the number of the intention, others with 0.
    """
    for intention in islice(mind.intentions, LOOKED_AT):
        if intention.frames:
            frame = intention.frames[-1]
            for goal in _placed(frame[GOAL], (frame[PLAN],)):
                yield goal, _number(intention)
    for event in islice(mind.events, LOOKED_AT):
        if event[EVENT_GOAL][0].kind:
            for goal in _placed(event[EVENT_GOAL], mind.library.relevant(event[EVENT_GOAL][0])):
                yield goal, _number(event[EVENT_INTENTION])


def _number(intention: Intention | None) -> int:
    given = (
        intention is not None
        and intention.frames
        and intention.frames[0][GOAL][0].functor.namespace == "jacaros"
    )
    return intention.id if intention is not None and given else 0


def _placed(goal: Goal, plans: Sequence[Plan]) -> Iterator[str]:
    span = plans[0].node.span if plans else None
    if span is not None:
        yield f"`{shown_goal(goal)}` ({span.file.name}:{span.line})"
