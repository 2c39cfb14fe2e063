"""One claim to resources, from asking to giving back."""

from enum import StrEnum
from typing import Literal, Protocol

from jacaros.env.resources.resource import Use
from jacaros.env.values import Atom, Structure

Policy = Literal["wait", "refuse", "take"]
"""What a claim does that is not granted at once: it waits; it fails; it takes the resource from an equal, too."""

POLICIES: tuple[Policy, ...] = ("wait", "refuse", "take")


class State(StrEnum):
    """Where a claim is."""

    OUT = "out"
    WAITING = "waiting"
    HELD = "held"
    YIELDING = "yielding"


class Claimant(Protocol):
    """Who is told what becomes of a claim.  Each method may call the arbiter."""

    @property
    def can_yield(self) -> bool:
        """Whether it can give way now."""

    def granted(self, claim: "Claim") -> None:
        """It holds what it asked for, for the first time or again."""

    def preempted(self, claim: "Claim", resource: str) -> None:
        """A more urgent claim wants *resource*: give way, and call `Arbiter.gave_way` when that is done."""

    def refused(self, claim: "Claim", reason: Structure | Atom) -> None:
        """The claim failed; it is out."""


class Claim:
    """A claim of one plan or operation.

    Args:
        uses: what it asks for, all of it or nothing.
        who: the claimant, for people.
        claimant: is told what becomes of it.
        urgency: of the plan or operation.
        policy: what it does when it is not granted at once.
        within: claims that it is a part of, outermost first; what these hold does not stand in its way.
        plan_of: the agent for whose plan it is; empty for an operation, which ends without a further step of a plan.
        blocks: the agent whose other plans make no step until this claim has been given back: that of an atomic plan.

    Attributes:
        state: where it is.
        fresh: it has not been granted yet.
        order: its place among those of equal urgency; the earlier goes first.
        inherited: urgency of the most urgent claim that it blocks and cannot give way to.
        waited: seconds that it has waited before the present wait.
        since: when the present wait began.
        warned: its long wait has been reported.
    """

    __slots__ = (
        "blocks",
        "claimant",
        "fresh",
        "inherited",
        "order",
        "plan_of",
        "policy",
        "since",
        "state",
        "urgency",
        "uses",
        "waited",
        "warned",
        "who",
        "within",
    )

    def __init__(
        self,
        uses: tuple[Use, ...],
        who: str,
        claimant: Claimant,
        urgency: int = 0,
        policy: Policy = "wait",
        within: "tuple[Claim, ...]" = (),
        plan_of: str = "",
        blocks: str = "",
    ) -> None:
        self.uses, self.who, self.claimant = uses, who, claimant
        self.urgency, self.policy, self.within = urgency, policy, within
        self.plan_of, self.blocks = plan_of, blocks
        self.state, self.fresh, self.warned = State.OUT, True, False
        self.order = self.inherited = 0
        self.waited = self.since = 0.0

    @property
    def root(self) -> "Claim":
        """The outermost claim around it, or itself."""
        return self.within[0] if self.within else self

    @property
    def holds(self) -> bool:
        """Whether nobody else may have what it asked for."""
        return self.state is State.HELD or self.state is State.YIELDING

    @property
    def base(self) -> int:
        """The urgency by which it takes resources away."""
        return max(self.urgency, self.inherited)

    def __repr__(self) -> str:
        return f"Claim({self.who!r}, {[str(each) for each in self.uses]}, {self.state})"
