"""The mind and the environment of an agent at a stack frame: bindings, beliefs, artifacts, the goal and its events."""

from collections.abc import Iterable, Mapping
from typing import Any

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.intention import EVENT_GOAL, GOAL
from jacaros.agents.mind.state.plan import Rule
from jacaros.agents.mind.state.triggers import literal_of
from jacaros.agents.terms.values import Functor, Term, structure
from jacaros.editors.dap.threads import Level
from jacaros.editors.dap.variables import Variable, Variables, plain
from jacaros.look.records.words import shown, shown_event
from jacaros.runtime.mas.debugging.conditions import bindings_of
from jacaros.runtime.mas.history.intentions import shown_goal, waits_for
from jacaros.runtime.mas.system import System
from jacaros.serving.artifacts import all_artifacts

NEWEST = 50
"""Number of events of a goal that are shown."""


class Scopes:
    """Makes the scopes of stack frames.

    Args:
        system: the run.
        variables: keeps their variables.
    """

    def __init__(self, system: System, variables: Variables) -> None:
        self._system, self._variables = system, variables

    def of(self, level: Level) -> list[dict[str, Any]]:
        """Return the scopes of a stack frame."""
        scopes = []
        mind, frame = level.host.mind, level.frame
        if frame is not None:
            bindings = bindings_of(frame)
            scopes.append(self._scope("Bindings", lambda: self._variables.terms(bindings), hint="locals"))
            scopes.append(self._scope("Goal", lambda: self._goal(level)))
        if isinstance(mind, Mind):
            scopes.append(self._scope("Beliefs", lambda: self._beliefs(mind)))
        scopes.append(self._scope("Artifacts", self._artifacts))
        if isinstance(mind, Mind):
            scopes.append(self._scope("Events", lambda: self._events(mind, level)))
        return scopes

    def _scope(self, name: str, make: Any, hint: str = "") -> dict[str, Any]:
        scope = {**self._variables.group(name, "", make), "expensive": False}
        del scope["value"]
        return scope | ({"presentationHint": hint} if hint else {})

    def _beliefs(self, mind: Mind) -> Iterable[Variable]:
        for symbol, table in sorted(mind.beliefs.items(), key=lambda each: (each[0].name, each[0].arity)):
            facts = [
                literal(symbol, entry, annotations) if isinstance(entry, tuple) else entry.head()
                for entry, annotations in table.entries()
                if not isinstance(entry, Rule)
            ]
            if facts:
                yield self._facts(symbol, facts)

    def _facts(self, symbol: Functor, facts: list[Term]) -> Variable:
        name = f"{'~' if symbol.negated else ''}{symbol.name}/{symbol.arity}"
        if len(facts) == 1:
            return self._variables.term(name, facts[0])

        def make() -> Iterable[Variable]:
            return (self._variables.term(str(number), fact) for number, fact in enumerate(facts, 1))

        return self._variables.group(name, f"{len(facts)} beliefs", make)

    def _artifacts(self) -> Iterable[Variable]:
        for workspace, artifact in all_artifacts(self._system.environment):

            def make(workspace: Any = workspace, artifact: Any = artifact) -> Iterable[Variable]:
                for each in workspace.properties(artifact):
                    values = (to_term(value, UNKEPT) for value in each.values)
                    yield self._variables.term(each.name, structure(each.name, *values))

            yield self._variables.group(artifact.path, artifact.type_name, make)

    def _goal(self, level: Level) -> Iterable[Variable]:
        intention, frame = level.intention, level.frame
        assert frame is not None
        yield {**self._variables.term("goal", literal_of(frame[GOAL], ())), "value": shown_goal(frame)}
        if intention is None:
            yield plain("state", "over")
            return
        yield plain("intention", str(intention.id))
        yield plain("state", intention.state)
        if intention.waiting is not None:
            yield plain("waits for", waits_for(intention.waiting))
        if intention.suspended is not None:
            yield plain("suspended because of", shown(intention.suspended))

    def _events(self, mind: Mind, level: Level) -> Iterable[Variable]:
        """Return the events that the agent has not handled yet, and what happened in the intention, the newest first."""
        for event in list(mind.events):
            yield plain("waiting", shown_event(event[EVENT_GOAL]))
        if level.intention is not None:
            number = level.intention.id
            own = [
                (t, words)
                for t, kind, data in self._system.history().events
                if data.get("agent") == mind.name and data.get("intention") == number
                if (words := _words(kind, data))
            ]
            yield from (plain(f"{t:.3f} s", words) for t, words in reversed(own[-NEWEST:]))


def _words(kind: str, data: Mapping[str, Any]) -> str:
    if kind == "goal":
        return f"{data['goal']} {data['state']}"
    if kind == "deliberation":
        return str(data["trigger"])
    return f"{data['op']}{data['belief']}" if kind == "belief" else ""
