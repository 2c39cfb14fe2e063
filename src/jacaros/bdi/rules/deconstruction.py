"""The relation ``=..`` between a term and the list of its parts."""

from jacaros.bdi.state.literals import namespace_name
from jacaros.terms import plans
from jacaros.terms.negation import qualify
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import ATOMIC, resolve
from jacaros.terms.unifier import Trail, unify
from jacaros.terms.values import (
    CONS,
    NIL,
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
    list_length,
    make_list,
)

_DEFAULT = atom("default")


def deconstruct(left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..``: a literal and the list ``[namespace, functor, arguments, annotations]``.

    The namespace may be left out of a list that is given.
    """
    term = resolve(left)
    if term.__class__ is Var:
        made = constructed(tuple(list_items(right)))
        return made is not None and unify(term, made, trail)
    parts = deconstructed(term, list_length(right))
    return parts is not None and unify(make_list(parts), right, trail)


def deconstructed(term: Term, count: int) -> tuple[Term, ...] | None:
    """The parts of a literal (without the namespace where *count* is 3) or of a plan; None for any other term."""
    term = resolve(term)
    inner = term if term.__class__ is tuple else bare(term)
    arguments: Term = NIL
    if inner.__class__ is Functor:
        symbol = inner
    elif inner.__class__ is not tuple or inner[0] is CONS:
        return None
    elif inner[0] is plans.PLAN:
        return None if count == 3 else _plan_parts(inner)
    else:
        symbol, arguments = inner[0], make_list(inner[1:])
    annotations = make_list(annotations_of(term)) if term is not inner else NIL
    if count == 3:
        return symbol.as_atom(), arguments, annotations
    return atom(symbol.namespace or "default"), symbol.as_atom(), arguments, annotations


def deconstruct_in(namespace: Term, left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..`` for a left side that is written in a namespace: its name, or a variable for it."""
    term = resolve(left)
    if term.__class__ is not Var:
        name = namespace if namespace.__class__ is str else namespace_name(resolve(namespace))
        return deconstruct(qualify(term, name, False), right, trail)
    parts = tuple(resolve(i) for i in list_items(right))
    wanted = atom(namespace) if namespace.__class__ is str else namespace
    if len(parts) != 4 or not unify(wanted, parts[0], trail):
        return False
    made = constructed(parts, namespace_name(parts[0]))
    return made is not None and unify(term, made, trail)


def _plan_parts(plan: Term) -> tuple[Term, ...]:
    """Label, trigger, context and body of a plan."""
    label, event, context, body = plan[1:]
    event = deref(event)
    return label, (plans.PLAN_TRIGGER, *event[1:]), context, body


def constructed(parts: tuple[Term, ...], allowed: str | None = None) -> Term:
    """The literal (of the namespace *allowed*) or plan with these parts; None when they are not those of one."""
    parts = tuple(part if part.__class__ in ATOMIC else resolve(part) for part in parts)
    if len(parts) == 3:
        parts = (_DEFAULT, *parts)
    if len(parts) != 4:
        return None
    namespace, name, arguments, annotations = parts
    if name.__class__ is tuple and name[0] in plans.TRIGGERS:
        return _plan_of(*parts)
    if name.__class__ is not Functor or namespace_name(namespace) != allowed:
        return None
    term: Term = tuple(list_items(arguments))
    symbol = functor(name.name, len(term), name.negated, allowed)
    term = (symbol, *term) if term else symbol
    found = annotation_set(tuple(list_items(annotations)))
    return Annotated(term, found) if found else term


def _plan_of(label: Term, event: Term, context: Term, body: Term) -> Term:
    if plans.is_body(body):
        body = plans.make_body(plans.body_steps(body))
    return (plans.PLAN, label, (plans.TRIGGER, *event[1:]), context, body)
