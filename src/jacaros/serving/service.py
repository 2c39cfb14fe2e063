"""The service of a run to callers outside, the same for each door: sessions, goals, beliefs, questions and events."""

import asyncio
import secrets
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

from jacaros.agents.language.offers import OBSERVER, OPERATOR, USER, Offer
from jacaros.agents.mind.mind import Mind
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Annotated, String, Term, structure
from jacaros.look.records import records
from jacaros.look.records.records import Record
from jacaros.look.why.explanation import Explanation
from jacaros.look.why.story import story_of
from jacaros.look.why.tales import StoryLine
from jacaros.look.why.why import explain
from jacaros.runtime.clock import of_run, start_thread
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import aside, printable
from jacaros.runtime.mas.system import System
from jacaros.runtime.trace import Cause
from jacaros.serving import artifacts
from jacaros.serving.agent import OfferingAgent, OnFacts
from jacaros.serving.arguments import Arguments, Data, check_terms, fitting, literal_of, parsed, split_key
from jacaros.serving.callers import Allowance, Caller, RequestError, check_text
from jacaros.serving.console import Operator, soon
from jacaros.serving.goals import RequestedGoal
from jacaros.serving.questions import answers_of

T = TypeVar("T")
KEPT = 1_000
"""Number of goals that are kept after their end, for callers that ask about them later."""
MOST_ALIVE = 1_000
"""Maximum number of goals of one session that have not ended."""
REST = 4.0
"""Seconds between two explanations per second that the first one took."""

Event = Mapping[str, Any]
"""What happened, as JSON data; its ``event`` is ``goal``, ``announced``, ``agent_started`` or ``agent_ended``."""
OnEvent = Callable[[Event], None]


