"""Event kinds: what a plan reacts to, as objects that goals and events carry."""

from jacaros.terms.values import Functor, Held, Term, enter


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

    def __repr__(self) -> str:
        return f"{self.operator}{self.kind}{self.functor!r}"


Goal = tuple[Trigger, *tuple[Term, ...]]
"""A goal or an event: its kind, then its arguments."""

_triggers: dict[tuple[str, str, Functor], Held] = {}


def trigger(operator: str, kind: str, functor: Functor) -> Trigger:
    """Return the trigger of that operator, kind and functor; compiled plans, tables and events keep it alive."""
    key = (operator, kind, functor)
    held = _triggers.get(key)
    found: Trigger | None = None if held is None else held()
    return enter(_triggers, key, Trigger(operator, kind, functor)) if found is None else found
