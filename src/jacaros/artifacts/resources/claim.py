"""One claim of resources, from request to release."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Literal, Protocol

from jacaros.artifacts.env.values import Atom, Structure

# The resources that an operation or plan uses: ``wheels``, ``lift(2)`` (two units) or ``map(shared)`` (readers).


_WRITTEN = re.compile(r"([A-Za-z_][A-Za-z0-9_/]*)(?:\((shared|[0-9]+)\))?")

WHEELS = "wheels"
"""The resource that every motion of a robot uses."""


@dataclass(frozen=True, slots=True)
class Use:
    """The use of one resource by a claim.

    Attributes:
        name: name of the resource. One of a robot begins with the robot's name, such as ``/robot_0/wheels``.
        capacity: number of units that exist. None: as declared elsewhere, or 1.
        shared: any number of shared uses are compatible, but none with another use.
        units: number of units that are claimed.
    """

    name: str
    capacity: int | None = None
    shared: bool = False
    units: int = 1

    def __str__(self) -> str:
        inner = "shared" if self.shared else self.capacity
        return self.name if inner is None else f"{self.name}({inner})"


def read_use(text: str) -> Use:
    """Parse one use, such as ``lift(2)``.

    Raises:
        ValueError: *text* is not a use. The message says what to write.
    """
    found = _WRITTEN.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"invalid resource `{text}`; write name, name(2) or name(shared)")
    name, inner = found.groups()
    if inner == "shared":
        return Use(name, shared=True)
    if inner is None:
        return Use(name)
    if int(inner) < 1:
        raise ValueError(f"invalid resource `{text}`: the capacity must be at least 1")
    return Use(name, int(inner))


def read_uses(written: str | Use | Iterable[str | Use]) -> tuple[Use, ...]:
    """Parse the uses of a declaration: one, or several.

    Raises:
        ValueError: one of them is not a use.
    """
    listed = (written,) if isinstance(written, str | Use) else tuple(written)
    return together(each if isinstance(each, Use) else read_use(each) for each in listed)


def together(uses: Iterable[Use]) -> tuple[Use, ...]:
    """Merge uses of the same resource. A resource that is named twice needs two units."""
    found: dict[str, Use] = {}
    for each in uses:
        known = found.get(each.name)
        if known is None:
            found[each.name] = each
            continue
        capacities = [c for c in (known.capacity, each.capacity) if c is not None]
        found[each.name] = Use(
            each.name,
            min(capacities, default=None),
            known.shared and each.shared,
            known.units if known.shared and each.shared else known.units + each.units,
        )
    return tuple(found.values())


def scoped(uses: Sequence[Use], scope: str) -> tuple[Use, ...]:
    """Return the resources of one robot. *scope* is its name, empty for resources of the whole run."""
    return tuple(replace(each, name=f"{scope}/{each.name}") for each in uses) if scope else tuple(uses)


def local_name(name: str) -> str:
    """Return the name of a resource without that of its robot."""
    return name.rpartition("/")[2]


Policy = Literal["wait", "refuse", "take"]
"""What a claim does if it is not granted immediately: wait, fail, or take the resource, also from an equal."""

POLICIES: tuple[Policy, ...] = ("wait", "refuse", "take")


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
        waited: seconds that it waited before the current wait.
        since: begin of the current wait.
        warned: whether its long wait has been logged.
    """

    uses: tuple[Use, ...]
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
    waited: float = field(default=0.0, init=False)
    since: float = field(default=0.0, init=False)
    warned: bool = field(default=False, init=False)

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
        return f"Claim({self.who!r}, {[str(each) for each in self.uses]}, {self.state})"
