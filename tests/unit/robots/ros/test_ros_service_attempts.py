"""Calls of services whose arrival cannot be awaited: how they end where the last attempt had no time left."""

import pytest

from jacaros.robots.ros.errors import CallTimedOut, ServiceUnavailable
from jacaros.robots.ros.services import call_when_offered
from jacaros.robots.ros.waiting import WaitLog
from jacaros.runtime.clock import VirtualClock, run


def end_of_call(takes: float, offered: bool) -> str:
    """Call a service for a second; each attempt takes some time to find no server."""
    clock = VirtualClock()
    attempts: list[float] = []

    async def attempt(rest: float | None) -> None:
        assert rest is not None
        attempts.append(rest)
        await clock.sleep(min(rest, takes))
        if rest < takes:
            raise TimeoutError
        raise ServiceUnavailable("no node is there")

    async def main() -> str:
        with pytest.raises((ServiceUnavailable, CallTimedOut)) as caught:
            await call_when_offered(WaitLog(clock, print, "service /x"), attempt, 1.0, lambda: offered)
        assert clock.elapsed == pytest.approx(1.0, abs=0.11)
        return str(caught.value)

    return run(main, clock)


def test_who_was_missing_to_the_last_is_missing_though_the_last_attempt_had_no_time() -> None:
    for takes in (0.03, 0.04, 0.13, 0.2, 0.29):
        assert end_of_call(takes, offered=False) == "no node offered service /x within 1 s"


def test_who_came_meanwhile_and_did_not_answer_timed_out() -> None:
    assert end_of_call(0.29, offered=True) == "service /x did not answer within 1 s"


def test_one_attempt_without_an_answer_timed_out() -> None:
    assert end_of_call(7.0, offered=False) == "service /x did not answer within 1 s"


def test_the_1st_10th_and_100th_unsuccessful_wait_is_logged() -> None:
    clock = VirtualClock()
    said: list[str] = []
    there = False
    waiting = WaitLog(clock, said.append, "service /x")

    async def attempt(_: float | None) -> str:
        if not there:
            raise ServiceUnavailable("no node is there")
        return "answer"

    async def call(seconds: float) -> None:
        await call_when_offered(waiting, attempt, seconds)

    async def in_vain(times: int) -> None:
        for _ in range(times):
            with pytest.raises(ServiceUnavailable):
                await call(1.0)

    async def main() -> None:
        nonlocal there
        await in_vain(9)
        assert said == ["waiting for the service /x"]
        await in_vain(90)
        assert said == ["waiting for the service /x"] * 2
        await in_vain(1)
        assert said == ["waiting for the service /x"] * 3
        there = True
        await call(1.0)
        assert said[3:] == ["found the service /x"]
        await call(1.0)
        there = False
        await in_vain(1)
        assert said[4:] == ["waiting for the service /x"]

    run(main, clock)
