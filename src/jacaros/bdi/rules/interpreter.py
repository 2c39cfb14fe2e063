"""Run plans and rules as the language defines them, without code made for speed."""

from collections.abc import Mapping, Sequence
from typing import Any

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.rules.applicable_plans import Selection
from jacaros.bdi.rules.body_steps import interpreted
from jacaros.bdi.rules.query import interpret_rule
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.engine import Every, Select
from jacaros.bdi.state.intention import NextStep
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.rule import Answers, Rule
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Term


class Interpreter:
    """Runs plans and rules, see `jacaros.bdi.state.engine.Engine`.

    Args:
        actions: the internal actions that plans may call.
    """

    def __init__(self, actions: Mapping[str, InternalAction]) -> None:
        self.actions = actions

    def begin(self, agent: Circumstance) -> None:
        """Do nothing: nothing needs preparation."""

    def compile_ahead(self, program: Any) -> bool:
        """False: nothing is compiled."""
        del program
        return False

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """Return the selection among plans for one kind of event."""
        del trigger
        return Selection(plans, outer)

    def every(self, trigger: Trigger, plans: Sequence[Plan]) -> Every:
        """Return the same for all applicable plans."""
        del trigger
        return Selection(plans).every

    def give_steps(self, plan: Plan) -> None:
        """Give steps to a plan made from a body at run time."""
        interpreted(plan)

    def step_at(self, plan: Plan, position: str) -> NextStep:
        """Return the step at a position (`jacaros.bdi.state.plan.position_of`); generated code has the same numbers."""
        return interpreted(plan).by_name[f"step_{position[1:]}"]

    def answers(self, agent: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """Return the answers of a rule."""
        return interpret_rule(agent, rule.node, arguments, trail)

    def searches(self, predicate: Any) -> tuple[Any, Any] | None:
        """None: rules are called one by one."""
        del predicate
        return None
