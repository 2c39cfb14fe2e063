"""Event kinds: what a plan reacts to, as objects that goals and events carry."""

from typing import Any, Protocol

from jacaros.agents.terms.operators import positive_form
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import ATOMIC, rename, resolve
from jacaros.agents.terms.values import (
    SOURCE,
    SOURCE_SELF,
    Annotated,
    Functor,
    InternedRef,
    Term,
    Var,
    annotations_of,
    atom,
    bare,
    enter,
    functor,
    list_items,
)


class Trigger:
    """One kind of event: operator, kind and functor; there is one object for each that is in use.

    Attributes:
        operator: ``+``, ``-`` or ``^``.
        kind: ``""`` for beliefs, ``!`` or ``?``.
        functor: name and arity of the literal.
        failing: True for ``-!`` and ``-?``: the handlers of failed goals.
        on_fail: the kind of the failure event of a goal, None for other events.
    """

    __slots__ = ("__weakref__", "failing", "functor", "kind", "on_fail", "operator")

    def __init__(self, operator: str, kind: str, functor: Functor) -> None:
        self.operator, self.kind, self.functor = operator, kind, functor
        self.failing = operator == "-" and kind != ""
        self.on_fail = trigger("-", kind, functor) if operator == "+" and kind else None

    def __reduce__(self) -> tuple[Any, ...]:
        return trigger, (self.operator, self.kind, self.functor)

    def __repr__(self) -> str:
        return f"{self.operator}{self.kind}{self.functor!r}"


Goal = tuple[Trigger, *tuple[Term, ...]]
"""A goal or an event: its kind, then its arguments."""

_triggers: dict[tuple[str, str, Functor], InternedRef] = {}


def trigger(operator: str, kind: str, functor: Functor) -> Trigger:
    """Return the trigger of that operator, kind and functor; compiled plans, tables and events keep it alive."""
    key = (operator, kind, functor)
    held = _triggers.get(key)
    found: Trigger | None = None if held is None else held()
    return enter(_triggers, key, Trigger(operator, kind, functor)) if found is None else found


# Literals that are put together at run time: of goals and events, with annotations, in namespaces.


class LateAnnotations(Protocol):
    """The reason of a failure, whose annotations are composed when they are first asked for (`FailureReason`)."""

    def annotations(self) -> tuple[Term, ...]:
        """The annotations of the failure event."""


EventAnnotations = tuple[Term, ...] | LateAnnotations


def literal_of(goal: Goal, annotations: EventAnnotations) -> Term:
    """The literal of a goal or event, with its annotations."""
    symbol = goal[0].functor
    term = (symbol, *goal[1:]) if len(goal) > 1 else symbol
    found = annotations_of_event(annotations)
    return Annotated(term, found) if found else term


def apart(goal: Goal) -> Goal:
    """Return a goal or event that shares no unbound variable with this one."""
    names: dict[Var, Var] = {}
    return (goal[0], *(a if a.__class__ in ATOMIC else rename(a, names) for a in goal[1:]))


def annotations_of_event(annotations: EventAnnotations) -> tuple[Term, ...]:
    """The annotations of an event; those of failure events are made when first asked for."""
    return annotations if isinstance(annotations, tuple) else annotations.annotations()


def own_annotations(items: tuple[Term, ...], tail: Term = None) -> tuple[Term, ...]:
    """The annotations of a belief or goal of one's own: ``source(self)`` is added when no source is named."""
    found = [resolve(i) for i in items]
    if tail is not None:
        found.extend(resolve(i) for i in list_items(tail))
    if not any((a.__class__ is tuple and a[0] is SOURCE) or _is_source(a) for a in found):
        found.append(SOURCE_SELF)
    return annotation_set(tuple(found))


def _is_source(term: Term) -> bool:
    inner = bare(term)
    return inner.__class__ is tuple and inner[0] is SOURCE


def resolve_all(terms: tuple[Term, ...]) -> tuple[Term, ...]:
    """Apply all bindings to each."""
    return tuple(resolve(t) for t in terms)


def positive(term: Term) -> Term:
    """A negated literal without its negation; annotations are kept."""
    plain = positive_form(bare(term))
    annotations = annotations_of(term)
    return Annotated(plain, annotations) if annotations else plain


def namespace_of(symbol: Functor) -> Term:
    """The name of a functor's namespace, as programs see it."""
    return atom(symbol.namespace or "default")


def namespace_name(term: Term) -> str | None:
    """The namespace that an atom names."""
    name = getattr(bare(term), "name", None)
    return None if name == "default" else name


def literal_in(name: str, negated: bool, namespace: str | None, *arguments: Term) -> Term:
    """A literal whose namespace became known at run time."""
    symbol = functor(name, len(arguments), negated, namespace)
    return (symbol, *arguments) if arguments else symbol
