"""Strong negation and namespaces of terms that are known only later: ``~X`` and ``ns::X``.

>>> from jacaros.terms.values import atom
>>> qualify(atom("safe"), "north", True)
north::~safe/0
>>> positive_form(atom("safe")) is None
True
"""

from jacaros.terms.values import NEGATED, Annotated, Functor, Term, Var, deref, functor


def qualify(value: Term, namespace: str | None, negated: bool) -> Term:
    """The literal with another namespace or with strong negation.

    ``~X`` with X unbound is kept as a term of its own, which unifies with negated literals only.
    """
    term = deref(value)
    if term.__class__ is Annotated:
        return Annotated(qualify(term.term, namespace, negated), term.annotations, term.tail)
    if term.__class__ is tuple and term[0] is not NEGATED:
        old = term[0]
        return (functor(old.name, old.arity, old.negated or negated, namespace or old.namespace), *term[1:])
    if term.__class__ is Functor:
        return functor(term.name, 0, term.negated or negated, namespace or term.namespace)
    if term.__class__ is Var and negated:
        return (NEGATED, term)
    return term


def positive_form(term: Term) -> Term | None:
    """Return a negated literal without its negation; None for any other term."""
    symbol = term[0] if term.__class__ is tuple else term
    if symbol.__class__ is not Functor or not symbol.negated:
        return None
    plain = functor(symbol.name, symbol.arity, False, symbol.namespace)
    return (plain, *term[1:]) if term.__class__ is tuple else plain
