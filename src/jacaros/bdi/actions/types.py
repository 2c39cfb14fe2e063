"""Internal actions that test what kind of value a term is.  None of them fails in another way than by no."""

from collections.abc import Callable, Iterator

from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.collections import MapValue, QueueValue, SetValue
from jacaros.terms.plans import RULE, is_body
from jacaros.terms.substitution import is_ground
from jacaros.terms.values import (
    ACTION,
    ARITHMETIC,
    FUNCTION,
    PLAIN,
    Functor,
    String,
    Term,
    Var,
    atom,
    functor_of,
    is_list,
)
from jacaros.terms.values import NIL as EMPTY


@internal_action(".string", arity=1, repeatable=True)
def is_string(_ctx: Context, term: Term) -> bool:
    """``.string(X)``: *X* is a string."""
    return term.__class__ is String


@internal_action(".list", arity=1, repeatable=True)
def is_a_list(_ctx: Context, term: Term) -> bool:
    """``.list(X)``: *X* is a list, be it empty."""
    return is_list(term)


@internal_action(".number", arity=1, repeatable=True)
def is_number(_ctx: Context, term: Term) -> bool:
    """``.number(X)``: *X* is a number, or an expression that waits for its variables."""
    return term.__class__ is float or (term.__class__ is tuple and term[0].kind in (ARITHMETIC, FUNCTION))


@internal_action(".atom", arity=1, repeatable=True)
def is_atom(_ctx: Context, term: Term) -> bool:
    """``.atom(X)``: *X* is an atom, neither negated nor annotated."""
    return isinstance(term, Functor) and term.kind == PLAIN and not term.negated and term is not EMPTY


@internal_action(".literal", arity=1, repeatable=True)
def is_literal(_ctx: Context, term: Term) -> bool:
    """``.literal(X)``: *X* is an atom or structure, also a negated or annotated one, but no list."""
    symbol = functor_of(term)
    return symbol is not None and symbol.kind not in (ARITHMETIC, FUNCTION)


@internal_action(".structure", arity=1, repeatable=True)
def is_structure(ctx: Context, term: Term) -> bool:
    """``.structure(X)``: *X* is a list, or a literal other than a plain atom (so does Jason run)."""
    return is_list(term) or (is_literal(ctx, term) and not is_atom(ctx, term))


@internal_action(".ground", arity=1, repeatable=True)
def has_no_variables(_ctx: Context, term: Term) -> bool:
    """``.ground(X)``: there is no unbound variable in *X*."""
    return is_ground(term)


@internal_action(".internal_action", arity=1)
def is_internal_action(_ctx: Context, term: Term) -> bool:
    """``.internal_action(X)``: *X* is the call of an internal action, such as ``.print(a)``."""
    symbol = functor_of(term)
    return symbol is not None and symbol.kind == ACTION


_TESTS: dict[str, Callable[[Context, Term], bool]] = {
    "number": is_number,
    "atom": is_atom,
    "literal": is_literal,
    "string": is_string,
    "list": is_a_list,
    "set": lambda _, term: isinstance(term, SetValue),
    "map": lambda _, term: isinstance(term, MapValue),
    "structure": is_structure,
    "rule": lambda _, term: term.__class__ is tuple and term[0] is RULE,
    "plan": lambda _, term: is_body(term),
    "queue": lambda _, term: isinstance(term, QueueValue),
    "ground": has_no_variables,
    "free": lambda _, term: term.__class__ is Var,
}


@internal_action(".type", arity=2, backtracks=True, repeatable=True)
def type_(ctx: Context, term: Term, kind: Term) -> Iterator[None]:
    """``.type(X, T)``: *T* is a type of *X*; with *T* unbound, each of them in turn.

    Types are ``number atom literal string list set map structure rule plan queue ground free``, in this order
    (``plan`` is a plan body; ``free`` an unbound variable).
    """
    for name, test in _TESTS.items():
        if test(ctx, term) and ctx.unify(kind, atom(name)):
            yield
