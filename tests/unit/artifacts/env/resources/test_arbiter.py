"""The arbiter of resources: who holds them, who waits, and what a more urgent claim does."""

from dataclasses import dataclass, field

import pytest

from jacaros.artifacts.env.arbiter import HOLDING, REPORTED, Arbiter, Claim, ClaimState, read_uses, scoped
from jacaros.artifacts.env.values import Atom, Structure, text
from jacaros.runtime.clock import VirtualClock, run


@dataclass
class Party:
    """A claimant that records its events, and yields immediately by default."""

    arbiter: Arbiter
    can_yield: bool = True
    brakes: bool = False
    told: list[str] = field(default_factory=list)

    def granted(self, claim: Claim) -> None:
        self.told.append("granted")

    def preempted(self, claim: Claim, resource: str) -> None:
        self.told.append(f"preempted({resource})")
        if not self.brakes:
            self.arbiter.gave_way(claim)

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        self.told.append(text(reason, True))


class Table:
    """An arbiter, with short methods for claims."""

    def __init__(self):
        self.clock, self.warnings = VirtualClock(), []
        self.arbiter = Arbiter(self.clock, self.warnings.append)

    def claim(self, *uses, urgency=0, policy="wait", within=(), enter=True, who="another", **more):
        party = Party(self.arbiter, more.get("can_yield", True), more.get("brakes", False))
        plan = more.get("plan_of", ""), more.get("blocks", "")
        made = Claim(read_uses(uses), who, party, urgency, policy, within, *plan)
        if enter:
            self.arbiter.enter(made)
        return made


def told(claim):
    return claim.claimant.told


@pytest.fixture
def table():
    return Table()


def test_equal_claims_are_granted_in_order(table):
    a, b, c = (table.claim("wheels") for _ in range(3))
    assert [each.state for each in (a, b, c)] == [ClaimState.HELD, ClaimState.WAITING, ClaimState.WAITING]
    table.arbiter.leave(b)
    table.arbiter.leave(a)
    assert c.state is ClaimState.HELD
    table.arbiter.leave(a)
    assert table.arbiter.holders("wheels") == (c,)
    table.arbiter.enter(b)
    table.arbiter.leave(c)
    assert b.state is ClaimState.HELD


def test_several_resources_are_granted_together_or_not_at_all(table):
    arm = table.claim("arm")
    both = table.claim("base", "arm")
    assert not table.arbiter.holders("base")
    later = table.claim("base")
    assert later.state is ClaimState.WAITING, "or the claim to both would starve"
    table.arbiter.leave(arm)
    assert both.state in HOLDING
    table.arbiter.leave(both)
    assert later.state in HOLDING


def test_a_more_urgent_claim_preempts_and_the_preempted_one_is_granted_again(table):
    patrol, other = table.claim("wheels"), table.claim("wheels")
    flee = table.claim("wheels", urgency=10)
    assert flee.state in HOLDING
    assert told(patrol) == ["granted", "preempted(wheels)"]
    table.arbiter.leave(flee)
    assert patrol.state in HOLDING
    assert other.state is ClaimState.WAITING


def test_a_holder_keeps_the_resource_until_it_has_yielded(table):
    patrol = table.claim("wheels", brakes=True)
    flee = table.claim("wheels", urgency=10)
    assert (patrol.state, flee.state) == (ClaimState.YIELDING, ClaimState.WAITING)
    table.arbiter.leave(flee)
    table.arbiter.gave_way(patrol)
    assert told(patrol) == ["granted", "preempted(wheels)", "granted"], "the preempting claim was withdrawn"
    flee = table.claim("wheels", urgency=10)
    assert flee.state not in HOLDING
    table.arbiter.gave_way(patrol)
    assert flee.state in HOLDING


def test_the_more_urgent_of_the_preempted_goes_first(table):
    low = table.claim("wheels")
    middle = table.claim("wheels", urgency=5)
    high = table.claim("wheels", urgency=9)
    table.arbiter.leave(high)
    assert middle.state in HOLDING
    table.arbiter.leave(middle)
    assert low.state in HOLDING


