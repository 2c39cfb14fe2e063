"""The clocks: jumps, order, busy agents, worker threads, errors in timers."""

import asyncio
import threading
import time

import pytest

from jacaros.runtime.clock import VIRTUAL_EPOCH, VirtualClock, WallClock, new_event_loop, run
from played import played


def on_virtual_time(scene):
    clock = VirtualClock()
    run(lambda: scene(clock), clock)


@played(on_virtual_time)
async def test_virtual_time_begins_at_its_epoch_and_jumps_over_a_sleep(clock):
    began = time.perf_counter()
    assert clock.now() == VIRTUAL_EPOCH
    await clock.sleep(86_400.0)
    assert clock.now() == VIRTUAL_EPOCH + 86_400.0
    assert time.perf_counter() - began < 10.0


@played(on_virtual_time)
async def test_timers_ring_in_the_order_of_their_moments_and_equal_moments_in_the_order_of_setting(clock):
    rung = []
    clock.call_later(2.0, lambda: rung.append(("c", clock.elapsed)))
    clock.call_later(1.0, lambda: rung.append(("a", clock.elapsed)))
    clock.call_later(1.0, lambda: rung.append(("b", clock.elapsed)))
    await clock.sleep(3.0)
    assert rung == [("a", 1.0), ("b", 1.0), ("c", 2.0)]


@played(on_virtual_time)
async def test_a_cancelled_timer_does_not_ring_even_if_cancelled_at_its_own_moment(clock):
    rung, timers = [], []
    early = clock.call_later(0.5, lambda: rung.append("early"))
    clock.call_later(1.0, lambda: [timer.cancel() for timer in timers])
    last = clock.call_later(1.0, lambda: rung.append("last"))
    early.cancel()
    timers.append(last)
    await clock.sleep(2.0)
    assert rung == []


@played(on_virtual_time)
async def test_time_stands_still_while_another_thread_works(clock):
    seen = []

    async def worker():
        for _ in range(100):
            await asyncio.sleep(0)
            seen.append(clock.elapsed)

    clock.call_later(1.0, lambda: seen.append("timer"))
    await asyncio.create_task(worker())
    await clock.sleep(1.5)
    assert seen == [0.0] * 100 + ["timer"]


@played(on_virtual_time)
async def test_time_stands_still_while_a_worker_thread_runs(clock):
    gate = threading.Event()
    order = []
    clock.call_later(1.0, lambda: order.append("timer"))
    work = asyncio.get_running_loop().run_in_executor(None, gate.wait)
    threading.Timer(0.05, gate.set).start()
    await work
    order.append(("thread", clock.elapsed))
    await clock.sleep(2.0)
    assert order == [("thread", 0.0), "timer"]


@pytest.mark.parametrize("clock", [VirtualClock, WallClock])
def test_a_thread_that_does_not_return_does_not_delay_the_end(clock):
    gate = threading.Event()

    async def main():
        asyncio.get_running_loop().run_in_executor(None, gate.wait)
        return 3

    assert run(main, clock()) == 3
    assert not gate.is_set()
    gate.set()


def test_threads_give_their_results_and_errors():
    async def main():
        results = await asyncio.gather(*(asyncio.to_thread(abs, -number) for number in range(100)))
        assert results == list(range(100))
        with pytest.raises(ZeroDivisionError):
            await asyncio.to_thread(divmod, 1, 0)
        with pytest.raises(RuntimeError, match="StopIteration"):
            await asyncio.to_thread(next, iter(()))

    run(main, WallClock())


@played(on_virtual_time)
async def test_busy_agents_move_time_by_a_millisecond_per_ten_thousand_cycles(clock):
    rung = []
    clock.call_later(0.0015, lambda: rung.append(round(clock.elapsed, 6)))
    clock.busy(9_999)
    assert clock.elapsed == 0.0
    clock.busy(1)
    assert clock.elapsed == pytest.approx(0.001)
    clock.busy(10_000)
    assert rung == [], "never in the middle of the caller's work"
    await asyncio.sleep(0)
    assert rung == [0.002]


