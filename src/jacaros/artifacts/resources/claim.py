"""One claim of resources, from request to release."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal, Protocol

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.clock import Timer

# The names of resources: ``wheels``, or ``/robot_0/wheels`` with the name of its robot.


_NAME = re.compile(r"[A-Za-z_/][A-Za-z0-9_/]*")

WHEELS = "wheels"
"""The resource that every motion of a robot uses."""


def read_uses(written: str | Iterable[str]) -> tuple[str, ...]:
    """Check the resources of a declaration: one name, or several. A name that is repeated counts once.

    Raises:
        ValueError: one of them is not a name. The message says what to write.
    """
    names = (written,) if isinstance(written, str) else tuple(written)
    for name in names:
        if not _NAME.fullmatch(name):
            raise ValueError(f"invalid resource `{name}`; write a name, such as wheels")
    return tuple(dict.fromkeys(names))


def scoped(uses: Iterable[str], scope: str) -> tuple[str, ...]:
    """Return the resources of one robot. *scope* is its name, empty for resources of the whole run."""
    return tuple(f"{scope}/{name}" if scope else name for name in uses)


def local_name(name: str) -> str:
    """Return the name of a resource without that of its robot."""
    return name.rpartition("/")[2]


Policy = Literal["wait", "refuse"]
"""What a claim does if it is not granted immediately: wait or fail."""

POLICIES: tuple[Policy, ...] = ("wait", "refuse")


class State(StrEnum):
    """The state of a claim."""

    OUT = "out"
    WAITING = "waiting"
    HELD = "held"
    YIELDING = "yielding"


class Claimant(Protocol):
    """Receives the events of a claim. Each method may call the arbiter."""

    @property
    def can_yield(self) -> bool:
        """Return whether it can yield now."""

    def granted(self, claim: "Claim") -> None:
        """It holds its resources, for the first time or again."""

    def preempted(self, claim: "Claim", resource: str) -> None:
        """A more urgent claim wants *resource*: yield, and then call `Arbiter.gave_way`."""

    def refused(self, claim: "Claim", reason: Structure | Atom) -> None:
        """The claim failed and is removed."""


@dataclass(slots=True, eq=False, repr=False)
class Claim:
    """A claim of one plan or operation.

    Args:
        uses: the resources; all or nothing.
        who: the claimant, for messages.
        claimant: receives the events of the claim.
        urgency: urgency of the plan or operation.
        policy: what it does if it is not granted immediately.
        within: the outer claims, outermost first. What they hold does not block this one.
        plan_of: the agent whose plan it is for. Empty for an operation, which ends without a further step of a plan.
        blocks: the agent whose other plans make no step until this claim is released: that of an atomic plan.

    Attributes:
        state: its state.
        fresh: whether it has not been granted yet.
        order: its place among claims of equal urgency. The earlier one goes first.
        inherited: urgency of the most urgent claim that it blocks and cannot yield to.
        report: logs a long wait, unless it ends before. None while it does not wait.
    """

    uses: tuple[str, ...]
    who: str
    claimant: Claimant
    urgency: int = 0
    policy: Policy = "wait"
    within: "tuple[Claim, ...]" = ()
    plan_of: str = ""
    blocks: str = ""
    state: State = field(default=State.OUT, init=False)
    fresh: bool = field(default=True, init=False)
    order: int = field(default=0, init=False)
    inherited: int = field(default=0, init=False)
    report: Timer | None = field(default=None, init=False)

    @property
    def root(self) -> "Claim":
        """The outermost claim around it, or itself."""
        return self.within[0] if self.within else self

    @property
    def holds(self) -> bool:
        """Whether no other claim can have its resources."""
        return self.state is State.HELD or self.state is State.YIELDING

    @property
    def base(self) -> int:
        """The urgency with which it preempts."""
        return max(self.urgency, self.inherited)

    def __repr__(self) -> str:
        return f"Claim({self.who!r}, {list(self.uses)}, {self.state})"