def test_a_claim_within_another_does_not_wait_for_it(table):
    plan = table.claim("base", "arm")
    drive = table.claim("base", within=(plan,))
    assert drive.state in HOLDING
    turn = table.claim("base", within=(plan,))
    assert turn.state is ClaimState.WAITING, "two motions of one plan exclude each other"
    table.arbiter.leave(drive)
    assert turn.state in HOLDING


def test_preempting_a_plan_preempts_its_operation_and_both_are_granted_again(table):
    plan = table.claim("base", "arm")
    drive = table.claim("base", within=(plan,), brakes=True)
    flee = table.claim("base", urgency=1)
    assert (plan.state, drive.state, flee.state) == (
        ClaimState.WAITING,
        ClaimState.YIELDING,
        ClaimState.WAITING,
    )
    table.arbiter.gave_way(drive)
    assert flee.state in HOLDING
    table.arbiter.leave(flee)
    assert plan.state in HOLDING
    assert drive.state in HOLDING


def test_refuse_fails_immediately_but_waits_for_a_yielding_holder(table):
    holder = table.claim("wheels", urgency=5, brakes=True)
    assert told(table.claim("wheels", policy="refuse")) == ["resource_busy(wheels)"]
    urgent = table.claim("wheels", urgency=6, policy="refuse")
    assert told(urgent) == []
    table.arbiter.gave_way(holder)
    assert urgent.state in HOLDING


def test_a_holder_that_cannot_yield_inherits_the_urgency_of_what_it_blocks(table):
    atomic = table.claim("base", can_yield=False)
    middle = table.claim("arm", urgency=5)
    urgent = table.claim("base", urgency=10)
    assert atomic.state is ClaimState.HELD
    inner = table.claim("arm", within=(atomic,))
    assert inner.state in HOLDING, "it goes before the one with urgency 5"
    assert middle.state not in HOLDING
    table.arbiter.leave(inner)
    table.arbiter.leave(atomic)
    assert urgent.state in HOLDING
    assert middle.state in HOLDING


def test_a_deadlock_of_plans_fails_the_newest_of_the_least_urgent(table):
    one, other = table.claim("base", who="[a] !one"), table.claim("arm", who="[a] !other")
    wants_arm = table.claim("arm", within=(one,), who="[a] !one")
    assert not told(wants_arm)
    wants_base = table.claim("base", within=(other,), who="[a] !other")
    assert told(wants_base) == ["deadlock(base)"]
    assert table.warnings == ["deadlock: [a] !other waits for base; its claim fails"]
    table.arbiter.leave(other)
    assert wants_arm.state in HOLDING


def test_a_deadlock_with_a_more_urgent_claim_ends_by_preemption(table):
    one, other = table.claim("base", urgency=1), table.claim("arm")
    wants_base = table.claim("base", within=(other,))
    wants_arm = table.claim("arm", within=(one,), urgency=1)
    assert wants_arm.state in HOLDING
    assert not told(wants_base)
    table.arbiter.leave(wants_arm)
    table.arbiter.leave(one)
    assert other.state in HOLDING
    assert wants_base.state in HOLDING


def test_a_long_wait_is_reported_once_with_the_holder(table):
    async def main():
        first = table.claim("wheels", urgency=1, who="[a] !clean")
        waiting = table.claim("wheels", who="[a] !scan")
        short = table.claim("wheels", who="[a] !turn")
        table.arbiter.leave(short)
        await table.clock.sleep(REPORTED - 1)
        assert not table.warnings
        await table.clock.sleep(2 * REPORTED)
        assert table.warnings == ["[a] !scan has waited 300 s for wheels, held by [a] !clean"]
        table.arbiter.leave(first)
        assert waiting.state in HOLDING

    run(main, table.clock)


def test_uses_are_checked() -> None:
    assert read_uses("wheels") == ("wheels",)
    assert read_uses(("base", "/r1/arm", "base")) == ("base", "/r1/arm")
    assert scoped(read_uses("wheels"), "/r1") == ("/r1/wheels",)
    for wrong in ("", "two words", "lift(2)"):
        with pytest.raises(ValueError, match="resource"):
            read_uses(wrong)


