"""A mind that Python code talks to and looks into, with literals, goals and formulae written as in the language."""

from collections.abc import Callable, Sequence
from typing import Any

from jacaros.asl.loader import parse_formula, parse_literal
from jacaros.asl.lowering import Names, lower_value
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import belief_update, goals
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import parts
from jacaros.body.values import to_value
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import is_ground, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF, SOURCE_PERCEPT, Term, annotations_of, bare


class OpenMind:
    """Gives things to a mind and asks it.

    What is given reaches the mind at once; if it is in the middle of a step (as when an agent prints), before its next one.
    """

    @property
    def mind(self) -> Mind:
        """The agent itself, for what this class does not offer."""
        raise NotImplementedError

    # ---- giving

    def add_belief(self, *literals: str) -> None:
        """Let the agent believe something, as its own note unless the literal names a source; the events are external.

        Raises:
            AslError: it is no literal.
        """
        terms = [literal(each) for each in literals]

        def tell() -> None:
            for term in terms:
                belief_update.tell(self.mind, term)

        self._do(tell)

    def remove_belief(self, *literals: str) -> None:
        """Take the agent's own notes (or what the named source told) away; the first match of each.

        Raises:
            AslError: it is no literal.
        """
        terms = [literal(each) for each in literals]

        def untell() -> None:
            for term in terms:
                belief_update.untell(self.mind, term)

        self._do(untell)

    def replace_belief(self, written: str) -> None:
        """Put a belief in the place of the agent's own note with the same functor, as ``-+b`` does.

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
        """Give the agent a goal, with an intention of its own.

        Raises:
            AslError: it is not a literal.
        """
        goal = literal(written)
        self._do(lambda: self.mind.post_goal(goal))

    def drop_goal(self, written: str) -> bool:
        """Drop the intentions and events for a goal, as ``.drop_desire`` does; return whether there are any.

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
        """Let the agent perceive something from now on: beliefs with ``source(percept)``.

        Raises:
            AslError: it is no literal.
            ValueError: it has variables.
        """
        self._perceive("add", literals)

    def perceive_no_more(self, *literals: str) -> None:
        """End percepts that were given by `perceive`; written as they were."""
        self._perceive("remove", literals)

    def signal(self, *literals: str) -> None:
        """Let the agent notice something that does not last: an event, no belief."""
        self._perceive("signal", literals)

    def _perceive(self, kind: str, literals: Sequence[str]) -> None:
        percepts = []
        for written in literals:
            term = literal(written)
            if not is_ground(term):
                raise ValueError(f"a percept has no variables: {written}")
            annotations = annotation_set((*annotations_of(term), SOURCE_PERCEPT))
            percepts.append(Percept(kind, bare(term), annotations))
        self.mind.perceive(percepts)

    # ---- asking

    def answers(self, formula: str) -> list[dict[str, Any]]:
        """All answers of a formula (``battery(L) & L < 20``): values by the names of its variables, as plain values.

        Raises:
            AslError: it is no formula.
        """
        mind = self.mind
        term, names = question(formula)
        mark = len(mind.trail)
        try:
            return [values_of(names) for _ in mind.context.answers(term)]
        finally:
            undo(mind.trail, mark)

    def ask(self, formula: str) -> dict[str, Any] | None:
        """The first answer of a formula; None when it does not hold.

        Raises:
            AslError: it is no formula.
        """
        mind = self.mind
        term, names = question(formula)
        mark = len(mind.trail)
        try:
            return next((values_of(names) for _ in mind.context.answers(term)), None)
        finally:
            undo(mind.trail, mark)

    def believes(self, formula: str) -> bool:
        """Whether a formula holds."""
        return self.ask(formula) is not None

    @property
    def beliefs(self) -> list[str]:
        """All beliefs with their annotations, as text."""
        return [text(each) for each in self.mind.beliefs.literals()]

    @property
    def goals(self) -> list[str]:
        """All goals that it pursues or is about to, as text without annotations."""
        return [text(bare(goal)) for goal, _ in goals.desires(self.mind)]

    @property
    def intentions(self) -> list[list[str]]:
        """The goals of each intention, the one that it began with first, as text without annotations."""
        stacks = [
            [text(bare(goal)) for goal in reversed(goals.goal_literals(intention))]
            for intention in self.mind.alive.values()
        ]
        return [stack for stack in stacks if stack]


def literal(written: str) -> Term:
    """The term of a literal in a text."""
    return lower_value(parse_literal(written))


def question(formula: str) -> tuple[Term, Names]:
    """The term of a formula in a text, and its variables by name."""
    names = Names()
    return lower_value(parse_formula(formula), names.__getitem__), names


def values_of(names: Names) -> dict[str, Any]:
    """The values that variables have now, by name."""
    return {name: to_value(resolve(value)) for name, value in names.items() if name[0] != "_"}
