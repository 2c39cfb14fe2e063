"""Records of the agents' goals: each change once, with unique numbers."""

from functools import partial
from itertools import count

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import goal_text
from jacaros.agents.mind.rules.meta_events import observe_goals
from jacaros.agents.mind.state.triggers import Goal, literal_of
from jacaros.agents.terms.substitution import is_ground
from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import named
from jacaros.runtime.mas.agents.host import AgentHost

_OPEN = {"executing": "pursued", "resumed": "resumed", "suspended": "suspended"}
_OVER = ("achieved", "dropped", "recovered", "replaced")
_AT_WORK = ("pursued", "resumed")


class _Goal:
    """An open goal. *settled* is the goal if it has no variables, so its text does not change."""

    # Not a dataclass, whose creation takes a millisecond.
    __slots__ = ("intention", "number", "settled", "state", "text")

    def __init__(self, number: int) -> None:
        self.number, self.intention = number, 0
        self.state = self.text = ""
        self.settled: Goal | None = None


class GoalRecords:
    """Records the goals of minds, and the work of Python agents.

    Goals are numbered in the order in which they begin, so the numbers are the same in each run with the same seed.

    A goal that failed and has a plan for its failure is pursued again under its number. For a Python agent, the goals are
    its ``run``, its operations and the running behaviours of its trees, all on one stack.

    Args:
        tell: takes each `records.GoalRecord`, with ids counted from 1.
    """

    def __init__(self, tell: RecordSink) -> None:
        self._tell = tell
        self._numbers = count(1)
        self._goals: dict[tuple[str, int], _Goal] = {}
        """Open goals, by agent and the mind's number."""
        self._newest: dict[str, int] = {}
        """By agent, the largest number of the mind so far."""

    def listen(self, host: AgentHost) -> None:
        """Observe the goals of an agent from now on."""
        if isinstance(host.mind, Mind):
            observe_goals(host.mind, partial(self, host.name))
            return
        from jacaros.runtime.mas.agents.python_agents import (
            PythonAgentHost,  # here: most runs have no agent in Python
        )

        if isinstance(host, PythonAgentHost):
            host.observe(_Work(self, host.name))

    def __call__(self, agent: str, state: str, goal: Goal, which: int, intention: int, why: str = "") -> None:
        """Record a change reported by a mind. See `jacaros.agents.mind.rules.meta_events.observe_goals`."""
        if goal[0].kind != "!" or state == "waiting":
            return
        known = self._goals.get((agent, which))
        if known is not None and known.settled is goal:
            self.take(agent, state, known.text, which, intention, why)
            return
        self.take(agent, state, f"!{goal_text(goal)}", which, intention, why)
        known = self._goals.get((agent, which))
        if known is not None and is_ground(literal_of(goal, ())):
            known.settled = goal

    def take(self, agent: str, state: str, goal: str, which: int, intention: int, why: str = "") -> None:
        """Record a change of anything that an agent pursues."""
        known = self._goals.get((agent, which))
        if state == "finished":
            if known is None:
                return
            if known.state == "failed":
                del self._goals[agent, which]
                return
            state = "dropped"  # its intention has ended without another report
        if state not in _OPEN and state not in _OVER and state != "failed":
            return
        shown = _OPEN.get(state, state)
        if known is None:
            # Ignore reports about finished goals, and the end of goals whose begin was not observed.
            if state not in _OPEN and (state != "failed" or which <= self._newest.get(agent, 0)):
                return
            known = self._goals[agent, which] = _Goal(next(self._numbers))
            self._newest[agent] = max(which, self._newest.get(agent, 0))
        is_news = known.state != shown and not (known.state in _AT_WORK and shown in _AT_WORK)
        known.state, known.text, known.intention = shown, goal, intention
        if is_news:
            self._tell(records.GoalRecord(agent, named(goal), shown, known.number, intention, why or None))
        if state in _OVER:
            del self._goals[agent, which]

    def drop(self, agent: str | None = None) -> None:
        """Record that the open goals of an agent, or of all agents, are dropped."""
        for (pursuer, which), goal in list(self._goals.items()):
            if agent in (None, pursuer):
                self.take(pursuer, "finished", goal.text, which, goal.intention)


class _Work:
    """Numbers what one Python agent works on."""

    def __init__(self, news: GoalRecords, agent: str) -> None:
        self._news, self._agent = news, agent
        self._numbers = count(1)
        self._at_work: dict[object, int] = {}

    def __call__(self, state: str, text: str, which: object, why: str) -> None:
        """Record a change reported by the agent. See `jacaros.artifacts.presence.presence.Observer`."""
        if state == "executing":
            self._at_work[which] = next(self._numbers)
        number = self._at_work.get(which)
        if number is None:
            return
        self._news.take(self._agent, state, text, number, 1, why)
        if state != "executing":
            self._news.take(self._agent, "finished", text, number, 1)
            del self._at_work[which]