# --- atomic plans ---------------------------------------------------------------------------------------------


def test_an_atomic_plan_takes_what_a_plan_of_its_agent_holds_however_urgent_that_is(table):
    plan = table.claim("wheels", urgency=5, plan_of="robot")
    atomic = table.claim("wheels", can_yield=False, blocks="robot")
    assert (plan.state, atomic.state) == (ClaimState.WAITING, ClaimState.HELD)
    table.arbiter.leave(atomic)
    assert plan.state is ClaimState.HELD


def test_an_atomic_plan_waits_for_operations_and_for_other_agents(table):
    for holder in (table.claim("wheels"), table.claim("wheels", plan_of="other", enter=False)):
        table.arbiter.enter(holder)
        atomic = table.claim("wheels", blocks="robot")
        assert atomic.state is ClaimState.WAITING
        table.arbiter.leave(holder)
        assert atomic.state is ClaimState.HELD
        table.arbiter.leave(atomic)


def test_a_running_operation_ends_before_its_plan_yields_to_an_atomic_one(table):
    plan = table.claim("wheels", plan_of="robot")
    drive = table.claim("wheels", within=(plan,))
    atomic = table.claim("wheels", blocks="robot")
    assert (plan.state, drive.state, atomic.state) == (ClaimState.HELD, ClaimState.HELD, ClaimState.WAITING)
    table.arbiter.leave(drive)
    assert (plan.state, atomic.state) == (ClaimState.WAITING, ClaimState.HELD)


def test_a_waiting_plan_queues_only_behind_an_atomic_one_of_its_agent(table):
    holder = table.claim("wheels", plan_of="other", can_yield=False)
    plan = table.claim("wheels", urgency=5, plan_of="robot")
    guest = table.claim("wheels", urgency=5)
    atomic = table.claim("wheels", plan_of="robot", blocks="robot")
    table.arbiter.leave(holder)
    assert (plan.state, guest.state, atomic.state) == (
        ClaimState.WAITING,
        ClaimState.HELD,
        ClaimState.WAITING,
    )
    table.arbiter.leave(guest)
    assert (plan.state, atomic.state) == (ClaimState.WAITING, ClaimState.HELD)
    table.arbiter.leave(atomic)
    assert plan.state is ClaimState.HELD


# --- claims that would have it again at once --------------------------------------------------------------------


def test_a_claim_nested_in_one_that_stays_is_not_asked_to_yield(table):
    plan = table.claim("base", urgency=1, can_yield=False)
    step = table.claim("base", within=(plan,))
    taker = table.claim("base", urgency=2)
    assert (plan.state, step.state, taker.state) == (ClaimState.HELD, ClaimState.HELD, ClaimState.WAITING)


def test_a_nested_claim_does_not_take_back_what_it_yielded_to_one_that_waits_for_more(table):
    plan = table.claim("lift", urgency=1)
    braking = table.claim("arm", urgency=1, brakes=True)
    step = table.claim("map", within=(plan,))
    urgent = table.claim("arm", "map", urgency=5)
    assert (braking.state, step.state) == (ClaimState.YIELDING, ClaimState.WAITING)
    table.arbiter.gave_way(braking)
    assert (plan.state, urgent.state, step.state) == (ClaimState.HELD, ClaimState.HELD, ClaimState.WAITING)
    table.arbiter.leave(urgent)
    assert (braking.state, step.state) == (ClaimState.HELD, ClaimState.HELD)


def test_nothing_is_preempted_for_a_claim_that_waits_behind_others(table):
    plan = table.claim("map", urgency=1)
    step = table.claim("base", within=(plan,))
    first = table.claim("map", urgency=1)
    second = table.claim("base", "map", urgency=1)
    assert (step.state, first.state, second.state) == (
        ClaimState.HELD,
        ClaimState.WAITING,
        ClaimState.WAITING,
    )
