"""Handing over between threads and the loop."""

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from jacaros.robots.ros.handoff import Handoff, LoopEnded, ask, in_thread, post


def in_other_thread(work: object) -> None:
    thread = threading.Thread(target=work)  # type: ignore[arg-type]
    thread.start()
    thread.join()


def collecting(size: int) -> tuple[Handoff[int], list[int]]:
    """A handoff to this loop, and what it has delivered."""
    got: list[int] = []
    return Handoff[int](asyncio.get_running_loop(), size, got.append), got


async def turns_until(condition: Callable[[], bool]) -> None:
    """Let the loop turn until *condition* holds."""
    while not condition():  # noqa: ASYNC110 - what is tested is what happens in turns of the loop
        await asyncio.sleep(0)


async def test_items_arrive_on_the_loop_in_order() -> None:
    got: list[tuple[int, str]] = []
    handoff = Handoff[int](
        asyncio.get_running_loop(), 10, lambda n: got.append((n, threading.current_thread().name))
    )
    in_other_thread(lambda: [handoff.put(n) for n in range(5)])
    await turns_until(lambda: len(got) == 5)
    assert got == [(n, "MainThread") for n in range(5)]


async def test_a_burst_leaves_the_newest_items() -> None:
    handoff, got = collecting(3)
    in_other_thread(lambda: [handoff.put(n) for n in range(100_000)])
    await turns_until(lambda: len(got) == 3)
    assert got == [99_997, 99_998, 99_999]


async def test_others_get_their_turn_between_two_items() -> None:
    loop = asyncio.get_running_loop()
    got: list[object] = []
    handoff = Handoff[int](loop, 10, got.append)
    in_other_thread(lambda: [handoff.put(n) for n in range(3)])
    await asyncio.sleep(0)
    loop.call_soon(got.append, "other")
    for _ in range(5):
        await asyncio.sleep(0)
    assert got.index("other") < len(got) - 1
    assert [item for item in got if item != "other"] == [0, 1, 2]


async def test_nothing_is_lost_between_many_threads_and_the_loop() -> None:
    handoff, got = collecting(100_000)
    threads = [
        threading.Thread(target=lambda k=k: [handoff.put(k * 1000 + n) for n in range(1000)])
        for k in range(8)
    ]
    for thread in threads:
        thread.start()
    await turns_until(lambda: len(got) == 8000)
    for thread in threads:
        thread.join()
    assert sorted(got) == list(range(8000))
    for k in range(8):
        mine = [n for n in got if n // 1000 == k]
        assert mine == sorted(mine)


async def test_a_failing_receiver_keeps_no_item_back() -> None:
    loop = asyncio.get_running_loop()
    problems: list[object] = []
    loop.set_exception_handler(lambda _, context: problems.append(context["exception"]))
    got: list[int] = []

    def receive(item: int) -> None:
        if item == 1:
            raise ValueError(item)
        got.append(item)

    handoff = Handoff[int](loop, 10, receive)
    in_other_thread(lambda: [handoff.put(n) for n in range(3)])
    await turns_until(lambda: len(got) == 2)
    assert got == [0, 2]
    assert len(problems) == 1


async def test_a_closed_handoff_forgets_what_waits_and_delivers_nothing_that_comes_later() -> None:
    handoff, got = collecting(10)
    in_other_thread(lambda: handoff.put(1))
    handoff.close()
    in_other_thread(lambda: handoff.put(2))
    handoff.put_here(3)
    for _ in range(5):
        await asyncio.sleep(0)
    assert got == []


def test_an_ended_loop_is_not_an_error() -> None:
    loop = asyncio.new_event_loop()
    loop.close()
    Handoff[int](loop, 1, print).put(1)
    assert post(loop, print) is False
    with pytest.raises(LoopEnded):
        ask(loop, lambda tell: tell(1, None), lambda: False)


async def test_blocking_work_is_done_in_a_thread() -> None:
    loop = asyncio.get_running_loop()
    assert await in_thread(loop, lambda: threading.current_thread().name, "worker") == "worker"

    def fail() -> None:
        raise OSError("no")

    with pytest.raises(OSError, match="no"):
        await in_thread(loop, fail, "worker")


async def test_a_thread_asks_the_loop_and_waits() -> None:
    loop = asyncio.get_running_loop()

    async def asked(question: Any, ended: bool = False) -> object:
        return await in_thread(loop, lambda: ask(loop, question, lambda: ended), "asker")

    assert await asked(lambda tell: loop.call_later(0.01, tell, 42, None)) == 42
    with pytest.raises(ValueError, match="not today"):
        await asked(lambda tell: tell(None, ValueError("not today")))
    with pytest.raises(LoopEnded):
        await asked(lambda tell: None, ended=True)
    with pytest.raises(TimeoutError, match="too late"):  # an answer, not the sign that it has to wait
        await asked(lambda tell: tell(None, TimeoutError("too late")))


async def test_items_on_the_loop_are_delivered_immediately_but_one_per_turn() -> None:
    handoff, got = collecting(2)
    handoff.put_here(0)
    assert got == [0]
    for number in range(1, 5):
        handoff.put_here(number)
    assert got == [0]
    await turns_until(lambda: len(got) == 3)
    assert got == [0, 3, 4]
    await asyncio.sleep(0)
    handoff.put_here(5)
    assert got[-1] == 5
    handoff.close()
    handoff.put_here(6)
    assert got[-1] == 5


async def test_of_what_comes_together_the_newest_are_delivered() -> None:
    handoff, got = collecting(2)
    handoff.put_here(*range(10))
    assert got == [8]
    handoff.put_here(10, 11)
    await turns_until(lambda: len(got) == 3)
    assert got == [8, 10, 11]


async def test_what_comes_on_the_loop_does_not_overtake_what_came_from_a_thread() -> None:
    handoff, got = collecting(10)
    in_other_thread(lambda: handoff.put(0))
    handoff.put_here(1)
    await turns_until(lambda: len(got) == 2)
    assert got == [0, 1]
