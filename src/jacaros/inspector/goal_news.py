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
_OVER = ("achieved", "failed", "dropped", "recovered")
_AT_WORK = ("pursued", "resumed")
_KEPT = 10_000
"""Goals whose end is waited for; the oldest are forgotten, for instance if a plan for their failure never ends."""


@dataclass(slots=True)
class _Goal:
    which: object
    number: int
    text: str
    state: str


class GoalNews:
    """Tells watchers of goals, from what minds tell of them.

    A mind tells that it works for a goal whenever a step of that has ended.  Goals that are open are kept, so that no
    other one can take their identity: numbers are the same in each run with one seed.

    Args:
        tell: takes ``agent``, ``goal``, ``state`` (``pursued``, ``suspended``, ``resumed``, ``achieved``, ``failed``,
            ``dropped``, ``recovered``: a plan for its failure has ended), ``id``, counted from 1, and of a failure ``why``.
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
        if state == "finished":  # goals that were achieved, or failed for good, are gone already
            state = "recovered"
        if not goal.startswith("!") or (state not in _OPEN and state not in _OVER):
            return
        key, shown = (agent, id(which)), _OPEN.get(state, state)
        known = self._goals.get(key)
        if known is None and state == "recovered":
            return
        if known is None or known.text != goal:
            known = self._goals[key] = _Goal(which, next(self._numbers), goal, "")
            if len(self._goals) > _KEPT:
                del self._goals[next(iter(self._goals))]
        is_news = not (known.state in _AT_WORK and shown in _AT_WORK)
        known.state = shown
        if is_news:
            told = {"agent": agent, "goal": goal, "state": shown, "id": known.number}
            self._tell({**told, "why": why} if why else told)
        if state in _OVER:
            del self._goals[key]
