"""What an internal action is given: a narrow view of the agent that calls it."""

from collections.abc import Iterator
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import Names, lower_value
from jacaros.asl.walk import walk
from jacaros.bdi.architecture import Architecture
from jacaros.bdi.rules.functions import known_names
from jacaros.bdi.rules.query import solve_formula
from jacaros.bdi.rules.searching import run
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.plan import Plan
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Term

_SHORT, _KEPT = 200, 200
"""Characters of a text whose syntax is kept, and how many of them are."""
_CONSTANTS = (nodes.Literal, nodes.Number, nodes.String, nodes.ListTerm)


class Parsed:
    """A text that was read; short ones are kept, for agents read the same ones again and again.

    Attributes:
        node: its syntax.
        term: what it denotes, if it has neither variables nor anything to be evaluated; else None.
    """

    __slots__ = ("node", "term")

    def __init__(self, node: nodes.Term) -> None:
        self.node = node
        constant = all(isinstance(part, _CONSTANTS) for part in walk(node))
        self.term: Term = lower_value(node, Names().__getitem__) if constant else None


class Context:
    """First argument of every internal action.

    Attributes:
        agent: the agent, for actions about its beliefs, goals and plans.
        trail: where bindings are noted.
        parsed: texts that were read lately, by text and number of functions.
    """

    __slots__ = ("agent", "parsed", "trail")

    def __init__(self, agent: Circumstance) -> None:
        self.agent: Any = agent
        self.trail: Trail = agent.trail
        self.parsed: dict[tuple[str, int], Parsed] = {}

    @property
    def architecture(self) -> Architecture:
        """The agent's port to its host."""
        architecture: Architecture = self.agent.architecture
        return architecture

    @property
    def intention(self) -> Intention | None:
        """The intention whose step this is, or in a context the one that the plan would belong to; None for a new one."""
        current: Intention | None = self.agent.current
        return current

    def unify(self, left: Term, right: Term) -> bool:
        """Unify two terms; nothing stays bound when they do not."""
        mark = len(self.trail)
        if unify(left, right, self.trail):
            return True
        undo(self.trail, mark)
        return False

    def unify_all(self, *pairs: tuple[Term, Term]) -> bool:
        """Unify the terms of every pair; nothing stays bound when some do not."""
        mark = len(self.trail)
        if all(unify(left, right, self.trail) for left, right in pairs):
            return True
        undo(self.trail, mark)
        return False

    def answers(self, formula: Term) -> Iterator[None]:
        """The answers of a formula; its bindings hold until the next one is asked for."""
        for _ in run(solve_formula(self.agent, formula, self.trail), self.agent.options.rule_depth):
            yield

    def succeeds(self, formula: Term) -> bool:
        """Whether a formula holds; the bindings of its first answer stay."""
        return any(True for _ in self.answers(formula))

    def parse_term(self, text: str) -> Term:
        """The term that a text denotes; its variables are those of the plan where the names agree.

        Raises:
            AslError: the text is not a term.
        """
        agent = self.agent
        key = text, len(agent.functions.own)
        known: Parsed | None = self.parsed.get(key)
        if known is None:
            known = Parsed(parse_term(text, functions=known_names(agent)))
            if len(text) <= _SHORT:
                if len(self.parsed) >= _KEPT:
                    self.parsed.clear()
                self.parsed[key] = known
        return known.term if known.term is not None else lower_value(known.node, self._names().__getitem__)

    def _names(self) -> Names:
        """The variables of the running plan by their names."""
        names = Names()
        current = self.intention
        if current is not None and current.frames:
            frame = current.frames[-1]
            names.update({n: frame[s] for n, s in frame[4].slots.items() if frame[s] is not None})
        return names

    def report(self, action: str, fault: object) -> None:
        """Warn of an internal action that failed in a condition."""
        current = self.intention
        plan = (
            f" in plan {text(current.frames[-1][4].label)}" if current is not None and current.frames else ""
        )
        self.architecture.log(
            "warning", f"condition {action}{plan} does not hold because of an error: {fault}"
        )

    def report_plan(self, plan: Plan, fault: object) -> None:
        """Warn of a plan whose context cannot be evaluated; later plans are tried."""
        self.architecture.log("warning", f"cannot evaluate the context of plan {text(plan.label)}: {fault}")

    def suspendable(self) -> Intention:
        """The calling intention, for an action that returns what it waits for (`jacaros.bdi.state.pending.Waiting`)."""
        current = self.intention
        if current is None:
            raise RuntimeError("only the step of an intention can be suspended")
        return current
