"""The relation ``=..`` between a term and the list of its parts."""

from jacaros.compiler.literals import namespace_name
from jacaros.terms import plans
from jacaros.terms.negation import qualify
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import resolve
from jacaros.terms.unifier import Trail, unify
from jacaros.terms.values import (
    CONS,
    Annotated,
    Functor,
    Term,
    Var,
    annotations_of,
    atom,
    bare,
    deref,
    functor,
    list_items,
    make_list,
)


def deconstruct(left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..``: a literal and the list ``[namespace, functor, arguments, annotations]``.

    The namespace may be left out of a list that is given.
    """
    term = resolve(left)
    if term.__class__ is Var:
        return _construct(term, [resolve(i) for i in list_items(right)], trail)
    inner = bare(term)
    if inner.__class__ is tuple and inner[0] is plans.PLAN:
        return unify(make_list(_plan_parts(inner)), right, trail)
    if inner.__class__ is tuple and inner[0] is not CONS:
        symbol, arguments = inner[0], inner[1:]
    elif inner.__class__ is Functor:
        symbol, arguments = inner, ()
    else:
        return False
    name = functor(symbol.name, 0, symbol.negated)
    parts = [atom(symbol.namespace or "default"), name, make_list(arguments), make_list(annotations_of(term))]
    if len(list(list_items(right))) == len(parts) - 1:
        del parts[0]
    return unify(make_list(parts), right, trail)


def deconstruct_in(namespace: Term, left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..`` for a left side that is written in a namespace: its name, or a variable for it."""
    term = resolve(left)
    if term.__class__ is not Var:
        name = namespace if namespace.__class__ is str else namespace_name(resolve(namespace))
        return deconstruct(qualify(term, name, False), right, trail)
    parts = [resolve(i) for i in list_items(right)]
    if len(parts) != 4:
        return False
    wanted = atom(namespace) if namespace.__class__ is str else namespace
    return unify(wanted, parts[0], trail) and _construct(term, parts, trail, namespace_name(parts[0]))


def _plan_parts(plan: Term) -> list[Term]:
    """Label, trigger, context and body of a plan."""
    label, event, context, body = plan[1:]
    event = deref(event)
    return [label, (plans.PLAN_TRIGGER, *event[1:]), context, body]


def _construct(variable: Term, parts: list[Term], trail: Trail, allowed: str | None = None) -> bool:
    if len(parts) == 3:
        parts = [atom("default"), *parts]
    if len(parts) == 4 and parts[1].__class__ is tuple and parts[1][0] in plans.TRIGGERS:
        return unify(variable, _plan_of(*parts), trail)
    if len(parts) != 4 or parts[1].__class__ is not Functor:
        return False
    namespace = namespace_name(parts[0])
    if namespace != allowed:
        return False
    arguments = tuple(list_items(parts[2]))
    symbol = functor(parts[1].name, len(arguments), parts[1].negated, namespace)
    term: Term = (symbol, *arguments) if arguments else symbol
    annotations = annotation_set(tuple(list_items(parts[3])))
    return unify(variable, Annotated(term, annotations) if annotations else term, trail)


def _plan_of(label: Term, event: Term, context: Term, body: Term) -> Term:
    if plans.is_body(body):
        body = plans.make_body(plans.body_steps(body))
    return (plans.PLAN, label, (plans.TRIGGER, *event[1:]), context, body)
