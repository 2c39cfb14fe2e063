"""The motions: one motion at a time, in the order of the requests, and no wake-up is lost."""

from jacaros.artifacts.robots.motion_queue import Claim, MotionQueue, motion_queue_of
from jacaros.clock import VirtualClock, run
from jacaros.ros.open import open_backend


def claim() -> Claim:
    return Claim(lambda: None)


def test_the_lane_goes_from_one_to_the_next_in_the_order_of_asking() -> None:
    motions = MotionQueue()
    a, b, c = claim(), claim(), claim()
    assert motions.enter(a)
    assert motions.enter(a)
    assert not motions.enter(b)
    assert not motions.enter(c)
    motions.leave(b)
    motions.leave(a)
    assert motions.holder is c
    motions.leave(a)
    assert motions.holder is c
    motions.leave(c)
    assert motions.enter(b)


def test_a_wake_up_before_the_wait_is_not_lost() -> None:
    clock = VirtualClock()

    async def main() -> None:
        motions = MotionQueue()
        first, second = claim(), claim()
        motions.enter(first)
        assert not motions.enter(second)
        motions.leave(first)
        await second.wait(clock, None)
        assert motions.holder is second
        await second.wait(clock, 1.0)
        assert clock.elapsed == 1

    run(main, clock)


def test_abort_stops_and_wakes_whoever_drives_or_waits() -> None:
    stopped = []
    motions = MotionQueue()
    tickets = [Claim(lambda number=number: stopped.append(number)) for number in range(3)]  # type: ignore[misc]
    for each in tickets[:2]:
        motions.enter(each)
    motions.abort()
    assert stopped == [0, 1]
    assert [each.aborted for each in tickets] == [True, True, False]


def test_a_robot_of_a_backend_has_one_lane() -> None:
    clock = VirtualClock()

    async def main() -> None:
        one, other = (open_backend("memory", clock, name) for name in ("one", "other"))
        assert motion_queue_of(one, "/r") is motion_queue_of(one, "/r")
        assert motion_queue_of(one, "/r") is not motion_queue_of(one, "")
        assert motion_queue_of(one, "/r") is not motion_queue_of(other, "/r")

    run(main, clock)
