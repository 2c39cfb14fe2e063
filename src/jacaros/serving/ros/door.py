"""The door of a run to the ROS graph."""

import inspect
import json
import re
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

from jacaros.agents.language.offers import USER, Offer
from jacaros.robots.mapping.offer_codec import OfferCodec
from jacaros.robots.ros.action import ActionPolicy, ServerGoal
from jacaros.robots.ros.errors import MessageMismatch, RosError
from jacaros.robots.ros.qos import LATCHED
from jacaros.runtime.clock import Timer, of_run
from jacaros.runtime.mas.ros_graph import node_name
from jacaros.runtime.mas.system import System
from jacaros.serving.agent import Facts
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.ros.forms import (
    MISMATCH,
    AchieveForm,
    Fields,
    GoalForm,
    MappedForm,
    facts_as_json,
    newest_fact,
    wrong_names,
)
from jacaros.serving.ros.pursuit import Pursuits
from jacaros.serving.service import Session, service_of

ANONYMOUS = "anonymous"
"""Name of callers whose node is unknown: only ROS 1 reports it, with a goal."""
MOST_CALLERS = 100
"""Maximum number of callers with a session of their own; further ones count as `ANONYMOUS`."""
LOOKING, LOOKED_AT = 0.2, 50
"""Seconds of the run's clock between two looks at what agents do for goals, and the maximum number of goals in each."""
STRING = "std_msgs/msg/String"
_ROS1_GOAL = re.compile(r"(/[A-Za-z0-9_/]+)(?:-[0-9a-f]{8})?-\d+-[\d.]+")
"""Goal ids of actionlib: name of the node, for nodes of JaCaROS their run, a number, and the time."""


def caller_of(goal_id: str) -> str:
    """Return the name of the node that has sent a goal, as far as its id shows it."""
    found = _ROS1_GOAL.fullmatch(goal_id)
    return found[1] if found is not None else ANONYMOUS


class RosDoor:
    """Offers in the ROS graph what the agents of a run offer to callers.

    Args:
        system: the run.
        codecs: the messages of offers that do not use the general ones, by the name of the offer.
        roles: roles of all callers.

    Attributes:
        active: whether goals are accepted.
        now: returns the time of the run.
    """

    def __init__(
        self,
        system: System,
        codecs: Mapping[str, OfferCodec] | None = None,
        roles: Collection[str] = (USER,),
    ) -> None:
        self.active = True
        self._system, self._backend = system, system.ros.backend()
        self._codecs, self._roles = dict(codecs or {}), frozenset(roles)
        self._service = service_of(system)
        self._sessions: dict[str, Session] = {}
        self.now = system.clock.now
        self._pursuits = Pursuits(self.now, self.warn)
        self._looking: Timer | None = None
        self._agents: dict[str, AgentEndpoints] = {}
        for name in self.session(ANONYMOUS).agents():
            self._agent_came(name)
        for name in sorted(
            set(self._codecs) - {each.name for end in self._agents.values() for each in end.offers}
        ):
            self.warn(f"no agent offers `{name}`, which a mapping file describes")
        self._end_watch = system.directory.watch(self._agent_changed)
        system.when_ended(lambda _: self.close())

    def close(self) -> None:
        """Withdraw everything from the graph. Goals go on, or are cancelled, as their offers say."""
        self._end_watch()
        if self._looking is not None:
            self._looking.cancel()
        for endpoints in tuple(self._agents.values()):
            endpoints.close()
        self._agents.clear()
        for session in tuple(self._sessions.values()):
            session.close()
        self._sessions.clear()

    def session(self, name: str = ANONYMOUS) -> Session:
        """Return the session of a caller."""
        if name not in self._sessions and len(self._sessions) > MOST_CALLERS:
            name = ANONYMOUS
        found = self._sessions.get(name)
        if found is None:
            found = self._sessions[name] = self._service.open(Caller(name, "ros", self._roles))
        return found

    def warn(self, text: str) -> None:
        """Log a warning."""
        self._system.console.log(f"[ros] warning: {text}", "warning")

    def _agent_changed(self, name: str, present: bool) -> None:
        if present:
            self._agent_came(name)
        elif name in self._agents:
            self._agents.pop(name).close()

    def _agent_came(self, name: str) -> None:
        if name not in self._agents and name in self.session().agents():
            self._agents[name] = found = AgentEndpoints(self, name)
            offered = ", ".join(each.name for each in found.offers if each.what in ("goal", "belief"))
            place = self._backend.resolve(node_name(name))
            self._system.console.log(f"[ros] note: {name} offers {offered or 'answers'} below {place}")

    # ---- what endpoints are made of

    def serve_goals(self, topic: str, form: GoalForm) -> Callable[[], None]:
        """Offer an action. Return a function that withdraws it."""

        async def execute(served: ServerGoal) -> Fields | None:
            with of_run():
                self._look_later()
                session = self.session(caller_of(served.goal_id))
                return await self._pursuits.pursue(served, session, form, lambda: server.abandoned)

        policy = ActionPolicy(accept=lambda _: None if self.active else "the agents are not active")
        server = self._backend.action_server(topic, form.type_name, execute, policy)
        return server.close

    def _look_later(self) -> None:
        if self._looking is None:
            self._looking = self._system.clock.call_later(LOOKING, self._look)

    def _look(self) -> None:
        self._looking = None
        with of_run():
            self._pursuits.look(LOOKED_AT)
        if self._pursuits:
            self._look_later()

    def serve(self, name: str, kind: str, answer: Callable[[Any], Any]) -> Callable[[], None]:
        """Offer a service of the package ``jacaros_interfaces``. Return a function that withdraws it."""

        async def handle(request: Any) -> Fields:
            try:
                with of_run():
                    found = answer(request)
                    return {"success": True, **(await found if inspect.isawaitable(found) else found)}
            except RequestError as error:
                return {"success": False, "message": f"{error.code}: {error.message}"}

        return self._backend.service(name, f"jacaros_interfaces/srv/{kind}", handle).close

    def publish(self, topic: str, agent: str, offer: Offer, codec: OfferCodec | None) -> Callable[[], None]:
        """Publish a belief as a latched topic. Return a function that withdraws it."""
        fields = facts_as_json if codec is None else newest_fact(codec, self.now)
        type_name = STRING if codec is None else codec.part.type_name.text
        publisher = self._backend.publisher(topic, type_name, LATCHED)

        def publish(facts: Facts) -> None:
            try:
                if (found := fields(facts)) is not None:
                    publisher.publish(publisher.message(**found))
            except (MessageMismatch, *MISMATCH) as error:
                self.warn(f"[{agent}] the belief {offer.key} does not fit topic {topic}: {error}")

        end = self.session().watch(agent, offer.key, publish)

        def close() -> None:
            end()
            publisher.close()

        return close

    def codec_of(self, offer: Offer) -> OfferCodec | None:
        """Return the messages that a mapping file names for an offer. Raises `RosError` if they do not fit it."""
        codec = self._codecs.get(offer.name)
        if codec is None or codec.part.is_action != (offer.what == "goal"):
            return None
        if wrong := wrong_names(offer, codec):
            raise RosError(f"{'; '.join(wrong)} (mapping of `{offer.name}`)")
        return codec


