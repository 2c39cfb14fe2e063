"""Internal actions about namespaces and their properties."""

from collections.abc import Iterator

from jacaros.bdi.actions.internal_action import WrongArguments, internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.text import text
from jacaros.terms.values import Functor, Term, Var, atom


@internal_action(".namespace", arity=1, backtracks=True)
def namespace(ctx: Context, target: Term) -> Iterator[None]:
    """``.namespace(N)``: each namespace in use."""
    names: dict[str, None] = {"default": None}
    for symbol, table in ctx.agent.beliefs.items():
        if symbol.namespace and len(table):
            names[symbol.namespace] = None
    for plan in ctx.agent.library.plans:
        symbol = plan.trigger_functor()
        if symbol is not None and symbol.namespace:
            names[symbol.namespace] = None

    for name in names:
        if ctx.unify(target, atom(name)):
            yield


def _properties(ctx: Context, namespace: Term) -> dict[Term, Term]:
    """The properties of a namespace, by key; a change of them stays."""
    if not isinstance(namespace, Functor):
        raise WrongArguments(f"the first argument must be the name of a namespace, not {text(namespace)}")
    found: dict[Term, Term] = ctx.agent.namespace_properties.setdefault(namespace.name, {})
    return found


@internal_action(".namespace_set_prop", arity=3)
def set_property(ctx: Context, namespace: Term, key: Term, value: Term) -> None:
    """``.namespace_set_prop(N, Key, Value)`` gives a namespace a property.

    Raises:
        WrongArguments: *N* or *Key* is no atom.
    """
    if not isinstance(key, Functor):
        raise WrongArguments(f"the key of a property must be an atom, not {text(key)}")
    _properties(ctx, namespace)[key] = value


@internal_action(".namespace_get_prop", arity=(2, 4), backtracks=True)
def get_property(ctx: Context, namespace: Term, key: Term, *rest: Term) -> Iterator[None]:
    """``.namespace_get_prop(N, Key[, Value[, Default]])``: a property of a namespace, or the default value.

    With *Key* unbound, an answer for each property.

    Raises:
        WrongArguments: *N* is no atom.
    """
    held = _properties(ctx, namespace)
    if key.__class__ is Var:
        for each, value in list(held.items()):
            if ctx.unify_all((key, each), *(((rest[0], value),) if rest else ())):
                yield
        return
    value = held.get(key, rest[1] if len(rest) > 1 else None)
    if value is not None and (not rest or ctx.unify(rest[0], value)):
        yield
