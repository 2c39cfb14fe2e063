"""Event kinds: what a plan reacts to, as objects that goals and events carry."""

from jacaros.terms.values import Functor


class Trigger:
    """One kind of event: operator, kind and functor; there is one object for each.

    Attributes:
        operator: ``+``, ``-`` or ``^``.
        kind: ``""`` for beliefs, ``!`` or ``?``.
        functor: name and arity of the literal.
        failing: True for ``-!`` and ``-?``: the handlers of failed goals.
        on_fail: the kind of the failure event of a goal, None for other events.
    """

    __slots__ = ("failing", "functor", "kind", "on_fail", "operator")

    def __init__(self, operator: str, kind: str, functor: Functor) -> None:
        self.operator, self.kind, self.functor = operator, kind, functor
        self.failing = operator == "-" and kind != ""
        self.on_fail = trigger("-", kind, functor) if operator == "+" and kind else None

    def __repr__(self) -> str:
        return f"{self.operator}{self.kind}{self.functor!r}"


class Kinds(dict[Functor, Trigger]):
    """The triggers of one operator and kind, by functor."""

    def __init__(self, operator: str, kind: str) -> None:
        super().__init__()
        self._operator, self._kind = operator, kind

    def __missing__(self, functor: Functor) -> Trigger:
        found = self[functor] = trigger(self._operator, self._kind, functor)
        return found


ADDED, DELETED, ACHIEVED = Kinds("+", ""), Kinds("-", ""), Kinds("+", "!")
"""Beliefs that come, beliefs that go, goals that are to be achieved."""
_triggers: dict[tuple[str, str, Functor], Trigger] = {}


def trigger(operator: str, kind: str, functor: Functor) -> Trigger:
    """The trigger of that operator, kind and functor."""
    key = (operator, kind, functor)
    found = _triggers.get(key)
    if found is None:
        found = _triggers.setdefault(key, Trigger(operator, kind, functor))  # as functors
    return found
