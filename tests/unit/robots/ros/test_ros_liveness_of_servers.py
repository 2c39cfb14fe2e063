"""Calls of servers that go: a short absence is ignored, a long one ends the call; and how often waiting is logged."""

import asyncio

import pytest

from jacaros.robots.ros.action import SERVER_LOST_AFTER
from jacaros.robots.ros.errors import ServerGone
from jacaros.robots.ros.services import LOOK, ServerWatch
from jacaros.runtime.clock import VirtualClock, run


def ended(present: list[bool], seconds: float) -> float | None:
    """Watch a call whose server is seen as listed, second by second and again. Return when it failed."""
    clock = VirtualClock()

    async def main() -> float | None:
        answer: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        when: list[float] = []
        answer.add_done_callback(lambda _: when.append(clock.elapsed))
        with ServerWatch(clock, "/s", answer, lambda: present[int(clock.elapsed) % len(present)]):
            await clock.sleep(seconds)
        if answer.done():
            assert isinstance(answer.exception(), ServerGone)
        return when[0] if when else None

    return run(main, clock)


def test_a_server_that_is_briefly_out_of_sight_again_and_again_is_not_lost() -> None:
    assert ended([True, True, True, False], 60.0) is None


def test_a_server_that_stays_away_is_lost() -> None:
    assert ended([True] + 59 * [False], 30.0) == pytest.approx(SERVER_LOST_AFTER + LOOK)


def test_a_server_that_was_never_seen_is_not_lost() -> None:
    assert ended([False], 30.0) is None
