"""Internal actions that take lists as sets: ``.union .intersection .difference``."""

from jacaros.bdi.actions.arguments import elements
from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.order import compare, ordered_by_python, sorted_set
from jacaros.terms.values import Term, Var, make_list


@internal_action(".union", arity=3, repeatable=True)
def union(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.union(A, B, R)``: *R* is the sorted list of what is in the list *A* or in *B*, each once.

    Raises:
        WrongArguments: *A* or *B* is no list, or *R* is neither a list nor unbound.
    """
    first, second = _checked(left, right, result, ".union")
    return ctx.unify(result, make_list(sorted_set([*second, *first])))


@internal_action(".intersection", arity=3, repeatable=True)
def intersection(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.intersection(A, B, R)``: *R* is the sorted list of what is in both lists, each once.

    Raises:
        WrongArguments: *A* or *B* is no list, or *R* is neither a list nor unbound.
    """
    first, second = _checked(left, right, result, ".intersection")
    return ctx.unify(result, make_list(_parted(second, first)[0]))


@internal_action(".difference", arity=3, repeatable=True)
def difference(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.difference(A, B, R)``: *R* is the sorted list of what is in the list *A* but not in *B*, each once.

    Raises:
        WrongArguments: *A* or *B* is no list, or *R* is neither a list nor unbound.
    """
    first, second = _checked(left, right, result, ".difference")
    return ctx.unify(result, make_list(_parted(first, second)[1]))


def _checked(left: Term, right: Term, result: Term, name: str) -> tuple[list[Term], list[Term]]:
    if result.__class__ is not Var:
        elements(result, f"the third argument of {name}")
    return elements(left, f"the first argument of {name}"), elements(right, f"the second argument of {name}")


def _parted(items: list[Term], others: list[Term]) -> tuple[list[Term], list[Term]]:
    """The items that are also among *others*, and those that are not, both sorted, each once."""
    if ordered_by_python(items) and ordered_by_python(others):
        among = set(others)
        ordered = sorted_set(items)
        return [item for item in ordered if item in among], [item for item in ordered if item not in among]
    shared: list[Term] = []
    own: list[Term] = []
    remaining = iter(sorted_set(others))
    other = next(remaining, None)
    for item in sorted_set(items):
        while other is not None and compare(other, item) < 0:
            other = next(remaining, None)
        (own if other is None or compare(other, item) else shared).append(item)
    return shared, own
