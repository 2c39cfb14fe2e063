"""One agent as callers outside meet it: what it offers, the goals they gave it, and what they watch."""

from collections import deque
from collections.abc import Callable

from jacaros.agents.language.offers import Offer
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.intention import GOAL, Intention
from jacaros.agents.terms.values import Term, Var, atom, bare
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.history.history import observe_turns
from jacaros.runtime.trace import Cause
from jacaros.serving.arguments import Data, named
from jacaros.serving.callers import RequestError
from jacaros.serving.goals import CANCELLING, WAITING, RequestedGoal
from jacaros.serving.questions import answers_of

PERIOD = 0.05
"""Seconds of the run's clock between two looks at watched beliefs."""
MOST_WAITING = 1_000
"""Maximum number of goals that wait for their turn."""
Facts = list[dict[str, Data]]
"""Beliefs of one offer as data: the arguments of each by name."""
OnFacts = Callable[[Facts], None]


class Watch:
    """What is watched of one offered belief.

    Attributes:
        facts: the beliefs when they were last looked at.
        listeners: called with the beliefs whenever they have changed.
    """

    def __init__(self, offer: Offer, facts: Facts) -> None:
        self.offer, self.facts = offer, facts
        self.listeners: dict[OnFacts, None] = {}


class OfferingAgent:
    """An agent that offers something. It is the mind's `jacaros.agents.mind.state.act.Callers`.

    Args:
        host: the agent.
        announce: called with each event that it announces: its offer and arguments.

    Attributes:
        name: its name.
        offers: what it offers.
        alive: goals of callers that have not ended.
    """

    def __init__(
        self, host: AgentHost, announce: "Callable[[OfferingAgent, Offer, dict[str, Data]], None]"
    ) -> None:
        assert host.mind is not None
        self.name, self.host = host.name, host
        self.offers: tuple[Offer, ...] = host.mind.program.offers
        self.alive: dict[str, RequestedGoal] = {}
        self._announce = announce
        self._queue: deque[tuple[RequestedGoal, Cause | None]] = deque()
        self._watched: dict[str, Watch] = {}
        self._looks_soon = False
        host.mind.observers.callers = self
        self._end_turns = observe_turns(host, self._look_soon)

    @property
    def mind(self) -> Mind:
        """Its mind."""
        assert self.host.mind is not None
        return self.host.mind

    def find(self, what: str, name: str, count: int | None = None) -> list[Offer]:
        """Return what it offers of a kind under a name, with this number of arguments."""
        return [
            each
            for each in self.offers
            if each.what == what and each.name == name and count in (None, len(each.parameters))
        ]

    def close(self) -> None:
        """The agent has ended, or is no longer served."""
        self._end_turns()
        self.mind.observers.callers = None
        for each in tuple(self.alive.values()):
            each.agent_ended()
        self._watched.clear()

    # ---- goals

    def take(self, goal: RequestedGoal, cause: Cause | None) -> None:
        """Take a goal: pursue it now, later, or not at all, as the offer says."""
        limit = goal.offer.at_most
        busy = [] if limit is None else self._busy_with(goal.offer)
        self.alive[goal.id] = goal
        if limit is None or len(busy) < limit:
            goal.post(cause)
        elif goal.offer.when_busy == "replace":
            self._queue.appendleft((goal, cause))
            goal.queue()
            self._replace_for(goal)
        elif goal.offer.when_busy == "wait" and len(self._queue) < MOST_WAITING:
            self._queue.append((goal, cause))
            goal.queue()
        else:
            goal.refuse(
                atom("busy"), f"{self.name} is busy with {len(busy)} of these goals, as many as it takes"
            )

    def ended(self, goal: RequestedGoal) -> None:
        """A goal has ended: the next one that waits has its turn."""
        self.alive.pop(goal.id, None)
        if not self._queue:
            return
        waiting = [each for each in self._queue if each[0].state == WAITING]
        following = next((each for each in waiting if each[0].offer is goal.offer), None)
        if following is not None and len(self._busy_with(goal.offer)) >= (goal.offer.at_most or 0):
            following = None
        self._queue = deque(each for each in waiting if each is not following)
        if following is not None:
            following[0].post(following[1])

    def _replace_for(self, goal: RequestedGoal) -> None:
        """Cancel the oldest goal of the same offer, which may still wait for its own turn."""
        for each in self.alive.values():
            if each.offer is goal.offer and each is not goal and each.state != CANCELLING:
                each.cancel()
                return

    def _busy_with(self, offer: Offer) -> list[RequestedGoal]:
        return [each for each in self.alive.values() if each.offer is offer and each.state != WAITING]

    def _look_soon(self) -> None:
        if self._watched and not self._looks_soon:
            self._looks_soon = True
            self.host.system.clock.call_later(PERIOD, self._look)

    def _goal_of(self, intention: Intention) -> RequestedGoal | None:
        bottom = intention.frames[0][GOAL] if intention.frames else None
        return next((each for each in self.alive.values() if each.identity == bottom), None)

    # ---- called by the mind

    def accepted(self, intention: Intention) -> None:
        """The plan of a goal accepts it."""
        goal = self._goal_of(intention)
        if goal is not None:
            goal.accept()

    def progressed(self, intention: Intention, fraction: float, note: str) -> None:
        """The plan of a goal says how far it is."""
        goal = self._goal_of(intention)
        if goal is not None:
            goal.tell(fraction, note)

    def announced(self, event: Term) -> None:
        """The agent announces an event that it offers."""
        term = bare(event)
        symbol, *arguments = term if term.__class__ is tuple else (term,)
        for offer in self.find("event", symbol.name, len(arguments)):
            self._announce(self, offer, named(offer, arguments))

    # ---- beliefs

    def facts(self, offer: Offer) -> Facts:
        """Return the beliefs that an offer is about."""
        asked = {each.name: Var() for each in offer.parameters}
        return answers_of(self.mind, offer, [*asked.values()], asked)

    def watch(self, offer: Offer, listener: OnFacts, later: bool = False) -> Callable[[], None]:
        """Call *listener* with the beliefs that an offer is about, now and when they change. Return what ends this.

        Args:
            later: whether the agent has just started: it has no beliefs yet, and is looked at soon.
        """
        watch = self._watched.get(offer.key)
        if watch is None:
            watch = self._watched[offer.key] = Watch(offer, [] if later else self.facts(offer))
            if later:
                self._look_soon()
        watch.listeners[listener] = None
        listener(watch.facts)

        def end() -> None:
            watch.listeners.pop(listener, None)
            if not watch.listeners and self._watched.get(offer.key) is watch:
                del self._watched[offer.key]

        return end

    def _look(self) -> None:
        self._looks_soon = False
        if self.host.ended:
            return
        for watch in tuple(self._watched.values()):
            try:
                facts = self.facts(watch.offer)
            except RequestError:  # a computer that is busy, or a rule that takes long
                self._look_soon()
                continue
            if facts != watch.facts:
                watch.facts = facts
                for listener in tuple(watch.listeners):
                    listener(facts)
