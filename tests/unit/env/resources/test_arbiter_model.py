"""Random schedules of claims, checked after each step against what the rules promise."""

from dataclasses import dataclass, field
from random import Random

import pytest

from jacaros.clock import VirtualClock, run
from jacaros.env.resources.arbiter import Arbiter
from jacaros.env.resources.claim import POLICIES, Claim, State
from jacaros.env.resources.resource import Use
from jacaros.env.values import Atom, Structure

NAMES = ("base", "arm", "lift", "map")
CAPACITIES = {"lift": 2}
SCHEDULES, STEPS = 10_000, 14


@dataclass
class Party:
    """A claimant that gives way at once, later or never, and now and then dies of being told something."""

    arbiter: Arbiter
    chance: Random
    can_yield: bool
    told: list[str] = field(default_factory=list)

    def granted(self, claim: Claim) -> None:
        assert not self.told or self.told[-1] != "granted", "granted twice"
        self.told.append("granted")
        if self.chance.random() < 0.05:
            self.arbiter.leave(claim)

    def preempted(self, claim: Claim, resource: str) -> None:
        assert self.told[-1] == "granted", "what holds nothing cannot give way"
        assert resource in {use.name for use in claim.uses}
        self.told.append("preempted")
        choice = self.chance.random()
        if choice < 0.4:
            self.arbiter.gave_way(claim)
        elif choice < 0.5:
            self.arbiter.leave(claim)

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        assert claim.state is State.OUT
        self.told.append("refused")


class Schedule:
    """One random history of an arbiter."""

    def __init__(self, seed: int) -> None:
        self.chance = Random(seed)
        self.clock = VirtualClock()
        self.arbiter = Arbiter(self.clock)
        self.claims: list[Claim] = []

    def step(self) -> None:
        """Make, give way, or end: one of them at random."""
        choice, alive = self.chance.random(), [c for c in self.claims if c.state is not State.OUT]
        yielding = [c for c in alive if c.state is State.YIELDING]
        if choice < 0.5 or not alive:
            self._make(alive)
        elif choice < 0.7 and yielding:
            self.arbiter.gave_way(self.chance.choice(yielding))
        else:
            self._end(self.chance.choice(alive))

    def _make(self, alive: list[Claim]) -> None:
        names = self.chance.sample(NAMES, self.chance.choice((1, 1, 1, 2, 3)))
        uses = tuple(Use(n, CAPACITIES.get(n), n == "map" and self.chance.random() < 0.7) for n in names)
        held = [c for c in alive if c.state is State.HELD]
        within: tuple[Claim, ...] = ()
        if held and self.chance.random() < 0.35:
            outer = self.chance.choice(held)
            within = (*outer.within, outer)
        party = Party(self.arbiter, self.chance, self.chance.random() < 0.8)
        policy = self.chance.choice(POLICIES) if self.chance.random() < 0.3 else "wait"
        claim = Claim(uses, str(len(self.claims)), party, self.chance.choice((0, 0, 1, 5)), policy, within)
        self.claims.append(claim)
        self.arbiter.enter(claim)

    def _end(self, claim: Claim) -> None:
        """A party dies with all that it has within."""
        for each in reversed(self.claims):
            if claim in each.within or each is claim:
                self.arbiter.leave(each)

    def check(self) -> None:
        """Nobody has what another one has, and nothing is free that somebody may have."""
        holders = [c for c in self.claims if c.holds]
        for name in NAMES:
            mine = [c for c in holders if any(u.name == name for u in c.uses)]
            assert set(mine) == set(self.arbiter.holders(name)), "a death frees all, and nothing else does"
            for one in mine:
                together = [c for c in mine if c not in one.within and one not in c.within]
                assert self._go_together(name, together), (name, mine)
        for claim in self.claims:
            if claim.state is State.WAITING and all(o.state is State.HELD for o in claim.within):
                assert self._must_wait(claim, holders), f"{claim} was forgotten"

    def _go_together(self, name: str, claims: list[Claim]) -> bool:
        """By counting alone: readers, or no more than the capacity; a claim counts with those within it."""
        uses = [u for c in claims for u in c.uses if u.name == name]
        if all(u.shared for u in uses):
            return True
        inner = [c for c in claims if not any(c in o.within for o in claims)]
        return len(inner) <= CAPACITIES.get(name, 1) and not any(u.shared for u in uses)

    def _must_wait(self, claim: Claim, holders: list[Claim]) -> bool:
        ahead = self.arbiter.waiting()
        before = ahead[: ahead.index(claim)]
        before = tuple(c for c in before if all(o.state is State.HELD for o in c.within))
        return any(
            not self._fits(use, claim, [h for h in holders if h not in claim.within])
            or (not claim.within and any(u.name == use.name for c in before for u in c.uses))
            for use in claim.uses
        )

    def _fits(self, use: Use, claim: Claim, holders: list[Claim]) -> bool:
        mine = [h for h in holders if any(u.name == use.name for u in h.uses)]
        return self._go_together(use.name, [*mine, claim])


@pytest.mark.parametrize("part", range(10))
def test_no_schedule_breaks_a_promise(part: int) -> None:
    async def main() -> None:
        share = SCHEDULES // 10
        for seed in range(part * share, (part + 1) * share):
            schedule = Schedule(seed)
            for _ in range(STEPS):
                schedule.step()
                schedule.check()
            for claim in list(schedule.claims):
                schedule.arbiter.leave(claim)
            assert not schedule.arbiter.waiting()
            assert not any(map(schedule.arbiter.holders, NAMES))

    run(main, VirtualClock())
