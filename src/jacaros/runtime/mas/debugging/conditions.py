"""Conditions, hit counts and log messages of breakpoints: evaluated without effects, in limited time."""

import operator
import re
from collections.abc import Callable, Mapping
from contextlib import suppress

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_formula
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.language.nodes import nodes_in
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.rules.context import reading
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import GOAL, PLAN, Frame, variables_of
from jacaros.agents.terms.substitution import is_ground, resolve
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import String, Term, Var
from jacaros.look.records.words import shown
from jacaros.runtime.errors import UsageError

MOST_STEPS = 1_000
"""Maximum number of steps of one evaluation, see `jacaros.agents.mind.rules.context.reading`."""
NO_VALUES: Mapping[str, Term] = {}


def bindings_of(frame: Frame) -> dict[str, Term]:
    """Return the variables of a frame that have a value.

    Variables that a plan mentions only once have no place in the frame; those of its trigger have the values of the goal.
    """
    names = Variables(variables_of(frame))
    trigger, goal = frame[PLAN].node.trigger.literal, frame[GOAL]
    if isinstance(trigger, nodes.Literal) and len(trigger.arguments) == len(goal) - 1:
        trail = Trail()
        for written, given in zip(trigger.arguments, goal[1:], strict=True):
            with suppress(Exception):
                unify(lower(written, names.__getitem__), given, trail)
        found = {name: resolve(value) for name, value in names.items()}
        undo(trail, 0)
        return {name: value for name, value in found.items() if value.__class__ is not Var and name[0] != "_"}
    return dict(names)


class Condition:
    """A formula about an agent.

    Args:
        written: such as ``battery(B) & B < 20``.

    Raises:
        AslError: the text is not a formula.
        UsageError: it calls an internal action that acts or waits.
    """

    def __init__(self, written: str) -> None:
        self._formula = parse_formula(written)
        for call in nodes_in(nodes.InternalAction, self._formula):
            action = STANDARD.get(call.name)
            if action is not None and not action.pure:
                raise UsageError(f"condition `{written}` calls `{call.name}`, which may have effects")

    def answer(self, agent: Circumstance, values: Mapping[str, Term] = NO_VALUES) -> Mapping[str, str] | None:
        """Return the variables of the first answer, as text.

        Args:
            agent: the agent.
            values: variables that have a value.

        Returns:
            None if it does not hold, cannot be evaluated, or the search takes too long.
        """
        names = Variables(values)
        with suppress(Exception), reading(agent, MOST_STEPS) as view:
            for _ in view.answers(lower(self._formula, names.__getitem__)):
                return {name: shown(resolve(each)) for name, each in names.items() if name[0] != "_"}
        return None

    def instance(self, agent: Circumstance, values: Mapping[str, Term]) -> str:
        """Return the formula with the values of its first answer; a value as it is, and ``no`` without an answer."""
        term = lower(self._formula, Variables(values).__getitem__)
        with suppress(Exception):
            value = resolve(term)
            if value.__class__ is Var:
                return "_"
            if is_ground(value):
                return str(value) if isinstance(value, String) else shown(value)
            with reading(agent, MOST_STEPS) as view:
                for _ in view.answers(term):
                    return shown(resolve(term))
        return "no"


_HITS = re.compile(r"\s*(==|=|>=|<=|>|<|%)?\s*(\d{1,9})\s*")
_COMPARE: Mapping[str, Callable[[int, int], bool]] = {
    "==": operator.eq,
    "=": operator.eq,
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
    "%": lambda count, number: number > 0 and count % number == 0,
}


class HitCount:
    """Which visits of a line count: ``3`` (the third), ``>= 3``, or ``% 3`` (each third).

    Raises:
        UsageError: the text is not of this form.
    """

    def __init__(self, written: str) -> None:
        found = _HITS.fullmatch(written)
        if found is None:
            raise UsageError(f"invalid hit count `{written}`; expected 3, >= 3 or % 3")
        self._compare = _COMPARE[found[1] or "=="]
        self._number, self._count = int(found[2]), 0

    def counts(self) -> bool:
        """Count a visit, and return whether it is one of those."""
        self._count += 1
        return self._compare(self._count, self._number)


class LogMessage:
    """A text with formulae in braces: ``at {X}, {battery(B)}``.

    Raises:
        AslError: a formula has errors.
        UsageError: a formula calls an internal action that acts or waits.
    """

    def __init__(self, written: str) -> None:
        parts = re.split(r"\{([^{}]*)\}", written)
        self._parts = [Condition(each) if odd % 2 else each for odd, each in enumerate(parts)]

    def text(self, agent: Circumstance, values: Mapping[str, Term]) -> str:
        """Return the text with the values of its formulae."""
        return "".join(
            each if isinstance(each, str) else each.instance(agent, values) for each in self._parts
        )
