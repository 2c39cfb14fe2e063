"""Random schedules of claims, checked after each step against the rules."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from hypothesis import given, settings
from hypothesis import strategies as st

from jacaros.artifacts.env.arbiter import POLICIES, Arbiter, Claim, ClaimState
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.clock import VirtualClock, run

NAMES = ("base", "arm", "lift", "map")
SCHEDULES = 10_000
Item = TypeVar("Item")


class Choices:
    """Decisions, read from bytes; without any left, the first alternative, which is the simplest."""

    def __init__(self, decisions: bytes) -> None:
        self._left = list(reversed(decisions))

    def __bool__(self) -> bool:
        return bool(self._left)

    def one_of(self, alternatives: Sequence[Item]) -> Item:
        """Choose one of up to 256 alternatives."""
        return alternatives[self._left.pop() % len(alternatives) if self._left else 0]

    def rarely(self, often: int) -> bool:
        """Return True with probability 1 / *often*."""
        return self.one_of(range(often)) == often - 1

    def some_of(self, alternatives: Sequence[Item], count: int) -> list[Item]:
        """Choose several different ones."""
        left = list(alternatives)
        return [left.pop(left.index(self.one_of(left))) for _ in range(count)]


@dataclass
class Party:
    """A claimant that yields immediately, later or never, and sometimes ends in a callback."""

    arbiter: Arbiter
    choices: Choices
    can_yield: bool
    told: list[str] = field(default_factory=list)

    def granted(self, claim: Claim) -> None:
        assert not self.told or self.told[-1] != "granted", "granted twice"
        self.told.append("granted")
        if self.choices.rarely(20):
            self.arbiter.leave(claim)

    def preempted(self, claim: Claim, resource: str) -> None:
        assert self.told[-1] == "granted", "what holds nothing cannot give way"
        assert resource in claim.uses
        self.told.append("preempted")
        answer = self.choices.one_of(
            ("now", "now", "now", "now", "later", "later", "later", "later", "later", "end")
        )
        if answer == "now":
            self.arbiter.gave_way(claim)
        elif answer == "end":
            self.arbiter.leave(claim)

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        assert claim.state is ClaimState.OUT
        self.told.append("refused")


class Schedule:
    """One history of an arbiter.  Some claims are for plans of one agent, and at most one of these is atomic."""

    def __init__(self, choices: Choices) -> None:
        self.choices = choices
        self.arbiter = Arbiter(VirtualClock())
        self.claims: list[Claim] = []

    def step(self) -> None:
        """Make a claim, give way, or end one."""
        alive = [c for c in self.claims if c.state is not ClaimState.OUT]
        yielding = [c for c in alive if c.state is ClaimState.YIELDING]
        step = self.choices.one_of(("make", "make", "make", "give way", "end"))
        if step == "make" or not alive:
            self._make(alive)
        elif step == "give way" and yielding:
            self.arbiter.gave_way(self.choices.one_of(yielding))
        else:
            self._end(self.choices.one_of(alive))

    def _make(self, alive: list[Claim]) -> None:
        choices = self.choices
        uses = tuple(choices.some_of(NAMES, choices.one_of((1, 1, 1, 2, 3))))
        held = [c for c in alive if c.state is ClaimState.HELD]
        within: tuple[Claim, ...] = ()
        if held and choices.rarely(3):
            outer = choices.one_of(held)
            within = (*outer.within, outer)
        plan_of = choices.one_of(("", "", "robot"))
        atomic = bool(plan_of) and not any(c.blocks for c in alive) and not choices.rarely(2)
        party = Party(self.arbiter, choices, not atomic and not choices.rarely(5))
        policy = choices.one_of(("wait", "wait", "wait", "wait", "wait", "wait", "wait", *POLICIES))
        urgency, blocks = choices.one_of((0, 0, 1, 5)), "robot" if atomic else ""
        claim = Claim(uses, str(len(self.claims)), party, urgency, policy, within, plan_of, blocks)
        self.claims.append(claim)
        self.arbiter.enter(claim)

    def _end(self, claim: Claim) -> None:
        """A party dies with all that it has within."""
        for each in reversed(self.claims):
            if claim in each.within or each is claim:
                self.arbiter.leave(each)

    def check(self) -> None:
        """No resource is held twice, and no claim waits for a free one."""
        holders = [c for c in self.claims if c.holds]
        for name in NAMES:
            mine = [c for c in holders if name in c.uses]
            assert set(mine) == set(self.arbiter.holders(name)), "a death frees all, and nothing else does"
            for one in mine:
                together = [c for c in mine if c not in one.within and one not in c.within]
                assert _go_together(together), (name, mine)
        for claim in self.claims:
            if claim.state is ClaimState.WAITING and all(o.state is ClaimState.HELD for o in claim.within):
                assert self._must_wait(claim, holders), f"{claim} was forgotten"

    def _must_wait(self, claim: Claim, holders: list[Claim]) -> bool:
        if self._is_blocked(claim):
            return True
        ahead = self.arbiter.waiting()
        before = [
            each
            for each in ahead[: ahead.index(claim)]
            if all(o.state is ClaimState.HELD for o in each.within) and not self._is_blocked(each)
        ]
        outermost = not claim.within or any(h.state is ClaimState.YIELDING for h in holders)
        return any(
            not self._fits(name, claim, [h for h in holders if h not in claim.within])
            or (outermost and any(name in c.uses for c in before))
            for name in claim.uses
        )

    def _is_blocked(self, claim: Claim) -> bool:
        """Return whether an atomic plan of its agent has or waits for a claim."""
        atomic = any(c.blocks for c in self.claims if c.state is not ClaimState.OUT)
        return atomic and bool(claim.plan_of) and not claim.blocks

    def _fits(self, name: str, claim: Claim, holders: list[Claim]) -> bool:
        return _go_together([*(h for h in holders if name in h.uses), claim])


def _go_together(claims: list[Claim]) -> bool:
    """Return whether one resource serves them all: one claim, with those within it."""
    return len([c for c in claims if not any(c in other.within for other in claims)]) <= 1


def test_no_schedule_breaks_an_invariant() -> None:
    tried = 0

    @settings(max_examples=SCHEDULES, derandomize=True, database=None, deadline=None)
    @given(st.binary(min_size=32, max_size=96))
    def keeps_promises(decisions: bytes) -> None:
        nonlocal tried
        tried += 1
        schedule = Schedule(Choices(decisions))
        while schedule.choices:
            schedule.step()
            schedule.check()
        for claim in list(schedule.claims):
            schedule.arbiter.leave(claim)
        assert not schedule.arbiter.waiting()
        assert not any(map(schedule.arbiter.holders, NAMES))

    async def main() -> None:
        keeps_promises()

    run(main, VirtualClock())
    assert tried >= SCHEDULES
