"""Deadlocks: claims that wait for each other in a cycle."""

from collections.abc import Callable, Iterable, Sequence

from jacaros.env.resources.claim import Claim

WaitsFor = Callable[[Claim], Iterable[tuple[Claim, str]]]
"""The holders that a waiting claim waits for, each with the resource."""


def victim_of(
    waiting: Sequence[Claim], waits_for: WaitsFor, rank: Callable[[Claim], int]
) -> tuple[Claim, str] | None:
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
    return min(in_circle, key=lambda each: (rank(each[0]), -each[0].order), default=None)


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
