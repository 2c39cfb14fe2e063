"""Callers that give equal goals again and again keep an agent busy; that is not an endless loop of its program."""

import asyncio

import pytest
from serving_lab import Lab, run

from jacaros.runtime.mas.scheduler import Runnable, Scheduler
from jacaros.serving.goals import ACHIEVED, CANCELLED

PROGRAM = """
{{ offer(goal, work, at_most(1), when_busy({when_busy})) }}
+!work <- for (.range(I, 1, 50)) {{ X = I }}.
!count(0).
+!count(N) <- !!count(N + 1).
"""
ROUNDS = 10


@pytest.mark.parametrize(("when_busy", "first_end"), [("wait", ACHIEVED), ("replace", CANCELLED)])
def test_equal_goals_of_two_callers_are_not_reported_as_a_loop(
    monkeypatch: pytest.MonkeyPatch, when_busy: str, first_end: str
) -> None:
    # The agent counts, so it is never idle. A goal ends between two looks, which thus find different goals.
    monkeypatch.setattr(Scheduler, "TURNS_UNTIL_LOOK", 7)
    looks: list[bool] = []
    log: list[str] = []

    async def test(lab: Lab) -> None:
        scheduler = lab.mas.system.scheduler
        look = scheduler.busy_for_long

        def counted(agent: Runnable, is_first: bool) -> None:
            looks.append(is_first)
            look(agent, is_first)

        scheduler.busy_for_long = counted
        lab.mas.system.listen_to_log(lambda line, _: log.append(line))
        ends: list[str] = []

        async def caller(name: str) -> None:
            session = lab.session(name)
            for _ in range(ROUNDS):
                goal = session.achieve("bob", "work")
                await goal.wait()
                ends.append(goal.state)

        await asyncio.gather(caller("anna"), caller("bert"))
        assert (len(ends), ends[0], ends[-1]) == (2 * ROUNDS, first_end, ACHIEVED)

    run(test, PROGRAM.format(when_busy=when_busy))
    assert len(looks) > 3
    assert looks.count(True) == 1  # it was never idle
    assert [line for line in log if "repeats without waiting" in line] == []
