"""Conditions on an agent, evaluated without effects and with limited search."""

from jacaros.asl import nodes
from jacaros.asl.loader import parse_formula
from jacaros.asl.walk import nodes_in
from jacaros.bdi.actions.internal_action import STANDARD
from jacaros.bdi.explaining.failing_context import holds
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.errors import UsageError


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
            if action is not None and not action.repeatable:
                raise UsageError(f"condition `{written}` calls `{call.name}`, which may have effects")

    def holds(self, agent: Circumstance) -> bool:
        """Return whether the formula holds now; False if it cannot be evaluated, or the search takes too long."""
        return holds(agent, self._formula)