class Service:
    """What the agents of a run offer. All methods belong to the loop of the run.

    Args:
        system: the run; already started.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.agents: dict[str, OfferingAgent] = {}
        self.goals: dict[str, RequestedGoal] = {}
        self.sessions: dict[Session, None] = {}
        self._ended: deque[str] = deque()
        self._operator: Operator | None = None
        self._explaining = asyncio.Lock()
        self._rested_at = 0.0
        self._end_watch = system.directory.watch(self._agent_changed)
        for host in system.directory:
            self._agent_changed(host.name, True)
        system.when_ended(lambda _: self.close())
        system.keep_history()  # so that `why` knows who asked for what

    def open(self, caller: Caller) -> "Session":
        """Begin a session of a caller."""
        session = Session(self, caller)
        self.sessions[session] = None
        return session

    def close(self) -> None:
        """End all sessions: the run has ended, or is no longer served."""
        self._end_watch()
        agents = tuple(self.agents.values())
        self.agents.clear()
        for agent in agents:
            agent.close()
        for session in tuple(self.sessions):
            session.close()

    def _agent_changed(self, name: str, present: bool) -> None:
        host = self.system.directory.find(name) if present else None
        if host is not None and isinstance(host.mind, Mind) and host.mind.program.offers:
            self.agents[name] = OfferingAgent(host, self._announced)
            for session in tuple(self.sessions):
                session.agent_came(name)
        elif name in self.agents and not present:
            self.agents.pop(name).close()
        else:
            return
        self.tell({"event": f"agent_{'started' if present else 'ended'}", "agent": name}, lambda _: True)

    # ---- events

    def tell(self, event: Event, concerns: Callable[[Caller], bool]) -> None:
        """Tell all sessions that it concerns of an event."""
        for session in tuple(self.sessions):
            if session.listeners and concerns(session.caller):
                session.hear(event)

    def _announced(self, agent: OfferingAgent, offer: Offer, arguments: Mapping[str, Data]) -> None:
        event = {"event": "announced", "agent": agent.name, "name": offer.name, "arguments": dict(arguments)}
        self.tell(event, lambda caller: caller.may(offer))

    def goal_changed(self, goal: RequestedGoal) -> None:
        """A goal has changed: tell its caller, and operators."""
        owner = goal.caller
        concerned = [each for each in self.sessions if each.listeners and each.caller.sees(owner)]
        if concerned:
            told = {"event": "goal", **goal.data()}
            for session in concerned:
                session.hear(told)
        if goal.watcher is not None:
            goal.watcher()
        if not goal.over:
            return
        self._log(goal)
        agent = self.agents.get(goal.agent)
        if agent is not None:
            agent.ended(goal)
        self._ended.append(goal.id)
        if len(self._ended) > KEPT:
            self.goals.pop(self._ended.popleft(), None)

    def _log(self, goal: RequestedGoal) -> None:
        why = f": {goal.message}" if goal.message else ""
        level = {"failed": "warning", "refused": "info"}.get(goal.state, "debug")
        if goal.agent not in self.agents:
            level = "debug"  # there may be hundreds when an agent or the run ends
        told = f"{goal.state} !{goal.written} for {goal.caller}{why}"
        line = printable(told.replace("\n", " "))  # a caller must not be able to write lines of the log
        self.system.console.log(f"[{goal.agent}] {level}: {line}", level)

    # ---- requests

    def cause(self, caller: Caller, what: str) -> Cause | None:
        """Return the cause of what a request leads to, for `why`."""
        tracer = self.system.tracer
        return None if tracer is None else tracer.link("request", f"asked by {caller}: {what}")

    def note(self, caller: Caller, what: str) -> None:
        """Record what a caller has changed."""
        self.system.history().record(records.InterventionRecord(f"{caller}: {what}"))

    @property
    def operator(self) -> Operator:
        """What operators may do to any agent."""
        if self._operator is None:
            self._operator = Operator(self.system)
        return self._operator

    async def of_records(self, answer: Callable[[Iterable[Record]], T]) -> T:
        """Answer from the records of the run so far, in a thread; answers take at most a fifth of the time.

        Raises:
            RequestError: the question is not understood.
        """
        async with self._explaining:
            known = self.system.keep_history().all()
            try:
                return await start_thread(lambda: self._after_a_rest(lambda: answer(known)))
            except UsageError as error:
                raise RequestError("invalid_arguments", str(error).removeprefix("error: ")) from None

    def _after_a_rest(self, answer: Callable[[], T]) -> T:
        time.sleep(max(0.0, self._rested_at - time.monotonic()))
        begun = time.monotonic()
        try:
            return answer()
        finally:
            now = time.monotonic()
            self._rested_at = now + REST * (now - begun)


def service_of(system: System) -> Service:
    """Return the one service of a run, which all doors share. It is created on first use."""
    if not isinstance(system.service, Service):
        system.service = Service(system)
    return system.service


class _Watching:
    """Beliefs that a session watches, across restarts of the agent."""

    def __init__(self, agent: str, name: str, listener: OnFacts) -> None:
        self.agent, self.name, self.listener = agent, name, listener
        self.end: Callable[[], None] = lambda: None


class Session:
    """A caller's session. Each request has an effect, or raises `RequestError`.

    Args:
        service: the service of the run.
        caller: who asks.

    Attributes:
        listeners: called with each event that concerns the caller.
    """

    def __init__(self, service: Service, caller: Caller) -> None:
        self._service, self.caller = service, caller
        self.listeners: dict[OnEvent, None] = {}
        self._own: dict[str, RequestedGoal] = {}
        self._watched: dict[_Watching, None] = {}
        self._allowance = Allowance(time.monotonic)
        self.closed = False

    def close(self) -> None:
        """End the session. Goals whose offers say so are cancelled, the others continue."""
        if self.closed:
            return
        self.closed = True
        self.listeners.clear()
        for watching in self._watched:
            watching.end()
        self._watched.clear()
        for goal in tuple(self._own.values()):
            if not goal.over and goal.offer.when_left == "cancel":
                self._cancel(goal)
        self._service.sessions.pop(self, None)

    @contextmanager
    def _request(self, requests: float = 1.0) -> Iterator[None]:
        if self.closed:
            raise RequestError("ended", "the session, or the run, has ended")
        self._allowance.spend(requests)
        with of_run():  # what it starts pauses with the run
            yield

    # ---- what is offered

    def agents(self) -> list[str]:
        """Return the agents that offer something to the caller."""
        with self._request():
            return [
                each.name for each in self._service.agents.values() if any(map(self.caller.may, each.offers))
            ]

    def offers(self, agent: str, what: str = "") -> list[Offer]:
        """Return what an agent offers to the caller, of one kind or all."""
        with self._request():
            found = self._agent(agent).offers
            return [each for each in found if what in ("", each.what) and self.caller.may(each)]

    def _agent(self, name: str) -> OfferingAgent:
        found = self._service.agents.get(name)
        if found is None:
            raise RequestError("unknown_agent", f"no agent `{name[:80]}` offers anything")
        return found

    def _offers(self, agent: OfferingAgent, what: str, name: str, count: int | None = None) -> list[Offer]:
        """Return what is offered to the caller under a name, which may be a key such as ``deliver/2``."""
        if count is None:
            name, count = split_key(name)
        found = agent.find(what, name, count)
        permitted = [each for each in found if self.caller.may(each)]
        if permitted:
            return permitted
        size = "" if count is None else f"/{count}"
        if found:
            needed = " or ".join(sorted(found[0].roles))
            raise RequestError("not_permitted", f"the {what} `{name[:80]}{size}` needs the role {needed}")
        known = [each for each in agent.offers if each.what == what and self.caller.may(each)]
        forms = " or ".join(str(each) for each in known if each.name == name)
        help = f"; expected {forms}" if forms else aside(name[:80], (each.name for each in known))
        raise RequestError("not_offered", f"{agent.name} offers no {what} `{name[:80]}{size}`{help}")

    def _offer(self, agent: OfferingAgent, what: str, name: str, count: int | None = None) -> Offer:
        """Return the one offer of a name."""
        found = self._offers(agent, what, name, count)
        if len(found) == 1:
            return found[0]
        keys = " or ".join(f"`{each.key}`" for each in found)
        raise RequestError("invalid_arguments", f"ambiguous: the {what} `{name[:80]}` is {keys}")

    # ---- goals

    def achieve(self, agent: str, goal: str, arguments: Arguments | None = None) -> RequestedGoal:
        """Give an agent a goal that it offers.

        Args:
            agent: name of the agent.
            goal: name of the goal, ``deliver/2`` if several have that name; without arguments, text in the language.
            arguments: JSON data, by name or in order.
        """
        with self._request():
            offering = self._agent(agent)
            return self._give(offering, *self._requested(offering, "goal", goal, arguments))

    def _requested(
        self, agent: OfferingAgent, what: str, written: str, arguments: Arguments | None
    ) -> tuple[Offer, Sequence[Term]]:
        """Return the offer that a request is about, and its arguments as terms."""
        if arguments is None:
            written, terms, _ = parsed(written)
            if terms:
                offer = self._offer(agent, what, written, len(terms))
                check_terms(offer, terms)
                return offer, terms
        return fitting(self._offers(agent, what, written), arguments or ())

    def _give(self, agent: OfferingAgent, offer: Offer, arguments: Sequence[Term]) -> RequestedGoal:
        if len(self._own) >= MOST_ALIVE:
            raise RequestError("too_many_requests", f"{MOST_ALIVE} goals of this session have not ended")
        service = self._service
        goal = RequestedGoal(
            secrets.token_hex(8), agent.host, offer, arguments, self.caller, self._goal_changed
        )
        self._own[goal.id] = service.goals[goal.id] = goal
        agent.take(goal, service.cause(self.caller, f"!{goal.written} of {agent.name}"))
        return goal

    def _goal_changed(self, goal: RequestedGoal) -> None:
        if goal.over:
            self._own.pop(goal.id, None)
        self._service.goal_changed(goal)

    def goal(self, id: str) -> RequestedGoal:
        """Return a goal of the caller; an operator sees all."""
        with self._request():
            return self._goal(id)

    def _goal(self, id: str) -> RequestedGoal:
        found = self._service.goals.get(id)
        if found is None or not self.caller.sees(found.caller):
            raise RequestError("unknown_goal", f"no goal `{id[:80]}`")
        return found

    def goals(self) -> list[RequestedGoal]:
        """Return the goals of the caller, or all for an operator, the newest last."""
        with self._request():
            all_goals = self._service.goals.values()
            return [each for each in all_goals if self.caller.sees(each.caller)]

    def cancel(self, id: str) -> RequestedGoal:
        """Cancel a goal: its intention is dropped, and cleaned up. Cancelling is not limited: robots must stop."""
        with self._request(0.0):
            goal = self._goal(id)
            self._cancel(goal)
            return goal

    def _cancel(self, goal: RequestedGoal) -> None:
        if not goal.over:
            self._service.note(self.caller, f"cancels !{goal.written} of {goal.agent}")
            with of_run():
                goal.cancel()

    # ---- beliefs and questions

    def beliefs(self, agent: str, name: str) -> list[dict[str, Data]]:
        """Return the beliefs that an agent offers under a name."""
        with self._request():
            offering = self._agent(agent)
            return offering.facts(self._offer(offering, "belief", name))

    def watch(self, agent: str, name: str, listener: OnFacts) -> Callable[[], None]:
        """Call *listener* with the beliefs under a name now, and when they change. Return a function that ends this.

        An agent that ends and starts again is watched again.
        """
        watching = _Watching(agent, name, listener)
        with self._request():
            self._watch(watching)
        self._watched[watching] = None

        def stop() -> None:
            self._watched.pop(watching, None)
            watching.end()

        return stop

    def _watch(self, watching: _Watching, later: bool = False) -> None:
        offering = self._agent(watching.agent)
        offer = self._offer(offering, "belief", watching.name)
        watching.end = offering.watch(offer, watching.listener, later)

    def agent_came(self, name: str) -> None:
        """An agent has started: watch again what was watched of an earlier one, if it offers that, too."""
        for each in tuple(self._watched):
            if each.agent == name:
                with suppress(RequestError):
                    self._watch(each, later=True)

    def ask(self, agent: str, question: str, arguments: Arguments | None = None) -> list[dict[str, Data]]:
        """Ask an agent a question that it offers.

        Args:
            agent: name of the agent.
            question: name of the question; without arguments, text in the language, such as
                ``route(lab, To, Metres)``, which may also ask for a belief.
            arguments: JSON data, by name or in order.

        Returns:
            The results in each answer by name; for a text, the values of its variables.
        """
        with self._request():
            offering = self._agent(agent)
            if arguments is None:
                name, terms, asked = parsed(question)
                what = "question" if offering.find("question", name, len(terms)) else "belief"
                offer = self._offer(offering, what, name, len(terms))
                check_terms(offer, terms, open_inputs=True)
            else:
                offer, terms = fitting(self._offers(offering, "question", question), arguments)
                asked = {
                    each.name: term for each, term in zip(offer.parameters, terms, strict=True) if each.output
                }
            return answers_of(offering.mind, offer, terms, asked)

    def tell(self, agent: str, belief: str, arguments: Arguments | None = None, untell: bool = False) -> None:
        """Tell an agent a belief that it takes from callers, or take it back.

        Args:
            agent: name of the agent.
            belief: name of the belief; without arguments, text in the language.
            arguments: JSON data, by name or in order.
            untell: take it back.
        """
        with self._request():
            offering = self._agent(agent)
            self._tell(offering, literal_of(*self._requested(offering, "tell", belief, arguments)), untell)

    def _tell(self, agent: OfferingAgent, literal: Term, untell: bool) -> None:
        belief = Annotated(literal, (structure("source", String(str(self.caller))),))
        what, mind = f"{'untells' if untell else 'tells'} {agent.name} {text(literal)}", agent.mind
        self._service.note(self.caller, what)
        cause = self._service.cause(self.caller, what)
        soon(mind, lambda: (mind.untell if untell else mind.tell)(belief, cause))

    # ---- artifacts, and questions of agents to a person

    def artifacts(self) -> list[dict[str, str]]:
        """Return names, paths and types of all artifacts, to an operator."""
        with self._request():
            self.caller.require(OPERATOR)
            return artifacts.artifacts(self._service.system.environment)

    def questions(self) -> list[dict[str, Any]]:
        """Return the open questions of agents to a person."""
        with self._request():
            self.caller.require(OBSERVER)
            return artifacts.questions(self._service.system.environment)

    async def answer(self, id: str, given: str | int) -> None:
        """Answer a question to a person with a text, or with the number of an option."""
        with self._request():
            self.caller.require(USER)
            self._service.note(self.caller, f"answers question {id[:80]}: {str(given)[:200]}")
            await artifacts.answer(self._service.system.environment, id, given, self.caller.door)

    # ---- events and explanations

    def listen(self, listener: OnEvent) -> Callable[[], None]:
        """Call *listener* with each event that concerns the caller. Return a function that ends this."""
        with self._request():
            self.listeners[listener] = None
        return lambda: self.listeners.pop(listener, None) and None

    def hear(self, event: Event) -> None:
        """Pass an event to the listeners."""
        for listener in tuple(self.listeners):
            listener(event)

    async def why(self, question: str, at: float | None = None) -> Explanation:
        """Answer a question about the run, such as ``why did the robot stop``."""
        self._observe()
        check_text(question)
        return await self._service.of_records(lambda known: explain(known, question, at))

    async def story(self) -> Sequence[StoryLine]:
        """Tell the run so far."""
        self._observe()
        return await self._service.of_records(lambda known: story_of(known, is_over=False))

    def _observe(self) -> None:
        with self._request():
            self.caller.require(OBSERVER)

    # ---- what operators may do to any agent, whatever it offers

    def console(self, agent: str, line: str) -> str:
        """Execute a line of AgentSpeak for an agent, and return the answer as text.

        ``?Formula`` asks; ``!Goal`` posts a goal, and ``-!Goal`` drops it; ``+B``, ``-B`` and ``-+B`` change beliefs.
        """
        with self._operate():
            question, what = line.lstrip().startswith("?"), f"{agent[:80]}: {line[:200]}"
            cause = None if question else self._service.cause(self.caller, what)
            answer = self._service.operator.execute(agent, line, cause)
            if not question:
                self._service.note(self.caller, what)
            return answer

    def send(self, agent: str, performative: str, content: str) -> None:
        """Send an agent a message from ``you``; a restricted run takes no plans."""
        with self._operate():
            what = f"{performative} to {agent[:80]}: {content[:200]}"
            self._service.operator.send(agent, performative, content, self._service.cause(self.caller, what))
            self._service.note(self.caller, what)

    @contextmanager
    def _operate(self) -> Iterator[None]:
        with self._request():
            self.caller.require(OPERATOR)
            yield
