"""Clocks that are paused, and real time that is faster or slower than the time of day."""

import asyncio
import time
from collections.abc import Callable

import pytest
from fake_real_time import FakeTimeLoop, play_in_fake_time

from jacaros.robots.ros.ros_clock import RosClock
from jacaros.runtime.clock import Clock, VirtualClock, WallClock, of_run, run
from jacaros.runtime.timers import COMPACT_ABOVE, TimerQueue
from played import played


def rings(clock: Clock, delays: dict[str, float]) -> list[tuple[str, float]]:
    """Set timers; the names of those that ring, with the time that has passed on the clock."""
    rung: list[tuple[str, float]] = []
    began = clock.elapsed

    def ring(name: str) -> Callable[[], None]:
        return lambda: rung.append((name, round(clock.elapsed - began, 6)))

    for name, delay in delays.items():
        clock.call_later(delay, ring(name))
    return rung


@played(play_in_fake_time)
async def test_a_wall_clock_is_the_time_of_day_until_it_is_paused(loop: FakeTimeLoop) -> None:
    clock = WallClock()
    await asyncio.sleep(3.7)
    assert clock.now() == time.time()
    assert clock.elapsed == time.monotonic()
    clock.pause()
    paused = clock.now()
    assert paused == time.time()
    await asyncio.sleep(10.0)
    assert clock.now() == paused
    assert clock.paused
    clock.resume()
    assert clock.now() == paused
    await asyncio.sleep(1.0)
    assert clock.now() - paused == pytest.approx(1.0)
    assert not clock.paused


@played(play_in_fake_time)
async def test_timers_can_be_paused_while_the_time_of_day_continues(loop: FakeTimeLoop) -> None:
    clock = WallClock()
    rung = rings(clock, {"a": 2.0})
    clock.pause_timers()
    await asyncio.sleep(5.0)
    assert (clock.now(), rung) == (time.time(), [])
    clock.resume()
    await asyncio.sleep(2.5)
    assert (clock.now(), rung) == (time.time(), [("a", 2.0)])


@played(play_in_fake_time)
async def test_no_timer_of_a_paused_wall_clock_rings_and_all_ring_after_the_rest_of_their_time(
    loop: FakeTimeLoop,
) -> None:
    clock = WallClock()
    rung = rings(clock, {"c": 3.0, "a": 1.0, "b": 2.0, "b too": 2.0})
    await asyncio.sleep(1.5)
    clock.pause()
    clock.pause()
    clock.call_later(0.0, lambda: rung.append(("at once", 0.0)))
    await asyncio.sleep(100.0)
    assert rung == [("a", 1.0)]
    clock.resume()
    await asyncio.sleep(0.0)
    await asyncio.sleep(0.0)
    assert rung[1:] == [("at once", 0.0)]
    await asyncio.sleep(1.6)
    assert rung[2:] == [("b", 2.0), ("b too", 2.0), ("c", 3.0)]


@played(play_in_fake_time)
async def test_the_speed_changes_while_timers_are_pending(loop: FakeTimeLoop) -> None:
    clock = WallClock()
    rung = rings(clock, {"a": 4.0, "b": 10.0, "c": 11.0})
    began = loop.time()
    await asyncio.sleep(2.0)
    clock.speed = 4.0
    await asyncio.sleep(0.51)
    assert rung == [("a", 4.0)]
    clock.pause()
    clock.speed = 2.0
    await asyncio.sleep(5.0)
    clock.resume()
    await clock.sleep(6.0)
    assert rung[1:] == [("b", 10.0)]
    assert loop.time() - began == pytest.approx(2.0 + 0.51 + 5.0 + 3.0)
    clock.speed = 0.5
    await clock.sleep(1.0)
    assert [name for name, _ in rung] == ["a", "b", "c"]


@pytest.mark.parametrize("speed", [0.0, -1.0, float("inf"), float("nan")])
def test_a_speed_that_is_not_greater_than_0_is_refused(speed: float) -> None:
    with pytest.raises(ValueError, match="greater than 0"):
        WallClock(speed)


@played(play_in_fake_time)
async def test_a_clock_with_a_speed_begins_at_the_time_of_day(loop: FakeTimeLoop) -> None:
    fast, slow = WallClock(4.0), WallClock(0.5)
    began = time.time()
    assert fast.now() == slow.now() == began
    await asyncio.sleep(3.0)
    assert (fast.now() - began, slow.now() - began) == pytest.approx((12.0, 1.5))


@played(play_in_fake_time)
async def test_a_timer_may_pause_the_clock_and_the_next_one_of_its_moment_waits(loop: FakeTimeLoop) -> None:
    clock, rung = WallClock(), list[str]()
    clock.call_later(1.0, clock.pause)
    clock.call_later(1.0, lambda: rung.append("second"))
    await asyncio.sleep(5.0)
    assert rung == []
    clock.resume()
    await asyncio.sleep(0.0)
    await asyncio.sleep(0.0)
    assert rung == ["second"]


@played(play_in_fake_time)
async def test_an_error_in_a_timer_reaches_the_loop_and_the_next_one_rings(loop: FakeTimeLoop) -> None:
    clock, rung, errors = WallClock(), list[str](), list[object]()
    loop.set_exception_handler(lambda _, context: errors.append(context["exception"]))
    clock.call_later(1.0, lambda: 1 / 0)  # type: ignore[arg-type, return-value]
    clock.call_later(1.0, lambda: rung.append("second"))
    await asyncio.sleep(1.5)
    assert rung == ["second"]
    assert [type(each) for each in errors] == [ZeroDivisionError]


def test_a_virtual_clock_does_not_jump_while_it_is_paused_and_its_loop_serves_others() -> None:
    clock = VirtualClock()
    served = []

    async def of_the_run(rung: list[str]) -> None:
        await asyncio.sleep(0)
        rung.append("task of the run")

    async def main() -> None:
        rung: list[str] = []
        with of_run():
            clock.call_later(1.0, lambda: rung.append("timer"))
            task = asyncio.create_task(of_the_run(rung))
        await asyncio.sleep(0)
        clock.pause()
        for _ in range(100):
            await asyncio.sleep(0)
            served.append(clock.elapsed)
        await asyncio.to_thread(time.sleep, 0.001)
        assert rung == []
        clock.resume()
        await clock.sleep(2.0)
        await task
        assert rung == ["task of the run", "timer"]

    run(main, clock)
    assert served == [0.0] * 100


def test_ros_time_that_passes_in_a_pause_does_not_count() -> None:
    async def main() -> None:
        clock, rung = RosClock(lambda line: None), list[str]()
        clock.move_to(10.0)
        clock.call_later(2.0, lambda: rung.append("two"))
        clock.move_to(11.0)
        clock.pause()
        clock.move_to(15.0)
        clock.call_later(0.0, lambda: rung.append("at once"))
        for _ in range(3):
            await asyncio.sleep(0)
        assert rung == []
        assert clock.now() == 15.0
        clock.resume()
        clock.move_to(15.5)
        for _ in range(3):
            await asyncio.sleep(0)
        assert rung == ["at once"]
        clock.move_to(16.5)
        await asyncio.sleep(0)
        assert rung == ["at once", "two"]

    asyncio.run(main())


def test_cancelled_timers_do_not_pile_up() -> None:
    queue = TimerQueue()
    kept = [queue.add(1e6 + number, lambda: None) for number in range(10)]
    for number in range(10_000):
        queue.add(1e6 + number, lambda: None).cancel()
        assert len(queue) <= 2 * COMPACT_ABOVE
    assert sorted(queue.pending(), key=lambda timer: timer.when) == kept
