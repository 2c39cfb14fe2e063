"""The budget of each page, on a clock of the test."""

import asyncio

import pytest

from jacaros.look.page.live import timing as allowance
from jacaros.look.page.live.timing import AHEAD, SHARE, Allowances, metered


class Time:
    now = 100.0


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> Time:
    """Real time of the test."""
    real = Time()
    monkeypatch.setattr(allowance, "real_time", lambda: real.now)
    return real


@pytest.mark.parametrize("count", [1, 8])
def test_pages_together_get_the_share_of_one_in_the_long_run(time: Time, count: int) -> None:
    pages, used, begun = Allowances(), 0.0, time.now
    each = [pages.begin() for _ in range(count)]
    while time.now < begun + 1000.0:
        time.now += 0.01
        for page in each:
            if not page.is_used_up:
                time.now += 0.1
                used += 0.1
                page.spend(0.1)
    assert used <= 1000.0 * SHARE * 1.1
    assert count > 1 or used == pytest.approx(1000.0 * SHARE, rel=0.05)


def test_a_page_that_has_used_up_its_budget_does_not_delay_others(time: Time) -> None:
    pages = Allowances()
    flood, other = pages.begin(), pages.begin()
    flood.spend(5.0)
    assert flood.is_used_up
    assert not other.is_used_up
    other.spend(0.001)
    assert not other.is_used_up


def test_several_short_commands_at_once_do_not_wait(time: Time) -> None:
    page = Allowances().begin()
    for _ in range(20):
        assert not page.is_used_up
        page.spend(0.002)
    time.now += AHEAD
    assert not page.is_used_up


def test_connecting_again_gives_no_new_budget(time: Time) -> None:
    pages = Allowances()
    page = pages.begin()
    page.spend(5.0)
    pages.end(page)
    assert pages.begin().is_used_up
    time.now += 5.0 / SHARE
    assert not pages.begin().is_used_up


async def test_the_turns_of_a_coroutine_are_metered_without_its_waiting(time: Time) -> None:
    waiting, turns = asyncio.get_running_loop().create_future(), list[float]()

    async def work() -> str:
        time.now += 1.0
        await asyncio.sleep(0)
        time.now += 2.0
        with pytest.raises(ValueError, match="late"):
            await waiting
        time.now += 4.0
        return "done"

    task = asyncio.create_task(metered(work(), turns.append))
    await asyncio.sleep(0.001)
    time.now += 100.0
    waiting.set_exception(ValueError("late"))
    assert await task == "done"
    assert turns == [1.0, 2.0, 4.0]


async def test_a_metered_coroutine_can_be_cancelled() -> None:
    ended: list[str] = []

    async def work() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("cleaned up")

    task = asyncio.create_task(metered(work(), lambda _: None))
    await asyncio.sleep(0)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert ended == ["cleaned up"]