@played(on_virtual_time)
async def test_idling_forgets_the_busy_cycles_before(clock):
    clock.busy(9_999)
    await clock.sleep(1.0)
    clock.busy(1)
    assert clock.elapsed == 1.0


@played(on_virtual_time)
async def test_an_error_in_a_timer_reaches_the_handler_of_the_loop_and_time_continues(clock):
    errors = []
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(lambda _, context: errors.append(context["exception"]))
    clock.call_later(1.0, lambda: 1 / 0)
    await clock.sleep(2.0)
    assert clock.elapsed == 2.0
    assert [type(error) for error in errors] == [ZeroDivisionError]


def test_without_a_loop_the_clock_can_be_advanced_by_hand():
    clock = VirtualClock(start=100.0)
    rung = []
    clock.call_later(5.0, lambda: rung.append(clock.now()))
    clock.call_later(7.0, lambda: rung.append("never")).cancel()
    assert clock.advance()
    assert rung == [105.0]
    assert not clock.advance()
    assert clock.now() == 105.0


@played(on_virtual_time)
async def test_a_cancelled_sleeper_leaves_no_timer_that_time_would_jump_to(clock):
    sleeper = asyncio.create_task(clock.sleep(1000.0))
    await clock.sleep(1.0)
    sleeper.cancel()
    await clock.sleep(1.0)
    assert clock.elapsed == 2.0
    assert not clock.advance()


@played(on_virtual_time)
async def test_a_sleeper_cancelled_at_the_moment_of_its_waking_is_cancelled(clock):
    sleeper = asyncio.create_task(clock.sleep(1.0))
    clock.call_later(1.0, sleeper.cancel)  # rings first: the task has not begun to sleep yet
    await clock.sleep(2.0)
    assert sleeper.cancelled()


def test_timers_cancelled_in_the_past_of_a_busy_jump_are_skipped():
    clock = VirtualClock()
    rung = []
    clock.call_later(0.0001, lambda: rung.append("kept"))
    clock.call_later(0.0002, lambda: rung.append("dropped")).cancel()
    clock.busy(10_000)
    assert rung == ["kept"]
    assert clock.elapsed == 0.001


@played(on_virtual_time)
async def test_real_input_is_served_before_time_jumps(clock):
    order = []
    loop = asyncio.get_running_loop()
    clock.call_later(1.0, lambda: order.append("timer"))
    loop.call_soon_threadsafe(order.append, "input")
    await clock.sleep(1.0)
    assert order == ["input", "timer"]


def test_the_wall_clock_measures_delays_on_the_running_loop():
    clock = WallClock()
    rung = []

    async def main():
        before = clock.now()
        clock.call_later(0.0, lambda: rung.append("now"))
        clock.call_later(0.0, lambda: rung.append("never")).cancel()
        await clock.sleep(0.001)
        await clock.sleep(-1.0)
        clock.busy(1_000_000)
        return clock.now() - before

    assert run(main, clock) >= 0.0
    assert rung == ["now"]
    assert not clock.virtual
    assert VirtualClock().virtual


def test_the_wall_clock_gets_an_ordinary_loop():
    loop = new_event_loop(WallClock())
    loop.close()
    assert not hasattr(loop, "virtual_selector")


@played(on_virtual_time)
async def test_asyncio_itself_waits_on_the_virtual_clock(clock):
    seen, began = [], time.monotonic()

    async def tick():
        for _ in range(3):
            await clock.sleep(10)
            seen.append(("clock", clock.elapsed))

    ticking = asyncio.create_task(tick())
    await asyncio.sleep(15)
    seen.append(("asyncio", clock.elapsed))
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(3600):
            await asyncio.Event().wait()
    await ticking
    seen.append(("end", clock.elapsed))
    assert seen == [("clock", 10), ("asyncio", 15), ("clock", 20), ("clock", 30), ("end", 3615)]
    assert time.monotonic() - began < 60
