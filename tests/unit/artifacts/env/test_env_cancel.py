"""Cancelling an operation: the coroutine is cancelled, its ``finally`` runs as a step, and no outcome is reported."""

import asyncio

import pytest

from jacaros.artifacts import Artifact, operation


class Robot(Artifact):
    def init(self):
        self.define_property("moving", False)
        self.define_property("units", 0)
        self.commands = []

    @operation
    async def move(self, units: int):
        self.update_property("moving", True)
        try:
            for _ in range(units):
                self.commands.append("go")
                await self.sleep(1.0)
                self.update_property("units", self.value("units") + 1)
        finally:
            self.commands.append("stop")
            self.update_property("moving", False)

    @operation
    async def hold(self, seconds: float):
        self.update_property("units", -1)
        try:
            await self.clock.sleep(seconds)
        finally:
            self.commands.append("released")

    @operation
    async def bad_end(self):
        try:
            await self.sleep(10.0)
        finally:
            self.update_property("units", 77)
            self.fail("cannot stop")

    @operation
    async def slow_end(self):
        try:
            await self.sleep(10.0)
        finally:
            self.update_property("units", 1)
            await self.sleep(0.5)
            self.update_property("units", 2)

    @operation
    async def wait(self):
        try:
            await self.until(lambda: self.value("units") > 100)
        finally:
            self.commands.append("waited")

    @operation
    async def drop_me(self):
        try:
            self.current.cancel()
            self.update_property("units", 5)
            await self.sleep(1.0)
            self.commands.append("never")
        finally:
            self.commands.append("dropped")

    @operation
    def drop_me_now(self):
        self.current.cancel()
        self.update_property("units", 1)

    @operation
    def ping(self):
        self.commands.append("ping")


pytestmark = pytest.mark.makes(it=Robot)


def state(stage, robot):
    return stage.property(robot, "moving")[0], stage.property(robot, "units")[0]


async def test_a_cancelled_operation_stops_immediately_and_changes_in_finally_are_published(
    stage, it, watcher, made
):
    move = stage.call(it, "move", 10)
    await stage.clock.sleep(2.5)
    watcher.take()
    move.execution.cancel()
    await stage.clock.sleep(0.1)
    assert made.commands == ["go", "go", "go", "stop"]
    assert watcher.take() == ["-moving(True) +moving(False)"]
    assert move.execution.ended
    await stage.clock.sleep(20.0)
    assert state(stage, it) == (False, 2)
    assert move.outcome is None, "no outcome is reported"


async def test_cancelling_twice_or_after_the_end_has_no_effect(stage, it):
    move = await stage.ended(it, "move", 1)
    move.execution.cancel()
    second = stage.call(it, "slow_end")
    await stage.after(1.0, second.execution.cancel)
    second.execution.cancel()
    await stage.after(0.1, second.execution.cancel)
    await stage.clock.sleep(1.0)
    assert state(stage, it) == (False, 2), "finally has run"
    ping = stage.call(it, "ping")
    ping.execution.cancel()
    assert ping.ok


async def test_an_operation_cancelled_before_its_first_step_or_in_the_queue_never_begins(stage, it, made):
    move = stage.call(it, "move", 1)
    move.execution.cancel()
    await stage.clock.sleep(5.0)
    assert (made.commands, move.outcome) == ([], None)
    assert move.execution.ended
    stage.call(it, "hold", 1.0)
    move, ping = stage.call(it, "move", 1), stage.call(it, "ping")
    move.execution.cancel()
    await ping.wait()
    assert ping.ok
    await stage.clock.sleep(3.0)
    assert made.commands == ["released", "ping"]
    assert move.outcome is None


async def test_the_step_in_which_it_is_cancelled_is_rolled_back(stage, it, made):
    hold = stage.call(it, "hold", 10.0)
    await stage.after(1.0, hold.execution.cancel)
    await stage.clock.sleep(1.0)
    assert state(stage, it) == (False, 0)
    assert made.commands == ["released"]
    assert stage.call(it, "ping").ok


async def test_finally_waits_for_its_turn_before_all_others(stage, it, made):
    move = stage.call(it, "move", 10)
    await stage.clock.sleep(0.5)
    hold, ping = stage.call(it, "hold", 1.0), stage.call(it, "ping")
    await stage.after(0.1, move.execution.cancel)
    await ping.wait()
    assert made.commands == ["go", "released", "stop", "ping"]
    assert hold.ok
    assert state(stage, it) == (False, -1)


