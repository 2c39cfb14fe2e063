"""The clock of a simulator: it follows `/clock`, waits when it is silent, and is not misled when it jumps back."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from jacaros.robots.ros.errors import CallTimedOut, ServerUnavailable, ServiceUnavailable
from jacaros.robots.ros.message import stamp
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.ros_clock import CLOCK_TYPE, RosClock
from jacaros.robots.ros.services import call_when_offered
from jacaros.robots.ros.waiting import WaitLog
from jacaros.runtime.clock import VirtualClock, run


def on_loop(main: Callable[[RosClock, list[str]], Awaitable[None]]) -> list[str]:
    """Run *main* with a clock on the virtual loop, which stands for real time; what the clock said."""
    lines: list[str] = []

    async def go() -> None:
        await main(RosClock(lines.append), lines)

    run(go, VirtualClock())
    return lines


async def settle() -> None:
    for _ in range(3):
        await asyncio.sleep(0)


def test_time_is_zero_until_the_first_message_and_then_that_of_the_newest() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        assert (clock.now(), clock.running) == (0.0, False)
        clock.move_to(100.0)
        assert (clock.now(), clock.elapsed, clock.running) == (100.0, 0.0, True)
        clock.move_to(100.5)
        assert (clock.now(), clock.elapsed) == (100.5, 0.5)

    on_loop(main)


def test_timers_fire_in_order_when_the_clock_advances() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        rung: list[str] = []
        clock.call_later(2.0, lambda: rung.append("late"))
        clock.call_later(1.0, lambda: rung.append("early"))
        clock.call_later(1.0, lambda: rung.append("next"))
        clock.call_later(1.5, lambda: rung.append("cancelled")).cancel()
        clock.call_later(0.0, lambda: rung.append("now"))
        await settle()
        assert rung == ["now"]
        clock.move_to(50.0)
        await asyncio.sleep(60.0)
        assert rung == ["now"], "the first message sets the time, it does not pass any"
        clock.move_to(51.0)
        await settle()
        assert rung == ["now", "early", "next"]
        clock.move_to(60.0)
        await settle()
        assert rung == ["now", "early", "next", "late"]

    on_loop(main)


def test_after_a_jump_back_waits_continue_with_their_remaining_time() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        rung: list[float] = []
        jumps: list[float] = []
        stop = clock.on_jump(jumps.append)
        clock.move_to(1000.0)
        clock.call_later(3.0, lambda: rung.append(clock.now()))
        clock.move_to(1002.0)
        clock.move_to(0.0)
        await settle()
        assert (rung, jumps) == ([], [-1002.0])
        clock.move_to(0.5)
        await settle()
        assert rung == []
        clock.move_to(1.0)
        await settle()
        assert rung == [1.0]
        stop()
        clock.move_to(0.0)
        assert jumps == [-1002.0]

    lines = on_loop(main)
    assert any("jumped back by 1002.000 s" in line for line in lines)


def test_a_leap_ahead_is_reported_and_a_step_is_not() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        jumps: list[float] = []
        clock.on_jump(jumps.append)
        for time in (1000.0, 1004.0, 1064.0, 1064.1):
            clock.move_to(time)
        assert jumps == [60.0]
        assert round(clock.elapsed, 3) == 64.1

    lines = on_loop(main)
    assert "/clock jumped ahead by 60.000 s; waits that end in this interval are over" in lines


def test_a_periodic_timer_rings_once_after_a_jump_and_not_in_a_burst() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        rung: list[float] = []

        def tick() -> None:
            rung.append(clock.now())
            clock.call_later(0.1, tick)

        clock.move_to(10.0)
        tick()
        for time in (10.1, 10.2, 5000.0, 1.0, 1.1, 1.2):
            clock.move_to(time)
            await settle()
        assert rung == [10.0, 10.1, 10.2, 5000.0, 1.1, 1.2]

    on_loop(main)


def test_reordered_messages_are_not_a_jump() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        clock.move_to(10.0)
        clock.move_to(10.02)
        clock.move_to(10.01)
        assert clock.now() == 10.02

    assert not any("jumped" in line for line in on_loop(main))


def test_a_sleeper_that_is_cancelled_leaves_no_timer() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        clock.move_to(1.0)
        sleeper = asyncio.ensure_future(clock.sleep(5.0))
        await settle()
        sleeper.cancel()
        await settle()
        clock.move_to(7.0)
        await settle()
        assert sleeper.cancelled()

    on_loop(main)


def test_it_follows_the_graph_and_logs_silence_and_pauses() -> None:
    lines: list[str] = []
    real = VirtualClock()

    async def main() -> None:
        node = open_backend("memory", real, "agents", log=lines.append)
        await node.start()
        clock = RosClock(lines.append)
        clock.listen(node)
        await real.sleep(10.0)
        assert sum("no publisher on /clock" in line for line in lines) == 1
        publisher = node.publisher("/clock", CLOCK_TYPE)
        await publish(publisher, 7.0)
        assert clock.now() == 7.0
        assert any("continues" in line for line in lines)
        await real.sleep(10.0)
        assert sum("stopped at 7.000 s" in line for line in lines) == 1
        clock.close()
        await publish(publisher, 9.0)
        assert clock.now() == 7.0
        await node.close()

    async def publish(publisher: Any, time: float) -> None:
        message = publisher.message()
        stamp(message.clock, time)
        publisher.publish(message)
        await real.sleep(0.1)

    run(main, real)


async def pass_by(clock: RosClock, *times: float) -> None:
    for time in times:
        clock.move_to(time)
        for _ in range(20):
            await asyncio.sleep(0)


def test_the_time_out_of_a_call_keeps_its_length_when_the_clock_jumps_back() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        clock.move_to(100.0)
        backend = open_backend("memory", clock, "both", log=lines.append)
        await backend.start()
        called: list[Any] = []

        async def mute(request: Any) -> None:
            called.append(request)
            await asyncio.Event().wait()

        client = backend.client("/add", "example_interfaces/srv/AddTwoInts")
        call = asyncio.ensure_future(client.call(timeout=2.0))
        await pass_by(clock, 100.0, 101.5, 5.0)
        backend.service("/add", "example_interfaces/srv/AddTwoInts", mute)
        await pass_by(clock, 5.4)
        assert called
        assert not call.done()
        await pass_by(clock, 5.6)
        assert isinstance(call.exception(), CallTimedOut)
        await backend.close()

    on_loop(main)


def test_the_time_out_of_a_goal_keeps_its_length_when_the_clock_jumps_back() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        clock.move_to(100.0)
        backend = open_backend("memory", clock, "both", log=lines.append)
        await backend.start()
        client = backend.action_client("/count", "jacaros_interfaces/action/Count")
        sending = asyncio.ensure_future(client.send(timeout=2.0))
        await pass_by(clock, 100.0, 101.5, 5.0, 5.4)
        client.server_present(True)  # a false alarm: it waits for what is left
        await pass_by(clock, 5.45)
        assert not sending.done()
        await pass_by(clock, 5.6)
        assert isinstance(sending.exception(), ServerUnavailable)
        await backend.close()

    on_loop(main)


def test_attempts_to_call_end_in_time_when_the_clock_jumps_back() -> None:
    async def main(clock: RosClock, lines: list[str]) -> None:
        rests: list[float | None] = []

        async def nobody(rest: float | None) -> None:
            rests.append(rest)
            raise ServiceUnavailable("no node is there")

        clock.move_to(100.0)
        call = asyncio.ensure_future(
            call_when_offered(WaitLog(clock, lines.append, "service /x"), nobody, 1.0)
        )
        await pass_by(clock, 100.0, 100.5, 5.0, 5.2)
        assert not call.done()
        await pass_by(clock, 5.6)
        assert isinstance(call.exception(), ServiceUnavailable)
        assert [round(rest or 0.0, 3) for rest in rests] == [1.0, 0.5, 0.3, -0.1]

    on_loop(main)