class AgentEndpoints:
    """Actions, topics and services of one agent: ``AGENT/GOAL``, ``AGENT/achieve``, ``AGENT/BELIEF``, ``AGENT/ask``,
    ``AGENT/tell`` and ``AGENT/why``.

    Args:
        door: the door.
        agent: name of the agent.

    Attributes:
        offers: what the agent offers to callers of the door.
    """

    def __init__(self, door: RosDoor, agent: str) -> None:
        self._door, self._agent = door, agent
        self._prefix = node_name(agent)
        self._ends: list[Callable[[], None]] = []
        self.offers = door.session().offers(agent)
        first = {(each.what, each.name): each for each in reversed(self.offers)}
        for (what, _), offer in reversed(first.items()):
            if what in ("goal", "belief"):
                self._open(f"`{offer.name}`", partial(self._goal if what == "goal" else self._belief, offer))
        if ("goal", "achieve") not in first and any(what == "goal" for what, _ in first):
            self._open("`achieve`", lambda: door.serve_goals(f"{self._prefix}/achieve", AchieveForm(agent)))
        for name, answer in (("ask", self._ask), ("tell", self._tell), ("why", self._why)):
            self._open(name, partial(door.serve, f"{self._prefix}/{name}", name.capitalize(), answer))

    def close(self) -> None:
        """Withdraw everything."""
        for end in self._ends:
            end()
        self._ends.clear()

    def _open(self, what: str, make: Callable[[], Callable[[], None]]) -> None:
        try:
            self._ends.append(make())
        except RosError as error:
            self._door.warn(f"[{self._agent}] {what} is not offered: {error}")

    def _name(self, offer: Offer, codec: OfferCodec | None) -> str:
        named = codec.part.target.text if codec is not None else ""
        return named or f"{self._prefix}/{offer.name}"

    def _goal(self, offer: Offer) -> Callable[[], None]:
        codec = self._door.codec_of(offer)
        form: GoalForm = AchieveForm(self._agent, offer.name)
        if codec is not None:
            form = MappedForm(self._agent, codec, self._door.now)
        return self._door.serve_goals(self._name(offer, codec), form)

    def _belief(self, offer: Offer) -> Callable[[], None]:
        codec = self._door.codec_of(offer)
        return self._door.publish(self._name(offer, codec), self._agent, offer, codec)

    def _ask(self, request: Any) -> Fields:
        answers = self._door.session().ask(self._agent, request.question)
        return {"answers": json.dumps(answers, ensure_ascii=False)}

    def _tell(self, request: Any) -> Fields:
        self._door.session().tell(self._agent, request.belief, untell=request.untell)
        return {}

    async def _why(self, request: Any) -> Fields:
        return {"explanation": (await self._door.session().why(request.question)).text()}
