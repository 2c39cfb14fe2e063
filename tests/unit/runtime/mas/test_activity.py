"""Timers of agents."""

from jacaros.agents.mind.state.act import Activity
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.scheduler import AgentTimer


def test_a_timer_counts_until_it_fires_or_is_cancelled() -> None:
    clock, activity = VirtualClock(), Activity()
    rung: list[tuple[float, int]] = []

    def ring() -> None:
        rung.append((clock.elapsed, activity.pending))

    async def main() -> None:
        first, second = (AgentTimer(clock, activity, seconds, ring) for seconds in (1.0, 2.0))
        assert activity.pending == 2
        second.cancel()
        second.cancel()
        assert activity.pending == 1
        await clock.sleep(3)
        first.cancel()

    run(main, clock)
    assert activity.pending == 0
    assert rung == [(1.0, 0)], "the timer is over when its callback runs"
