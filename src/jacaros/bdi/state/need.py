"""Resources that a plan or a goal needs for all of its steps, as data: ``[needs(base, arm), policy(refuse)]``."""

from collections.abc import Iterable
from typing import Any, NamedTuple

from jacaros.bdi.state.intention import PLAN, SERIAL, Frame, Intention
from jacaros.terms.text import text
from jacaros.terms.values import String, Term, bare, functor

NEEDS, POLICY = "needs", functor("policy", 1)


class Wanted(NamedTuple):
    """What a plan or goal needs.

    Attributes:
        names: of the resources, as written: ``wheels``, ``lift(2)``, ``map(shared)``.
        policy: ``wait``, ``refuse`` or ``take``.
    """

    names: tuple[str, ...]
    policy: str


class Need:
    """What a frame of an intention has asked for; it holds that until the frame is gone.

    Attributes:
        number: of the act that asked for it.
        intention: that asked for it; branches of a fork may have taken its place.
        index: of the frame on the stack; it may have moved up since, above the supervision of its plan.
        serial: of the frame, the same in all branches of a fork.
        plan: of the frame.
    """

    __slots__ = ("index", "intention", "number", "plan", "serial")

    def __init__(self, number: int, intention: Intention) -> None:
        self.number, self.intention, self.index = number, intention, len(intention.frames) - 1
        self.serial, self.plan = intention.frames[-1][SERIAL], intention.frames[-1][PLAN]

    def is_of(self, frame: Frame) -> bool:
        """Whether a frame has asked for it."""
        return frame[SERIAL] == self.serial and frame[PLAN] is self.plan

    def is_on(self, intention: Intention) -> bool:
        """Whether the frame is on the stack of an intention."""
        return any(map(self.is_of, intention.frames[self.index :]))


def wanted_in(annotations: Iterable[Term]) -> Wanted | None:
    """What annotations of a plan's label or of a goal say; None when they need nothing."""
    names: list[str] = []
    policy = "wait"
    for annotation in annotations:
        inner: Any = bare(annotation)
        if inner.__class__ is not tuple:
            continue
        if inner[0] is POLICY:
            policy = _name(inner[1])
        elif inner[0].name == NEEDS:
            names.extend(_name(each) for each in inner[1:])
    return Wanted(tuple(names), policy) if names else None


def _name(term: Term) -> str:
    term = bare(term)
    if term.__class__ is String:
        return str(term)
    return text(term)
