"""Many plans for one kind of event, each compiled separately.

Compiling fifty plans takes a tenth of a second, too long while
a robot waits for the reaction to an event. The host compiles them ahead when it is idle (`compile_next`). A plan that is
tried before that is interpreted the first few times; it is compiled immediately only if it applies, as its body may have
much to do.
"""

from collections.abc import Callable, Sequence
from typing import Any

from jacaros.asl import nodes
from jacaros.bdi.fast.generated.building import functor_of_literal
from jacaros.bdi.rules.applicable_plans import Selection
from jacaros.bdi.state.engine import Select
from jacaros.bdi.state.intention import STEP, Frame
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.substitution import ATOMIC
from jacaros.terms.values import CONS, NIL, List, String, Term

_INTERPRETED = 2
"""Number of times a plan is tried before it is compiled."""

_WORTH_A_TABLE = 6
"""With this number of different first arguments, a lookup is cheaper than trying one plan after another."""

Compile = Callable[[Sequence[Plan], Plan | None], Select]
"""Gives what tries plans, one at least, and gives them their steps."""


class PlanByPlan:
    """The plans for one kind of event.

    Args:
        plans: in the order in which they are tried.
        outer: the plan that they are sub-plans of.
        compiled: compiles one of them.
    """

    __slots__ = ("_by_key", "_compiled", "_outer", "_parts", "_plans", "_rest")

    def __init__(self, plans: Sequence[Plan], outer: Plan | None, compiled: Compile) -> None:
        self._plans, self._outer, self._compiled = plans, outer, compiled
        self._parts: list[Select] = [_Waiting(self, place) for place in range(len(plans))]
        self._by_key: dict[Any, list[Select]] | None = None
        self._rest: list[Select] = []
        groups = None if outer is not None else _grouped(plans)
        if groups is not None:
            self._make_table([key for key, group in groups for _ in group])

    def _make_table(self, keys: list[Any]) -> None:
        """Note for each first argument which plans may be relevant for it; None stands for any."""
        parts = list(zip(keys, self._parts, strict=True))
        self._rest = [part for key, part in parts if key is None]
        self._by_key = {
            key: [part for own, part in parts if own is None or own is key or own == key]
            for key in dict.fromkeys(keys)
            if key is not None
        }

    def select(self) -> Select:
        """The function that chooses among the plans: one with nothing to look up but what it is given."""
        every, by_key, rest = self._parts, self._by_key, self._rest

        def select(agent: Any, goal: Goal, annotations: EventAnnotations) -> Frame | None:
            parts = every
            if by_key is not None:
                # Only the plans that may be relevant for the first argument.
                key = goal[1]
                if key.__class__ is tuple:
                    key = None if key[0].kind else key[0]  # pyright: ignore[reportIndexIssue]
                elif key.__class__ is List:
                    key = CONS
                if key.__class__ in ATOMIC:
                    parts = by_key.get(key, rest)
            for part in parts:
                frame = part(agent, goal, annotations)
                if frame is not None:
                    return frame
            return None

        return select

    def compile_next(self) -> bool:
        """Compile one more plan; False when none is left."""
        for place, part in enumerate(self._parts):
            if part.__class__ is _Waiting:
                self.compile(place)
                return True
        return False

    def compile(self, place: int) -> Select:
        """Compile one of the plans."""
        old, new = self._parts[place], self._compiled(self._plans[place : place + 1], self._outer)
        for parts in (self._parts, self._rest, *(self._by_key or {}).values()):
            parts[:] = [new if part is old else part for part in parts]
        return new

    def interpreted(self, place: int) -> Selection:
        """One of the plans, not compiled."""
        return Selection(self._plans[place : place + 1], self._outer)


class _Waiting:
    """One plan as long as it is not compiled."""

    __slots__ = ("_asked", "_place", "_plans", "_selection")

    def __init__(self, plans: PlanByPlan, place: int) -> None:
        self._plans, self._place, self._asked = plans, place, 0
        self._selection: Selection | None = None

    def __call__(self, agent: Any, goal: Goal, annotations: EventAnnotations) -> Frame | None:
        """Its frame, if it is applicable."""
        self._asked += 1
        if self._asked > _INTERPRETED:
            return self._plans.compile(self._place)(agent, goal, annotations)
        if self._selection is None:
            self._selection = self._plans.interpreted(self._place)
        frame = self._selection(agent, goal, annotations)
        if frame is not None and self._plans.compile(self._place).__class__ is not Selection:
            plan = self._selection.plans[0]
            if not plan.guards:  # a plan with guards finds its first step itself
                frame[STEP] = plan.first
        return frame


def _grouped(plans: Sequence[Plan]) -> list[tuple[Term, list[Plan]]] | None:
    """Group the plans, in order, with neighbours that have the same first argument; return None if that is not
    worthwhile.

    The first argument is represented by a key: the atom, number or string itself, or the functor of a structure or list.
    None stands for plans that may be relevant for any argument.
    """
    groups: list[tuple[Term, list[Plan]]] = []
    for plan in plans:
        key = _first_argument(plan)
        if groups and groups[-1][0] == key and groups[-1][0].__class__ is key.__class__:
            groups[-1][1].append(plan)
        else:
            groups.append((key, [plan]))
    keys = [key for key, _ in groups if key is not None]
    return groups if len(set(keys)) >= _WORTH_A_TABLE and len(groups) <= 2 * len(keys) else None


def _first_argument(plan: Plan) -> Term:
    literal = plan.node.trigger.literal
    if isinstance(literal, nodes.Variable) or isinstance(literal.namespace, nodes.Variable):
        return None
    if not literal.arguments:
        return None
    argument = literal.arguments[0]
    if isinstance(argument, nodes.Number):
        return argument.value
    if isinstance(argument, nodes.String):
        return String(argument.value)
    if isinstance(argument, nodes.ListTerm):
        return CONS if argument.items else NIL if argument.tail is None else None
    if not isinstance(argument, nodes.Literal) or isinstance(argument.namespace, nodes.Variable):
        return None
    return None if argument.annotations is not None else functor_of_literal(argument)
