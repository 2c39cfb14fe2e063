"""The budget of each page, on a clock of the test."""

import asyncio

import pytest

from jacaros.look.page.live import timing as allowance
from jacaros.look.page.live.timing import AHEAD, SHARE, Allowances, metered


class Time:
    """Real time of the test."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> Time:
    real = Time()
    monkeypatch.setattr(allowance, "real_time", real)
    return real


def test_a_page_gets_its_share_of_the_time_in_the_long_run(time: Time) -> None:
    page, used, begun = Allowances().begin(), 0.0, time.now
    while time.now < begun + 1000.0:
        if page.is_used_up:
            time.now += 0.01
        else:
            time.now += 0.1
            used += 0.1
            page.spend(0.1)
    assert used == pytest.approx(1000.0 * SHARE, rel=0.05)


def test_pages_together_get_the_share_of_one(time: Time) -> None:
    pages, used, begun = Allowances(), 0.0, time.now
    each = [pages.begin() for _ in range(8)]
    while time.now < begun + 1000.0:
        time.now += 0.01
        for page in each:
            if not page.is_used_up:
                time.now += 0.1
                used += 0.1
                page.spend(0.1)
    assert used <= 1000.0 * SHARE * 1.1


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


def test_the_turns_of_a_coroutine_are_metered_without_its_waiting(time: Time) -> None:
    async def work() -> str:
        time.now += 1.0
        await asyncio.sleep(0)
        time.now += 2.0
        with pytest.raises(ValueError, match="late"):
            await waiting
        time.now += 4.0
        return "done"

    async def main() -> None:
        nonlocal waiting
        waiting = asyncio.get_running_loop().create_future()
        task = asyncio.create_task(metered(work(), turns.append))
        await asyncio.sleep(0.001)
        time.now += 100.0
        waiting.set_exception(ValueError("late"))
        assert await task == "done"

    waiting: asyncio.Future[None]
    turns: list[float] = []
    asyncio.run(main())
    assert turns == [1.0, 2.0, 4.0]


def test_a_metered_coroutine_can_be_cancelled() -> None:
    async def work() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("cleaned up")

    async def main() -> None:
        task = asyncio.create_task(metered(work(), lambda _: None))
        await asyncio.sleep(0)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    ended: list[str] = []
    asyncio.run(main())
    assert ended == ["cleaned up"]
