"""Conditions on an agent, evaluated without effects and with limited search."""

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_formula
from jacaros.agents.language.lowering import Names, lower
from jacaros.agents.language.nodes import nodes_in
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.rules.context import reading
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.errors import UsageError

MOST_STEPS = 1_000
"""Maximum number of steps of one evaluation, see `jacaros.agents.mind.rules.context.reading`."""


class Condition:
    """A formula about an agent.

    Args:
        written: the formula as text.

    Raises:
        AslError: the text is not a formula.
        UsageError: the formula calls an internal action of the language that has effects.
    """

    def __init__(self, written: str) -> None:
        self._formula = parse_formula(written)
        for call in nodes_in(nodes.InternalAction, self._formula):
            action = STANDARD.get(call.name)
            if action is not None and not action.pure:
                raise UsageError(f"condition `{written}` calls `{call.name}`, which may have effects")

    def holds(self, agent: Circumstance) -> bool:
        """Return whether the formula holds now; False if it cannot be evaluated, or the search takes too long."""
        try:
            with reading(agent, MOST_STEPS) as view:
                return any(True for _ in view.answers(lower(self._formula, Names().__getitem__)))
        except Exception:
            return False
