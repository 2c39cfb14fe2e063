"""Terms drawn by Hypothesis: plans of terms first, so that each use has variables of its own."""

from typing import Any

from hypothesis import strategies as st

from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import Annotated, String, Term, Var, atom, functor, make_list

Plan = Any
"""A constant, ``("var", name)``, ``("list", [plans])``, ``("structure", name, [plans])`` or
``("annotated", plan, [plans])``."""

atoms = st.sampled_from([atom("a"), atom("b"), atom("c"), functor("a", 0, negated=True), atom("a", "ns")])
numbers = st.sampled_from([-1.5, 0.0, 1.0, 2.0, 1e20])
strings = st.sampled_from(["", "a", "b"]).map(String)
constants = st.one_of(atoms, numbers, strings)
variables = st.sampled_from(["X", "Y", "Z"]).map(lambda name: ("var", name))


def _compound(parts: st.SearchStrategy[Plan]) -> st.SearchStrategy[Plan]:
    arguments = st.lists(parts, min_size=1, max_size=3)
    return st.one_of(
        st.lists(parts, max_size=3).map(lambda items: ("list", items)),
        st.tuples(st.just("structure"), st.sampled_from(["f", "g"]), arguments),
    )


ground_plans = st.recursive(constants, _compound, max_leaves=8)
plans = st.recursive(st.one_of(constants, variables), _compound, max_leaves=8)
_bare = st.one_of(
    atoms, st.tuples(st.just("structure"), st.just("f"), st.lists(plans, min_size=1, max_size=2))
)
annotated_plans = st.tuples(st.just("annotated"), _bare, st.lists(ground_plans, min_size=1, max_size=3))
any_plans = st.one_of(plans, annotated_plans)


def build(plan: Plan, scope: dict[str, Var]) -> Term:
    """The term of a plan; variables of the same name in the same scope are the same."""
    if not isinstance(plan, tuple):
        return plan
    if plan[0] == "var":
        return scope.setdefault(plan[1], Var(plan[1]))
    if plan[0] == "list":
        return make_list([build(item, scope) for item in plan[1]])
    if plan[0] == "annotated":
        return Annotated(build(plan[1], scope), annotation_set(tuple(build(a, scope) for a in plan[2])))
    arguments = [build(argument, scope) for argument in plan[2]]
    return (functor(plan[1], len(arguments)), *arguments)
