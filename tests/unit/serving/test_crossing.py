"""The way between the loop of a run and the loop of a door in another thread."""

import asyncio
import threading
import time
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

import pytest

from jacaros.runtime.clock import Clock, VirtualClock, WallClock, run
from jacaros.serving import crossing
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Crossing, DoorThread, Lagging, Outbox

T = TypeVar("T")
CLOCKS: list[Callable[[], Clock]] = [WallClock, VirtualClock]


def through_a_door(main: Callable[[Crossing], Coroutine[Any, Any, T]], clock: Clock | None = None) -> T:
    """Run *main* as a door beside a run. Return its result."""
    found: list[T] = []
    wrong: list[Exception] = []

    async def of_run() -> None:
        ended = asyncio.Event()
        loop = asyncio.get_running_loop()

        async def door(crossing: Crossing) -> None:
            try:
                found.append(await main(crossing))
            finally:
                loop.call_soon_threadsafe(ended.set)

        thread = DoorThread("test door", door, wrong.append)
        await ended.wait()
        await thread.close()

    run(of_run, clock or WallClock())
    if wrong:
        raise wrong[0]
    return found[0]


@pytest.mark.parametrize("clock", CLOCKS)
def test_a_function_is_called_in_the_thread_of_the_run(clock: Callable[[], Clock]) -> None:
    async def main(way: Crossing) -> list[object]:
        here = threading.current_thread().name
        return [here, await way.call(threading.current_thread), await way.call(max, 3, 4)]

    assert through_a_door(main, clock()) == ["test door", threading.main_thread(), 4]


def test_exceptions_cross_too() -> None:
    async def main(way: Crossing) -> list[str]:
        def refuse(error: Exception) -> None:
            raise error

        async def fail() -> None:
            raise KeyError("k")

        told = []
        for request in (
            way.call(refuse, RequestError("not_offered", "no")),
            way.call(refuse, TimeoutError("of the function")),
            way.wait(fail),
        ):
            try:
                await request
            except Exception as error:
                told.append(repr(error))
        return told

    assert through_a_door(main) == ["RequestError('no')", "TimeoutError('of the function')", "KeyError('k')"]


def test_a_request_that_raises_does_not_stop_the_next_ones() -> None:
    async def main(way: Crossing) -> int:
        def fail() -> None:
            raise asyncio.CancelledError

        def no_coroutine() -> Coroutine[Any, Any, None]:
            raise KeyError("k")

        way.post(fail)
        with pytest.raises(KeyError):
            await way.wait(no_coroutine)
        return await way.call(int)

    assert through_a_door(main) == 0


def test_the_door_waits_while_the_run_on_a_virtual_clock_jumps() -> None:
    async def main(way: Crossing) -> float:
        begun = time.monotonic()
        await way.wait(asyncio.sleep, 3600)
        return time.monotonic() - begun

    assert through_a_door(main, VirtualClock()) < 60


def test_a_wait_that_is_cancelled_ends_in_the_run_too() -> None:
    async def main(way: Crossing) -> str:
        begun, ended = threading.Event(), asyncio.Event()
        loop = asyncio.get_running_loop()

        async def endless() -> None:
            begun.set()
            try:
                await asyncio.get_running_loop().create_future()
            finally:
                loop.call_soon_threadsafe(ended.set)

        task = asyncio.create_task(way.wait(endless))
        while not begun.is_set():
            await way.call(int)
        task.cancel()
        await ended.wait()
        return "ended"

    assert through_a_door(main) == "ended"


def test_a_run_that_does_not_respond_never_sees_the_request(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crossing, "PATIENCE", 0.05)
    called: list[str] = []

    async def main(way: Crossing) -> str:
        free, began = threading.Event(), threading.Event()

        def block() -> None:
            began.set()
            free.wait()

        blocking = asyncio.create_task(way.call(block))
        await asyncio.to_thread(began.wait)
        with pytest.raises(RequestError) as told:
            await way.call(called.append, "request")
        free.set()
        await asyncio.gather(blocking, return_exceptions=True)
        await way.call(int)
        return told.value.code

    assert through_a_door(main) == "unresponsive"
    assert called == []


def test_a_run_that_has_ended_says_so() -> None:
    loop = asyncio.new_event_loop()
    loop.close()
    with pytest.raises(RequestError) as told:
        asyncio.run(Crossing(loop).call(int))
    assert told.value.code == "ended"


def test_many_requests_leave_the_run_its_turns() -> None:
    async def main(way: Crossing) -> int:
        turns = 0

        def turn() -> None:
            nonlocal turns
            turns += 1
            asyncio.get_running_loop().call_soon(turn)

        await way.call(turn)
        before = await way.call(lambda: turns)
        await asyncio.gather(*(way.call(time.sleep, crossing.SLICE) for _ in range(50)))
        return turns - before

    assert through_a_door(main) >= 25


def test_an_outbox_keeps_the_newest_of_each_subject_and_the_order() -> None:
    async def main() -> list[str]:
        box = Outbox[str](asyncio.get_running_loop())

        def fill() -> None:
            box.put("battery 80", "battery")
            box.put("goal 1")
            box.put("battery 70", "battery")
            box.put("goal 2")

        filling = threading.Thread(target=fill)
        filling.start()
        filling.join()
        return await box.take()

    assert asyncio.run(main()) == ["goal 1", "battery 70", "goal 2"]


def test_a_reader_that_lags_is_noticed_and_costs_no_memory() -> None:
    async def main() -> None:
        box = Outbox[int](asyncio.get_running_loop(), most=10)
        for number in range(1000):
            box.put(number)
        with pytest.raises(Lagging):
            await box.take()

    asyncio.run(main())


def test_a_door_that_fails_reports_its_error() -> None:
    async def main(_: Crossing) -> None:
        raise OSError("no socket")

    with pytest.raises(OSError, match="no socket"):
        through_a_door(main)
