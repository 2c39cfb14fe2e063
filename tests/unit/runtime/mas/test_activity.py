"""Timers of agents."""

from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.scheduler import Activity, AgentTimer


def test_a_timer_counts_until_it_fires_or_is_cancelled() -> None:
    clock, activity = VirtualClock(), Activity()
    rung: list[float] = []

    async def main() -> None:
        first = AgentTimer(clock, activity, 1.0, lambda: rung.append(clock.elapsed))
        second = AgentTimer(clock, activity, 2.0, lambda: rung.append(clock.elapsed))
        assert activity.pending == 2
        second.cancel()
        second.cancel()
        assert activity.pending == 1
        await clock.sleep(3)
        first.cancel()

    run(main, clock)
    assert activity.pending == 0
    assert rung == [1.0]


def test_the_timer_is_over_when_its_callback_runs() -> None:
    clock, activity = VirtualClock(), Activity()
    seen: list[int] = []

    async def main() -> None:
        AgentTimer(clock, activity, 1.0, lambda: seen.append(activity.pending))
        await clock.sleep(2)

    run(main, clock)
    assert seen == [0]
