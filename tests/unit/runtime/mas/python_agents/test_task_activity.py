"""When a Python agent counts as busy."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from jacaros.agents.mind.state.act import Activity
from jacaros.runtime.mas.agents.python_agents import TaskActivity


class Stage:
    def __init__(self) -> None:
        self.activity = Activity()
        self.settled = 0
        self.task_activity = TaskActivity(self.activity, self._settle)

    def _settle(self) -> None:
        self.settled += 1

    def start(self, work: Coroutine[Any, Any, Any]) -> "asyncio.Task[Any]":
        task = asyncio.ensure_future(work)
        self.task_activity.add(task)
        return task

    async def wait_for_others(self, event: asyncio.Event) -> None:
        with self.task_activity.waiting():
            await event.wait()

    @property
    def busy(self) -> bool:
        return self.activity.pending > 0


async def test_a_task_is_busy_unless_it_waits_for_others() -> None:
    stage, event = Stage(), asyncio.Event()

    async def work() -> None:
        await asyncio.sleep(1)
        await stage.wait_for_others(event)
        await asyncio.sleep(1)

    task = stage.start(work())
    assert stage.busy
    await asyncio.sleep(1.5)
    assert (stage.busy, stage.settled) == (False, 1)
    event.set()
    await asyncio.sleep(0.1)
    assert stage.busy
    await task
    await asyncio.sleep(0)
    assert (stage.busy, stage.settled) == (False, 2)


def test_running_operations_count_beside_the_tasks() -> None:
    stage = Stage()
    with stage.task_activity.under_way():
        assert stage.busy
    assert (stage.busy, stage.settled) == (False, 1)


async def test_one_of_several_tasks_is_enough_to_be_busy() -> None:
    stage, event = Stage(), asyncio.Event()
    stage.start(stage.wait_for_others(event))
    other = stage.start(asyncio.sleep(1))
    await asyncio.sleep(0.5)
    assert stage.busy
    await other
    await asyncio.sleep(0)
    assert not stage.busy
    event.set()


async def test_a_task_that_gathers_others_waits_as_they_do() -> None:
    stage, event = Stage(), asyncio.Event()

    async def work() -> None:
        await asyncio.gather(stage.wait_for_others(event), stage.wait_for_others(event))
        await asyncio.sleep(1)

    task = stage.start(work())
    await asyncio.sleep(0.5)
    assert not stage.busy
    event.set()
    await asyncio.sleep(0.5)
    assert stage.busy
    await task


async def test_a_cancelled_wait_is_over() -> None:
    stage = Stage()
    task = stage.start(stage.wait_for_others(asyncio.Event()))
    await asyncio.sleep(0.1)
    task.cancel()
    await asyncio.sleep(0.1)
    assert not stage.busy
    assert stage.activity.pending == 0
