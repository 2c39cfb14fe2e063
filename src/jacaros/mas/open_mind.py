"""Access to a mind from Python code, with literals, goals and formulae in the syntax of the language."""

from collections.abc import Callable, Sequence
from typing import Any

from jacaros.agents.body.values import to_value
from jacaros.agents.language.loader import parse_formula, parse_literal
from jacaros.agents.language.lowering import Names, lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import belief_update, goals
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.belief_base import parts
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import is_ground, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import BY_SELF, SOURCE_PERCEPT, Term, annotations_of, bare


class OpenMind:
    """Changes and queries a mind.

    Changes reach the mind immediately; in the middle of a step (for example when an agent prints), before its next one.
    """

    @property
    def mind(self) -> Mind:
        """The agent itself, for what this class does not offer."""
        raise NotImplementedError

    # ---- changes

    def add_belief(self, *literals: str) -> None:
        """Add beliefs, as the agent's own notes unless a literal names a source. The events are external.

        Raises:
            AslError: one is not a literal.
        """
        terms = [literal(each) for each in literals]

        def tell() -> None:
            for term in terms:
                belief_update.tell(self.mind, term)

        self._do(tell)

    def remove_belief(self, *literals: str) -> None:
        """Remove the agent's own notes (or those of the named source), the first match of each.

        Raises:
            AslError: one is not a literal.
        """
        terms = [literal(each) for each in literals]

        def untell() -> None:
            for term in terms:
                belief_update.untell(self.mind, term)

        self._do(untell)

    def replace_belief(self, written: str) -> None:
        """Replace the agent's own note with the same functor, as ``-+b`` does.

        Raises:
            AslError: it is not a literal.
        """
        term = literal(written)

        def replace() -> None:
            symbol, _, annotations = parts(term)
            if symbol is not None:
                belief_update.delete_any(self.mind, symbol, annotations or BY_SELF)
            belief_update.tell(self.mind, term)

        self._do(replace)

    def post_goal(self, written: str) -> None:
        """Add a goal, with an intention of its own.

        Raises:
            AslError: it is not a literal.
        """
        goal = literal(written)
        self._do(lambda: self.mind.post_goal(goal))

    def drop_goal(self, written: str) -> bool:
        """Drop the intentions and events of a goal, as ``.drop_desire`` does. Return whether there were any.

        Raises:
            AslError: it is not a literal.
        """
        goal = literal(written)
        found = bool(goals.intentions_for(self.mind, goal) or goals.goal_events(self.mind, goal))
        if found:
            self._do(lambda: goals.drop_desire(self.mind, goal))
        return found

    def _do(self, change: Callable[[], None]) -> None:
        mind = self.mind
        if mind.running:
            mind.do_soon(lambda _: change())
        else:
            change()
        mind.architecture.ready()

    def perceive(self, *literals: str) -> None:
        """Add percepts that last: beliefs with ``source(percept)``.

        Raises:
            AslError: one is not a literal.
            ValueError: one has variables.
        """
        self._perceive("add", literals)

    def perceive_no_more(self, *literals: str) -> None:
        """Remove percepts that were added by `perceive`, written in the same way."""
        self._perceive("remove", literals)

    def signal(self, *literals: str) -> None:
        """Add percepts that do not last: events without beliefs."""
        self._perceive("signal", literals)

    def _perceive(self, kind: str, literals: Sequence[str]) -> None:
        percepts = []
        for written in literals:
            term = literal(written)
            if not is_ground(term):
                raise ValueError(f"a percept must be ground: {written}")
            annotations = annotation_set((*annotations_of(term), SOURCE_PERCEPT))
            percepts.append(Percept(kind, bare(term), annotations))
        self.mind.perceive(percepts)

    # ---- queries

    def answers(self, formula: str) -> list[dict[str, Any]]:
        """Return all answers of a formula (``battery(L) & L < 20``): plain values by variable name.

        Raises:
            AslError: it is not a formula.
        """
        mind = self.mind
        term, names = question(formula)
        mark = len(mind.trail)
        try:
            return [values_of(names) for _ in mind.context.answers(term)]
        finally:
            undo(mind.trail, mark)

    def ask(self, formula: str) -> dict[str, Any] | None:
        """Return the first answer of a formula, or None if it does not hold.

        Raises:
            AslError: it is not a formula.
        """
        mind = self.mind
        term, names = question(formula)
        mark = len(mind.trail)
        try:
            return next((values_of(names) for _ in mind.context.answers(term)), None)
        finally:
            undo(mind.trail, mark)

    def believes(self, formula: str) -> bool:
        """Return whether a formula holds."""
        return self.ask(formula) is not None

    @property
    def beliefs(self) -> list[str]:
        """Return all beliefs with their annotations, as text."""
        return [text(each) for each in self.mind.beliefs.literals()]

    @property
    def goals(self) -> list[str]:
        """Return all goals that it pursues or is about to pursue, as text without annotations."""
        return [text(bare(goal)) for goal, _ in goals.desires(self.mind)]

    @property
    def intentions(self) -> list[list[str]]:
        """Return the goals of each intention, the first one first, as text without annotations."""
        stacks = [
            [text(bare(goal)) for goal in reversed(goals.goal_literals(intention))]
            for intention in self.mind.alive.values()
        ]
        return [stack for stack in stacks if stack]


def literal(written: str) -> Term:
    """Parse a literal."""
    return lower_value(parse_literal(written))


def question(formula: str) -> tuple[Term, Names]:
    """Parse a formula. Return its term and its variables by name."""
    names = Names()
    return lower_value(parse_formula(formula), names.__getitem__), names


def values_of(names: Names) -> dict[str, Any]:
    """Return the current values of variables, by name."""
    return {name: to_value(resolve(value)) for name, value in names.items() if name[0] != "_"}
