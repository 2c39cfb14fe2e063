"""Units of generated code, made into functions."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, cast

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.unit import Written, write_rule, write_search, write_select
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.rule import Rule
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import Functor

Function = Callable[..., Any]


class Units:
    """Makes functions of plans and rules.

    Args:
        actions: the internal actions that they may call.
    """

    def __init__(self, actions: Mapping[str, InternalAction]) -> None:
        self.actions = actions

    def select(
        self, kind: Trigger, plans: Sequence[Plan], outer: Plan | None = None, every: bool = False
    ) -> Function:
        """The select function of an event kind, see `jacaros.bdi.fast.generated.unit.write_select`."""
        return executed(write_select(kind, plans, self.actions, outer, every))

    def search(
        self, symbol: Functor, pattern: int, before: Sequence[Rule], after: Sequence[Rule], trampoline: bool
    ) -> Function:
        """The generator function of a predicate for one pattern of use, see `jacaros.bdi.fast.generated.predicates`."""
        first, last = [rule.node for rule in before], [rule.node for rule in after]
        return executed(write_search(symbol, pattern, first, last, self.actions, trampoline))

    def rule(self, rule: Rule) -> Function:
        """The generator function of a rule."""
        return executed(write_rule(rule.node, self.actions))


def executed(made: Written) -> Function:
    """The function of a unit, which is executed; its plans have their steps afterwards."""
    names = made.unit.globals
    for part in made.unit.code():
        exec(part, names)  # only ever made from a syntax tree
    for plan, achieved in made.conditions:
        plan.goal_condition = names[achieved]
    for body in made.bodies:
        body.install(names)
    return cast("Function", names.get(made.name))  # None for a body without steps
