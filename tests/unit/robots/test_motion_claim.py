"""The motions of a robot: no wake-up is lost, and all that drive or wait can be aborted."""

import asyncio

from jacaros.artifacts.env.values import Structure
from jacaros.robots.artifacts.driving import MotionClaim, Motions, motions_of
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.ros_clock import RosClock
from jacaros.runtime.clock import VirtualClock, run


def test_a_wake_up_before_the_wait_is_not_lost() -> None:
    clock = VirtualClock()

    async def main() -> None:
        claim = MotionClaim(lambda: None)
        claim.wake()
        await claim.wait(clock, None)
        assert clock.elapsed == 0
        await claim.wait(clock, 1.0)
        assert clock.elapsed == 1

    run(main, clock)


async def test_the_first_message_of_clock_does_not_count_as_a_jump() -> None:
    clock = RosClock(lambda text: None)
    stopped: list[bool] = []
    claim = MotionClaim(lambda: stopped.append(True))
    for time, gap in ((1000.0, None), (990.0, Structure("clock_jumped", (-10.0,)))):
        waiting = asyncio.ensure_future(claim.wait(clock, 60.0))
        await asyncio.sleep(0)
        clock.move_to(time)
        claim.wake()
        await waiting
        assert claim.gap == gap
    assert stopped == [True]


def test_abort_stops_and_wakes_all_motions() -> None:
    stopped = []
    motions = Motions()
    tickets = [MotionClaim(lambda number=number: stopped.append(number)) for number in range(3)]  # type: ignore[misc]
    for each in tickets[:2]:
        motions.claims[each] = None
    motions.abort()
    assert stopped == [0, 1]
    assert motions.stops == 1
    assert [each.aborted for each in tickets] == [True, True, False]


def test_the_motions_of_a_robot_of_a_backend_are_kept_together() -> None:
    clock = VirtualClock()

    async def main() -> None:
        one, other = (open_backend("memory", clock, name) for name in ("one", "other"))
        assert motions_of(one, "/r") is motions_of(one, "/r")
        assert motions_of(one, "/r") is not motions_of(one, "")
        assert motions_of(one, "/r") is not motions_of(other, "/r")

    run(main, clock)