async def test_cancelled_while_it_queues_for_its_next_step_it_keeps_its_turn_and_stops(stage, it, made):
    move = stage.call(it, "move", 10)
    await stage.clock.sleep(0.5)
    stage.call(it, "hold", 2.0)
    await stage.after(1.0, move.execution.cancel)
    move.execution.task.cancel()
    await stage.after(0.5, move.execution.task.cancel)
    assert made.commands == ["go"]
    await stage.clock.sleep(1.0)
    assert made.commands == ["go", "released", "stop"]
    assert move.execution.ended
    assert stage.call(it, "ping").ok


async def test_it_is_cancelled_while_it_gets_its_turn(stage, it, made):
    move = stage.call(it, "move", 10)
    await stage.clock.sleep(0.5)
    hold = stage.call(it, "hold", 1.0)

    def on_done(outcome):
        asyncio.get_running_loop().call_soon(move.execution.cancel)

    hold.execution.request.on_done = on_done
    await stage.clock.sleep(2.0)
    assert made.commands == ["go", "released", "stop"]
    assert move.execution.ended
    assert stage.call(it, "ping").ok


async def test_a_waiting_condition_is_cancelled(stage, it, made):
    wait = stage.call(it, "wait")
    await stage.after(1.0, wait.execution.cancel)
    assert stage.call(it, "ping").ok
    await stage.clock.sleep(1.0)
    assert made.commands == ["ping", "waited"]
    assert wait.outcome is None


async def test_finally_may_take_its_time_and_have_steps_of_its_own(stage, it, watcher):
    call = stage.call(it, "slow_end")
    await stage.clock.sleep(1.0)
    watcher.take()
    call.execution.cancel()
    await stage.clock.sleep(1.0)
    assert watcher.take() == ["-units(0) +units(1)", "-units(1) +units(2)"]
    assert call.outcome is None


async def test_a_failure_in_finally_is_undone_and_logged(stage, it):
    call = stage.call(it, "bad_end")
    await stage.after(1.0, call.execution.cancel)
    await stage.clock.sleep(1.0)
    assert state(stage, it) == (False, 0)
    assert stage.lines == ["[it] operation bad_end/0 failed: cannot stop"]


async def test_an_operation_may_cancel_itself_and_ends_without_an_outcome(stage, it, made):
    call = stage.call(it, "drop_me_now")
    assert (call.outcome, call.execution.ended) == (None, True)
    assert state(stage, it) == (False, 1)
    call = stage.call(it, "drop_me")
    await stage.clock.sleep(2.0)
    assert made.commands == ["dropped"]
    assert call.outcome is None
    assert state(stage, it) == (False, 5)
    assert stage.call(it, "ping").ok


async def test_an_operation_cancelled_from_outside_of_the_kernel_leaves_the_artifact_usable(stage, it, made):
    move = stage.call(it, "move", 10)
    await stage.after(0.5, move.execution.task.cancel)
    await stage.clock.sleep(0.1)
    assert move.execution.task.cancelled()
    assert made.commands == ["go", "stop"]
    assert stage.call(it, "ping").ok


async def test_a_timeout_within_an_operation_is_not_a_cancellation(stage):
    class Impatient(Artifact):
        def init(self):
            self.define_property("result", "")

        @operation
        async def attempt(self):
            task = asyncio.current_task()
            timer = self.clock.call_later(1.0, task.cancel)
            try:
                await self.sleep(10.0)
            except asyncio.CancelledError:
                task.uncancel()
                self.update_property("result", "timed out")
            finally:
                timer.cancel()

    impatient = await stage.make(Impatient)
    call = await stage.ended(impatient, "attempt")
    assert call.ok
    assert stage.property(impatient, "result") == ("timed out",)
    assert call.ended_at == 1.0


async def test_observers_may_cancel_an_operation_while_they_are_notified(stage, it, made):
    move = stage.call(it, "move", 10)

    class Dropper:
        agent = "x"

        def observe(self, observation):
            if any(new.name == "units" for _, new in observation.changed):
                move.execution.cancel()

    stage.main.focus(it, Dropper())
    await stage.clock.sleep(5.0)
    assert made.commands == ["go", "go", "stop"]
    assert state(stage, it) == (False, 1)


async def test_one_of_several_waiting_operations_is_cancelled(stage, it):
    stage.call(it, "hold", 1.0)
    first, second, third = (stage.call(it, "ping") for _ in range(3))
    assert stage.main.pending(it)[1:] == (first.execution, second.execution, third.execution)
    second.execution.cancel()
    await third.wait()
    assert (first.ok, second.outcome) == (True, None)
    assert stage.main.pending(it) == ()


async def test_an_abandoned_coroutine_does_not_wait_for_its_turn(stage, it, made):
    move = stage.call(it, "move", 1)
    await stage.after(0.5, stage.main.dispose_artifact, it)
    move.execution.task.get_coro().close()
    move.execution.task.cancel()
    await stage.clock.sleep(1.0)
    assert made.commands == ["go", "stop"]
