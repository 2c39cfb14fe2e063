"""An agent of a running system, for the Python code around it.

Literals, goals and formulae are text or data, see `jacaros.runtime.mas.embedding.given`.
"""

import asyncio
from collections.abc import Callable, Generator
from contextlib import closing
from functools import partial
from typing import Any

from jacaros.agents.body.values import to_value
from jacaros.agents.language.loader import parse_formula, parse_literal
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import belief_update, goals
from jacaros.agents.mind.rules.failure import told
from jacaros.agents.mind.rules.failure_reason import loss_of
from jacaros.agents.mind.rules.goals import WatchedCondition, WatchedGoal
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.belief_base import parts
from jacaros.agents.mind.storage import stored
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import is_ground, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import (
    BY_SELF,
    SOURCE_PERCEPT,
    Functor,
    String,
    Term,
    annotations_of,
    bare,
    deref,
)
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.embedding.given import Given, LiteralText, by_position, each_given, read_given
from jacaros.runtime.mas.embedding.notebook import agent_html
from jacaros.runtime.mas.embedding.waits import AgentEnded, GoalFailed, RunWaits


class OpenMind:
    """Changes and queries a mind.

    Changes reach the mind immediately; in the middle of a step (for example when an agent prints), before its next one.
    """

    @property
    def mind(self) -> Mind:
        """The agent itself, for what this class does not offer."""
        raise NotImplementedError

    # ---- changes

    def add_belief(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Add a belief, as the agent's own note unless the literal names a source. The event is external.

        Args:
            literal: text, or data: see `jacaros.runtime.mas.embedding.given`.
            arguments: plain values (see `jacaros.artifacts.env.values`), if *literal* is a name.
            values: plain values of variables in the text.

        Raises:
            AslError: the text is not a literal.
            UsageError: arguments follow a text that is not a name, or a value has no variable.
        """
        self._change(belief_update.tell, each_given(literal, arguments, values))

    def remove_belief(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Remove the agent's own note (or that of the named source) that matches first. Arguments: see `add_belief`."""
        self._change(belief_update.untell, each_given(literal, arguments, values))

    def replace_belief(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Replace the agent's own note with the same functor, as ``-+b`` does. Arguments: see `add_belief`."""
        self._change(_replace, [read_given(literal, arguments, values)])

    def post_goal(self, goal: object, /, *arguments: object, **values: object) -> None:
        """Add a goal, with an intention of its own. Arguments: see `add_belief`."""
        self._change(Mind.post_goal, [read_given(goal, arguments, values)])

    def drop_goal(self, goal: object, /, *arguments: object, **values: object) -> bool:
        """Drop the intentions and events of a goal, as ``.drop_desire`` does; return whether there were any."""
        given = read_given(goal, arguments, values)
        found = goals.intentions_for(self.mind, given.term) or goals.goal_events(self.mind, given.term)
        if found:
            self._change(goals.drop_desire, [given])
        return bool(found)

    def _change(self, change: Callable[[Mind, Term], object], literals: list[Given]) -> None:
        """Change the mind by each literal; before its next step if it has its turn now."""
        mind = self.mind

        def make(_: object = None) -> None:
            for each in literals:
                change(mind, each.term)

        if mind.running:
            mind.do_soon(make)
        else:
            make()
        mind.architecture.ready()

    def perceive(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Add a percept that lasts: a belief with ``source(percept)``. Arguments: see `add_belief`.

        Raises:
            ValueError: the literal has variables.
        """
        self._perceive("add", each_given(literal, arguments, values))

    def perceive_no_more(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Remove a percept that was added by `perceive`, written in the same way."""
        self._perceive("remove", each_given(literal, arguments, values))

    def signal(self, literal: object, /, *arguments: object, **values: object) -> None:
        """Add a percept that does not last: an event without a belief. Arguments: see `add_belief`."""
        self._perceive("signal", each_given(literal, arguments, values))

    def _perceive(self, kind: str, literals: list[Given]) -> None:
        percepts = []
        for each in literals:
            if not is_ground(each.term):
                raise ValueError(f"a percept must be ground: {each.text}")
            annotations = annotation_set((*annotations_of(each.term), SOURCE_PERCEPT))
            percepts.append(Percept(kind, bare(each.term), annotations))
        self.mind.perceive(percepts)

    # ---- queries

    def answers(self, formula: object, /, *arguments: object, **values: object) -> list[dict[str, Any]]:
        """Return all answers of a formula: plain values by name of the variables without a value.

        Args:
            formula: text (``battery(L) & L < Limit``), or a literal as for `add_belief`; None matches anything.
            arguments, values: as for `add_belief`, with the same errors.
        """
        return list(self._answers(read_given(formula, arguments, values, parse_formula)))

    def _answers(self, asked: Given) -> Generator[dict[str, Any], None, None]:
        mind = self.mind
        mark = len(mind.trail)
        try:
            yield from (values_of(asked.unknown) for _ in mind.context.answers(asked.term))
        finally:
            undo(mind.trail, mark)

    def ask(self, formula: object, /, *arguments: object, **values: object) -> dict[str, Any] | None:
        """Return the first answer of a formula, or None if it does not hold. Arguments: see `answers`."""
        return self._first(read_given(formula, arguments, values, parse_formula))

    def _first(self, asked: Given) -> dict[str, Any] | None:
        with closing(self._answers(asked)) as found:
            return next(found, None)

    def believes(self, formula: object, /, *arguments: object, **values: object) -> bool:
        """Return whether a formula holds. Arguments: see `answers`."""
        return self.ask(formula, *arguments, **values) is not None

    @property
    def beliefs(self) -> list[LiteralText]:
        """Return all beliefs with their annotations, as texts that can be given to an agent again."""
        return [LiteralText(each) for each in self.mind.beliefs.literals()]

    @property
    def goals(self) -> list[LiteralText]:
        """Return all goals that it pursues or is about to pursue, as texts without annotations."""
        return [LiteralText(bare(goal)) for goal, _ in goals.desires(self.mind)]


def _replace(mind: Mind, term: Term) -> None:
    symbol, _, annotations = parts(term)
    if symbol is not None:
        belief_update.delete_any(mind, symbol, annotations or BY_SELF)
    belief_update.tell(mind, term)


def literal(written: str) -> Term:
    """Parse a literal."""
    return lower_value(parse_literal(written))


def question(formula: str) -> tuple[Term, Variables]:
    """Parse a formula. Return its term and its variables by name."""
    asked = read_given(formula, parse=parse_formula)
    return asked.term, asked.unknown


def values_of(names: Variables) -> dict[str, Any]:
    """Return the current values of variables, by name."""
    return {name: to_value(resolve(value)) for name, value in names.items() if name[0] != "_"}


class PursuedGoal:
    """A goal that was given from outside."""

    def __init__(self, written: str, watched: WatchedGoal) -> None:
        self._written, self._watched = written, watched

    @property
    def achieved(self) -> bool:
        """Whether it was achieved."""
        return self._watched.achieved

    @property
    def failed(self) -> bool:
        """Whether it failed without a plan for its failure."""
        return self._watched.failed

    @property
    def state(self) -> str:
        """``achieved``, ``failed``, ``dropped``, ``suspended``, ``waiting``, or ``running``."""
        if self._watched.ended:
            return "achieved" if self.achieved else "failed"
        intentions = self._watched.intentions()
        return intentions[-1].state if intentions else "dropped"

    @property
    def reasons(self) -> list[Term]:
        """The reason terms of its failure."""
        return list(self._watched.reason.terms) if self._watched.reason is not None else []

    def __str__(self) -> str:
        why = f": {', '.join(map(text, self.reasons))}" if self.reasons else ""
        return f"!{self._written} ({self.state}{why})"


_RUN_TIME = "<run time>"
"""File name of goals that are not part of a program."""


class RunningAgent(OpenMind):
    """An agent of a running system. It can be given beliefs, percepts and goals, queried, and awaited.

    Args:
        host: its host.
        waits: waits of the run.
        end: ends the agent.

    Attributes:
        name: name of the agent.
    """

    def __init__(self, host: AgentHost, waits: RunWaits, end: Callable[[AgentHost], None]) -> None:
        self.name = host.name
        self._host = host
        self._waits = waits
        self._end = end

    @property
    def mind(self) -> Mind:
        """The agent itself, for what this class does not offer.

        Raises:
            RunEnded: the run has ended.
            AgentEnded: the agent has ended.
            UsageError: it is a Python agent, which has no beliefs and goals.
        """
        mind = self._host.mind
        self._waits.check()
        if self.ended:
            raise AgentEnded(f"agent {self.name} has ended")
        if mind is None:
            raise UsageError(f"agent {self.name} is a Python agent, which has no beliefs and goals")
        return mind

    @property
    def ended(self) -> bool:
        """Whether it has ended: killed, or with the run."""
        return self._host.ended

    def achieve(self, goal: object, /, *arguments: object, **values: object) -> "Goal":
        """Give it a goal, with an intention of its own. Await the returned goal to wait until it is achieved.

        Arguments and errors: see `add_belief`. ``achieve("check_in", name)`` never parses *name*.
        """
        return Goal(read_given(goal, arguments, values), self.mind, self._waits, lambda: self.ended)

    async def until(
        self, formula: object, /, *arguments: object, timeout: float | None = None, **values: object
    ) -> dict[str, Any]:
        """Wait until a formula holds for the agent, such as ``count(X) & X > 2``.

        It is evaluated whenever the agent has something to do, as by ``.wait(Formula)``.

        Args:
            formula, arguments, values: as for `answers`. A text may use rules of the program and internal actions.
            timeout: time limit in seconds of the run's clock. None: no limit.

        Returns:
            Plain values by name of the variables that are not given a value.

        Raises:
            AslError: the text is not a formula.
            TimeoutError: it did not hold in time. The text shows related beliefs.
            AgentEnded: the agent ended first.
            RunEnded: the run ended first.
        """
        mind = self.mind
        arguments, timeout = by_position(formula, arguments, "timeout", timeout)
        asked = read_given(formula, arguments, values, parse_formula)
        if not mind.running and (found := self._first(asked)) is not None:
            return found
        awaited = _Awaited(mind, asked)
        try:
            missing = partial(self._does_not_hold, asked)
            return await self._waits.wait(awaited.future, missing, timeout, self.name)
        finally:
            awaited.forget()

    def _does_not_hold(self, asked: Given) -> str:
        mentioned = {symbol.name for symbol in _functors(asked.term)}
        beliefs = self._host.mind.beliefs.literals() if self._host.mind is not None else ()
        believed = [
            text(bare(each))
            for each in beliefs
            if any(symbol.name in mentioned for symbol in _functors(each))
        ]
        related = f"it believes {', '.join(believed[:5])}" if believed else "it has no related belief"
        return f"{asked.text} did not hold for agent {self.name} ({related})"

    def stored(self) -> dict[str, Any]:
        """Return the complete state of the agent as JSON data. `Mas.add_agent` with ``stored=`` continues from it.

        Raises:
            NotStorable: the agent waits for a coroutine, a term contains a Python object, or Python code awaits a goal or
                condition of the agent.
            UsageError: the agent is in the middle of a step.
        """
        mind = self.mind
        if mind.running:
            raise UsageError(f"agent {self.name} is in the middle of a step; store it between two turns")
        return stored(mind)

    def kill(self) -> None:
        """Kill the agent: its operations are cancelled, other agents continue."""
        if not self.ended:
            self._end(self._host)

    def _repr_html_(self) -> str:
        return agent_html(repr(self), self._host.mind)

    def __repr__(self) -> str:
        return f"<agent {self.name}{' (ended)' if self.ended else ''}>"


class _Awaited:
    """A condition that Python code waits for."""

    def __init__(self, mind: Mind, asked: Given) -> None:
        self.future: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self._asked = asked
        self.forget = WatchedCondition(mind, asked.term, self._ended).forget

    def _ended(self, fault: Exception | None) -> None:
        if self.future.done():
            return
        if fault is None:
            self.future.set_result(values_of(self._asked.unknown))
        else:
            self.future.set_exception(UsageError(f"{self._asked.text} cannot be evaluated: {told(fault)}"))


class Goal(PursuedGoal):
    """A goal that Python code has given to a running agent. It can be awaited.

    ``await goal`` ends when the goal is achieved, and raises `GoalFailed` if it failed without a plan for its failure,
    or was dropped. A goal that is not awaited is pursued, too. Its failure is logged, like that of every goal.
    """

    def __init__(self, goal: Given, mind: Mind, waits: RunWaits, agent_ended: Callable[[], bool]) -> None:
        super().__init__(goal.text, WatchedGoal(mind, goal.term, self._news, self._news))
        self._mind = mind
        self._agent_ended = agent_ended
        self._waits = waits
        self._waiting: list[asyncio.Future[None]] = []
        self._awaited = False

    async def wait(self, timeout: float | None = None) -> None:
        """Wait until it is achieved.

        Args:
            timeout: time limit in seconds of the run's clock. After it, the goal is still pursued; see `drop`.

        Raises:
            GoalFailed: it failed without a plan for its failure, or was dropped.
            TimeoutError: it was not achieved in time.
            AgentEnded: the agent ended first.
            RunEnded: the run ended first.
        """
        self._awaited = True
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        if not self._watched.ended and self._agent_ended():
            await asyncio.sleep(0)  # the end of a run is reported one turn later
            self._waits.check()
            if self.state != "dropped":
                raise AgentEnded(f"{self._not_achieved()}: agent {self._mind.name} has ended")
        elif self._watched.intentions():
            self._waiting.append(future)
            await self._waits.wait(future, self._not_achieved, timeout, self._mind.name)
        if not self.achieved:
            raise self._failure()

    def __await__(self) -> Generator[Any, None, None]:
        return self.wait().__await__()

    def drop(self) -> None:
        """Drop the goal: its intentions are dropped, and their operations cancelled."""
        for intention in self._watched.intentions():
            goals.drop_intention(self._mind, intention)
        self._news()

    def _news(self) -> None:
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            if not future.done():
                future.set_result(None)
        if self.failed and not self._awaited:
            # A task that will await it may be about to begin.
            asyncio.get_running_loop().call_soon(self._tell_failure)

    def _tell_failure(self) -> None:
        if not self._awaited:
            self._mind.architecture.goal_lost()
            what, reason = f"the goal !{self._written}", self._watched.reason
            told = loss_of(what, reason).text() if reason is not None else f"{what} failed"
            self._mind.architecture.log("warning", told)

    def _not_achieved(self) -> str:
        return f"agent {self._mind.name} did not achieve !{self._written} (it is {self.state})"

    def _failure(self) -> GoalFailed:
        who = f"goal !{self._written} of agent {self._mind.name}"
        if not self.failed:
            return GoalFailed(f"{who} was dropped", self._written)
        reason = self._watched.reason
        if reason is None:
            return GoalFailed(f"{who} failed", self._written)
        message, where = reason.message(), reason.place.where()
        others = ", ".join(text(term) for term in reason.terms if not _is_message(term))
        told = f"{who} failed{f': {message}' * bool(message)}{f' ({others})' * bool(others)}"
        told += f", in {where}" * bool(where and where != _RUN_TIME)
        failed = GoalFailed(told, self._written, message, tuple(map(to_value, reason.annotations())))
        for candidate in reason.candidates:
            failed.add_note(candidate)
        return failed


def _is_message(term: Term) -> bool:
    return term.__class__ is tuple and term[0].name == "error_msg" and term[1].__class__ is String


def _functors(term: Any) -> list[Functor]:
    """Return all functors of a term, including those inside a formula."""
    term = bare(deref(term))
    if term.__class__ is Functor:
        return [term]
    if term.__class__ is not tuple:
        return []
    return [term[0], *(symbol for part in term[1:] for symbol in _functors(part))]
