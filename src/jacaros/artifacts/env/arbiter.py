"""Assigns resources to claims: the most urgent claim first, among equals the earliest.

A claim is granted everything it asks for, or nothing. The rules:

* A claim waits behind earlier claims in the queue that want one of its resources, and while others hold one.
* A more urgent claim preempts: less urgent holders are asked to yield, the least urgent and newest first, unless one of
  them is as urgent. A holder keeps its resources until it has yielded (a robot brakes). Then it waits again.
* A nested claim (an operation of a plan that holds the resource) is granted only while the outer claims are, and what they
  hold does not block it. It waits behind earlier claims only while holders yield to them.
* A claim of an atomic plan preempts other plans of its agent, however urgent: they make no step before it ends, and wait
  again until then.
* A holder that cannot yield inherits the urgency of the claims it blocks.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import partial
from typing import Literal, Protocol

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.clock import Clock, Timer

# One claim of resources, from request to release.


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


class ClaimState(StrEnum):
    """The state of a claim."""

    OUT = "out"
    WAITING = "waiting"
    HELD = "held"
    YIELDING = "yielding"


HOLDING = (ClaimState.HELD, ClaimState.YIELDING)
"""States in which no other claim can have the resources."""


class Claimant(Protocol):
    """Receives the events of a claim: an operation, or the plan of an agent. Each method may call the arbiter."""

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
    state: ClaimState = field(default=ClaimState.OUT, init=False)
    fresh: bool = field(default=True, init=False)
    order: int = field(default=0, init=False)
    inherited: int = field(default=0, init=False)
    report: Timer | None = field(default=None, init=False)

    @property
    def root(self) -> "Claim":
        """The outermost claim around it, or itself."""
        return self.within[0] if self.within else self

    @property
    def base(self) -> int:
        """The urgency with which it preempts."""
        return max(self.urgency, self.inherited)

    def __repr__(self) -> str:
        return f"Claim({self.who!r}, {list(self.uses)}, {self.state})"


# Deadlocks: claims that wait for each other in a cycle.


WaitsFor = Callable[[Claim], Iterable[tuple[Claim, str]]]
"""The holders that a waiting claim waits for, each with the resource."""


def victim_of(waiting: Sequence[Claim], waits_for: WaitsFor) -> tuple[Claim, str] | None:
    """Return the claim that should fail to break a deadlock, and the resource it waits for; None without a deadlock.

    It is the least urgent one, among equals the newest. The outermost claim counts: a plan that holds one resource and
    waits for another one is one party.
    """
    edges: dict[Claim, list[tuple[Claim, Claim, str]]] = {}
    for claim in waiting:
        if claim.within:
            found = [
                (holder.root, claim, name)
                for holder, name in waits_for(claim)
                if holder.root is not claim.root
            ]
            edges.setdefault(claim.root, []).extend(found)
    in_circle = [
        (claim, name)
        for party, found in edges.items()
        for other, claim, name in found
        if _reaches(edges, other, party)
    ]
    return min(in_circle, key=lambda each: (each[0].base, -each[0].order), default=None)


def _reaches(edges: dict[Claim, list[tuple[Claim, Claim, str]]], start: Claim, goal: Claim) -> bool:
    """Return whether one party waits for another, directly or indirectly."""
    seen: set[Claim] = set()
    left = [start]
    while left:
        party = left.pop()
        if party is goal:
            return True
        if party not in seen:
            seen.add(party)
            left.extend(other for other, _, _ in edges.get(party, ()))
    return False


OwnerListener = Callable[[str, str | None], None]
"""Takes a resource and its new owner: the outermost plan or operation that holds it, or None if it is free."""

REPORTED = 300.0
"""Seconds of waiting that cause a warning. Charging for a minute is not starvation."""


class Arbiter:
    """The resources of one environment.

    Args:
        clock: measures how long claims wait.
        warn: takes a warning.
    """

    def __init__(self, clock: Clock, warn: Callable[[str], None] = lambda text: None) -> None:
        self._clock, self._warn = clock, warn
        self._waiting: list[Claim] = []
        self._holders: dict[str, list[Claim]] = {}
        self._arrivals = 0
        self._settling = self._again = False
        self._listener: OwnerListener | None = None
        self._owners: dict[str, str] = {}

    # ---- state

    def listen(self, listener: OwnerListener | None) -> None:
        """Report the owners of resources to *listener* from now on, present ones immediately; None ends this."""
        self._listener, self._owners = listener, {}
        self._report_owners()

    def holders(self, name: str) -> tuple[Claim, ...]:
        """Return the claims that hold a resource."""
        return tuple(self._holders.get(name, ()))

    def waiting(self) -> tuple[Claim, ...]:
        """Return the waiting claims, in the order of the queue."""
        return tuple(self._in_order())

    # ---- claims

    def enter(self, claim: Claim) -> bool:
        """Make a claim. Return False if it is not granted immediately; its claimant is notified later."""
        if claim.state is ClaimState.OUT:
            self._arrivals += 1
            claim.order = self._arrivals
            self._wait(claim)
            self._settle()
        return claim.state is ClaimState.HELD

    def gave_way(self, claim: Claim) -> None:
        """Report that a claim has yielded. It waits to be granted again."""
        if claim.state is ClaimState.YIELDING:
            self._let_go(claim)
            self._wait(claim)
            self._settle()

    def leave(self, claim: Claim) -> None:
        """Release a claim, or its place in the queue. Releasing it again has no effect."""
        if claim.state is ClaimState.OUT:
            return
        if claim.state is ClaimState.WAITING:
            self._stop_waiting(claim)
        else:
            self._let_go(claim)
        claim.state = ClaimState.OUT
        claim.inherited = 0
        self._settle()

    def _wait(self, claim: Claim) -> None:
        claim.state = ClaimState.WAITING
        self._waiting.append(claim)

    def _stop_waiting(self, claim: Claim) -> None:
        self._waiting.remove(claim)
        if claim.report is not None:
            claim.report.cancel()
            claim.report = None

    def _let_go(self, claim: Claim) -> None:
        for name in claim.uses:
            held = self._holders[name]
            held.remove(claim)
            if not held:
                del self._holders[name]

    # ---- the next claim

    def _settle(self) -> None:
        """Grant, preempt and refuse until nothing changes. Claimants may call the arbiter meanwhile."""
        self._again = True
        if self._settling:
            return
        self._settling = True
        try:
            while self._again:
                self._again = False
                if self._change_one():
                    self._again = True
        finally:
            self._settling = False
        for claim in self._waiting:
            if claim.report is None:
                claim.report = self._clock.call_later(REPORTED, partial(self._report, claim))
        self._report_owners()

    def _report_owners(self) -> None:
        if self._listener is None:
            return
        owners = {name: claims[0].root.who for name, claims in self._holders.items()}
        for name in dict.fromkeys((*self._owners, *owners)):
            if owners.get(name) != self._owners.get(name):
                self._listener(name, owners.get(name))
        self._owners = owners

    def _change_one(self) -> bool:
        """Change the state of one claim. Return False if no claim needs a change."""
        self._inherit()
        reserved: set[str] = set()
        coming: set[str] = set()
        blocked = {claim.blocks for claim in self._all() if claim.blocks}
        for claim in self._in_order():
            if claim.plan_of in blocked and not claim.blocks:
                continue
            if any(outer.state is not ClaimState.HELD for outer in claim.within):
                continue
            blockers = self._blockers(claim)
            wanted = set(claim.uses)
            ahead = bool(wanted & (coming if claim.within else reserved))
            if not blockers and not ahead:
                self._grant(claim)
                return True
            # What others release goes to earlier claims first.
            if (not ahead and self._preempt(claim, blockers)) or self._refuse(claim, blockers, ahead):
                return True
            reserved |= wanted
            going = self._chosen(claim, blockers)
            if going and not ahead and _all_go(going):
                coming |= wanted
        return self._break_deadlock()

    def _in_order(self) -> list[Claim]:
        return sorted(self._waiting, key=lambda each: (-each.base, each.order))

    def _grant(self, claim: Claim) -> None:
        self._stop_waiting(claim)
        claim.state, claim.fresh = ClaimState.HELD, False
        for name in claim.uses:
            self._holders.setdefault(name, []).append(claim)
        claim.claimant.granted(claim)

    def _preempt(self, claim: Claim, blockers: list[tuple[Claim, str]]) -> bool:
        """Ask one holder to yield. Return False if no holder can be asked."""
        chosen = self._chosen(claim, blockers)
        stays = not _all_go(chosen)
        for holder, resource in chosen:
            # A nested claim would be granted again immediately, and asked again, as long as an outer one holds.
            if (
                holder.state is ClaimState.HELD
                and holder.claimant.can_yield
                and not (stays and holder.within)
            ):
                holder.state = ClaimState.YIELDING
                holder.claimant.preempted(holder, resource)
                return True
        return False

    def _chosen(self, claim: Claim, blockers: list[tuple[Claim, str]]) -> list[tuple[Claim, str]]:
        """Return the holders that must yield to a claim, the first to ask first. Empty if one of them may stay."""
        if any(
            holder.state is ClaimState.HELD and not self._outranks(claim, holder) for holder, _ in blockers
        ):
            return []
        # A holder that is yielding has been asked already.
        return sorted(
            blockers, key=lambda each: (each[0].state is ClaimState.HELD, each[0].base, -each[0].order)
        )

    def _outranks(self, claim: Claim, holder: Claim) -> bool:
        return bool(claim.blocks and claim.blocks == holder.plan_of) or claim.base > holder.base

    def _refuse(self, claim: Claim, blockers: list[tuple[Claim, str]], ahead: bool) -> bool:
        """Refuse a claim that must not wait, unless holders are yielding to it."""
        if claim.policy != "refuse" or not claim.fresh:
            return False
        if not ahead and self._chosen(claim, blockers):
            return False
        name = blockers[0][1] if blockers else claim.uses[0]
        self._fail(claim, Structure("resource_busy", (Atom(local_name(name)),)))
        return True

    def _break_deadlock(self) -> bool:
        """Fail one claim of a deadlock. Return False without a deadlock."""
        found = victim_of(self._waiting, self._waits_for)
        if found is None:
            return False
        claim, resource = found
        self._warn(f"deadlock: {claim.who} waits for {resource}; its claim fails")
        self._fail(claim, Structure("deadlock", (Atom(local_name(resource)),)))
        return True

    def _fail(self, claim: Claim, reason: Structure) -> None:
        self._stop_waiting(claim)
        claim.state = ClaimState.OUT
        claim.claimant.refused(claim, reason)

    # ---- blocking claims

    def _blockers(self, claim: Claim) -> list[tuple[Claim, str]]:
        """Return the holders that must yield before a claim can be granted, each with the resource."""
        return [
            (holder, name)
            for name in claim.uses
            for holder in self._holders.get(name, ())
            if holder not in claim.within and claim not in holder.within
        ]

    def _waits_for(self, claim: Claim) -> Iterator[tuple[Claim, str]]:
        return ((holder, name) for holder, name in self._blockers(claim) if holder.state is ClaimState.HELD)

    # ---- urgency

    def _inherit(self) -> None:
        """Lend the urgency of waiting claims to holders that cannot yield to them."""
        claims = self._all()
        for each in claims:
            each.inherited = 0
        changed = True
        while changed:
            changed = False
            for claim in self._waiting:
                for holder, _ in self._blockers(claim):
                    if holder.base >= claim.base or (
                        holder.state is ClaimState.YIELDING or holder.claimant.can_yield
                    ):
                        continue
                    for each in claims:
                        if each.root is holder.root and each.inherited < claim.base:
                            each.inherited = claim.base
                            changed = True

    def _all(self) -> list[Claim]:
        held = (each for holders in self._holders.values() for each in holders)
        return list(dict.fromkeys((*held, *self._waiting)))

    def _report(self, claim: Claim) -> None:
        """Log a claim that has waited for long."""
        holders = dict.fromkeys(holder.who for holder, _ in self._blockers(claim))
        names = ", ".join(map(local_name, claim.uses))
        held = f", held by {', '.join(holders)}" if holders else ""
        self._warn(f"{claim.who} has waited {REPORTED:g} s for {names}{held}")


def _all_go(chosen: list[tuple[Claim, str]]) -> bool:
    """Return whether all are yielding, or will when asked."""
    return all(each.state is ClaimState.YIELDING or each.claimant.can_yield for each, _ in chosen)
