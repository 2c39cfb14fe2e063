"""What watchers of a run are told of the agents' goals: each change once, and goals by numbers of their own."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import count

from jacaros.bdi.agent import Agent
from jacaros.bdi.meta_events import observe_goals
from jacaros.mas.agent_host import AgentHost

Tell = Callable[[dict[str, object]], None]

_OPEN = {"executing": "pursued", "resumed": "resumed", "suspended": "suspended"}
_OVER = ("achieved", "failed", "dropped", "recovered", "replaced")
_AT_WORK = ("pursued", "resumed")
_KEPT = 10_000
"""Goals whose end is waited for; the oldest are forgotten, for instance if a plan for their failure never ends."""


@dataclass(slots=True)
class _Goal:
    which: object
    number: int
    state: str


class GoalNews:
    """Tells watchers of goals, from what minds tell of them.

    A mind tells that it works for a goal whenever a step of that has ended.  Goals that are open are kept, so that no
    other one can take their identity: numbers are the same in each run with one seed.

    Args:
        tell: takes ``agent``, ``goal``, ``state`` (``pursued``, ``suspended``, ``resumed``, ``achieved``, ``failed``,
            ``dropped``, ``recovered``: a plan for its failure has ended, ``replaced``: by the last goal of its plan, a tail
            call), ``id``, counted from 1, and of a failure ``why``.  A goal that failed and has a plan for its failure
            is pursued again under its number.
    """

    def __init__(self, tell: Tell) -> None:
        self._tell = tell
        self._numbers = count(1)
        self._goals: dict[tuple[str, int], _Goal] = {}  # by agent and identity

    def listen(self, host: AgentHost) -> None:
        """Hear of the goals of an agent from now on; agents written in Python have none."""
        if isinstance(host.mind, Agent):
            observe_goals(host.mind, partial(self, host.name))

    def __call__(self, agent: str, state: str, goal: str, which: object, why: str = "") -> None:
        """Be told by a mind, see `jacaros.bdi.meta_events.observe_goals`."""
        key = (agent, id(which))
        known = self._goals.get(key)
        if state == "finished":  # goals that were achieved are gone already
            if known is not None and known.state == "failed":
                del self._goals[key]
                return
            state = "recovered"
        elif state == "achieved" and why == "recovered":
            state, why = "recovered", ""
        if not goal.startswith("!") or (state not in _OPEN and state not in _OVER):
            return
        shown = _OPEN.get(state, state)
        if known is None:
            if state == "recovered":
                return
            known = self._goals[key] = _Goal(which, next(self._numbers), "")
            if len(self._goals) > _KEPT:
                del self._goals[next(iter(self._goals))]
        is_news = known.state != shown and not (known.state in _AT_WORK and shown in _AT_WORK)
        known.state = shown
        if is_news:
            told = {"agent": agent, "goal": goal, "state": shown, "id": known.number}
            self._tell({**told, "why": why} if why else told)
        if state in _OVER and state != "failed":  # one that failed may still be recovered
            del self._goals[key]
