"""Pausing: opt-in, immediate where it matters, and with the paused time known."""

import pytest

from jacaros.artifacts import Artifact, link, operation


class Robot(Artifact):
    def init(self, step: float = 1.0):
        self.define_property("units", 0)
        self._step = step
        self.commands = []
        self.resumed = []
        self._motion = None

    def is_free(self, *_: object):
        return self._motion is None or self._motion.paused

    @operation(pausable=True, guard="is_free")
    async def move(self, units: int):
        self._motion = motion = self.current
        motion.on_pause(lambda: self.commands.append(("halt", self.clock.elapsed)))
        motion.on_resume(lambda: self.resumed.append(self.clock.elapsed))
        try:
            for _ in range(units):
                lost = await self.pause_point(lambda: self.commands.append("pause point"))
                if lost:
                    self.commands.append(("lost", round(lost, 6)))
                await self.sleep(self._step)
                self.update_property("units", self.value("units") + 1)
        finally:
            if self._motion is motion:
                self._motion = None

    @operation
    def mark(self):
        self.update_property("units", self.value("units") + 100)

    @operation
    async def deaf(self):
        await self.sleep(1.0)
        assert not self.current.paused
        assert await self.pause_point() == 0.0

    @operation(pausable=True)
    async def waits_itself(self):
        await self.sleep(1.0)
        await self.step(self.current.resumed())
        self.commands.append("resumed")

    @operation(pausable=True)
    async def broken_callback(self):
        self.current.on_pause(lambda: 1 / 0)
        await self.sleep(2.0)
        await self.pause_point()

    @operation(pausable=True)
    async def late_callback(self):
        await self.sleep(1.0)
        self.current.on_pause(lambda: self.commands.append("told at once"))

    @link(pausable=True)
    async def drive(self, units: int):
        self.current.on_pause(lambda: self.commands.append("linked halt"))
        for _ in range(units):
            await self.pause_point()
            await self.sleep(1.0)
            self.update_property("units", self.value("units") + 1)


pytestmark = pytest.mark.makes(it=Robot)


class Boss(Artifact):
    ports = ("robot",)

    @operation(pausable=True)
    async def send_later(self, units: int):
        await self.sleep(1.0)
        await self.call_linked("robot", "drive", units)

    @operation
    async def send(self, units: int):
        await self.call_linked("robot", "drive", units)


def units(stage, robot):
    return stage.property(robot, "units")[0]


async def test_a_paused_motion_stops_immediately_and_continues_with_the_rest(stage, it, made):
    move = stage.call(it, "move", 5)
    await stage.after(1.5, move.execution.pause)
    assert move.execution.paused
    assert made.commands == [("halt", 1.5)]
    await stage.clock.sleep(10.0)
    assert units(stage, it) == 2, "it came to its pause point and waits there"
    move.execution.resume()
    assert not move.execution.paused
    await move.wait()
    assert made.commands == [("halt", 1.5), "pause point", ("lost", 10.0)]
    assert made.resumed == [11.5]
    assert units(stage, it) == 5
    assert move.ended_at == 14.5


async def test_a_pause_that_is_over_before_the_pause_point_still_counts_as_lost_time(stage, it, made):
    move = stage.call(it, "move", 2)
    await stage.after(0.2, move.execution.pause)
    await stage.after(0.3, move.execution.resume)
    await move.wait()
    assert made.commands == [("halt", 0.2), ("lost", 0.3)]


async def test_pausing_again_before_it_continues_keeps_it_paused(stage, it, made):
    move = stage.call(it, "move", 2)
    await stage.after(0.5, move.execution.pause)
    await stage.after(1.0, move.execution.resume)
    move.execution.pause()
    await stage.clock.sleep(5.0)
    assert units(stage, it) == 1
    move.execution.resume()
    await move.wait()
    assert made.commands[-1] == ("lost", 6.0)


async def test_pause_and_resume_are_idempotent(stage, it, made):
    move = stage.call(it, "move", 1)
    move.execution.resume()
    await stage.after(0.5, move.execution.pause)
    move.execution.pause()
    move.execution.resume()
    move.execution.resume()
    await move.wait()
    move.execution.pause()
    assert not move.execution.paused
    assert made.commands == [("halt", 0.5)]


async def test_an_operation_that_is_not_pausable_continues(stage, it):
    deaf = stage.call(it, "deaf")
    deaf.execution.pause()
    assert not deaf.execution.paused
    await deaf.wait()
    assert deaf.ended_at == 1.0


async def test_others_run_while_one_is_paused_even_those_that_exclude_it(stage, it):
    first = stage.call(it, "move", 2)
    await stage.clock.sleep(0.5)
    second = stage.call(it, "move", 1)
    await stage.clock.sleep(0.1)
    assert not second.execution.begun
    first.execution.pause()
    await second.wait()
    assert second.ended_at == 1.6
    first.execution.resume()
    await first.wait()
    assert units(stage, it) == 3


async def test_an_operation_paused_before_it_begins_does_not_begin_before_resume(stage, it):
    stage.call(it, "move", 1)
    await stage.clock.sleep(0.5)
    second = stage.call(it, "move", 1)
    second.execution.pause()
    await stage.clock.sleep(10.0)
    assert not second.execution.begun
    second.execution.resume()
    await second.wait()
    assert second.ended_at == 11.5


async def test_a_paused_operation_can_be_cancelled(stage, it, made):
    move = stage.call(it, "move", 5)
    await stage.after(0.5, move.execution.pause)
    await stage.after(5.0, move.execution.cancel)
    await stage.clock.sleep(1.0)
    assert move.execution.ended
    assert made._motion is None
    assert move.outcome is None


async def test_an_operation_may_wait_for_resume_itself_unless_it_is_cancelled(stage, it, made):
    first, second = stage.call(it, "waits_itself"), stage.call(it, "waits_itself")
    await stage.after(0.5, first.execution.pause)
    second.execution.pause()
    await stage.clock.sleep(2.0)
    assert made.commands == []
    first.execution.task.cancel()
    first.execution.resume()
    second.execution.resume()
    await second.wait()
    assert (made.commands, second.ended_at) == (["resumed"], 2.5)
    await stage.clock.sleep(1.0)
    assert (made.commands, first.outcome) == (["resumed"], None)


async def test_an_error_in_a_pause_callback_is_logged_and_the_pause_is_kept(stage, it):
    call = stage.call(it, "broken_callback")
    await stage.after(0.5, call.execution.pause)
    assert call.execution.paused
    assert stage.logged("ZeroDivisionError")
    await stage.clock.sleep(5.0)
    assert call.outcome is None
    call.execution.resume()
    await call.wait()
    assert call.ok


async def test_a_callback_registered_while_paused_is_called_at_once(stage, it, made):
    call = stage.call(it, "late_callback")
    await stage.after(0.5, call.execution.pause)
    await call.wait()
    assert made.commands == ["told at once"]


@pytest.mark.parametrize(
    ("operation", "target", "before"),
    [
        pytest.param("send", 2, 1, id="called before"),
        pytest.param("send_later", 1, 0, id="called while paused, paused from the beginning"),
    ],
)
async def test_a_pause_goes_through_links(stage, it, made, operation, target, before):
    boss = await stage.make(Boss, name="boss")
    stage.main.link(boss, "robot", it)
    send = stage.call(boss, operation, target)
    await stage.after(0.5, send.execution.pause)
    await stage.clock.sleep(10.0)
    assert made.commands == ["linked halt"]
    assert units(stage, it) == before
    send.execution.resume()
    await send.wait()
    assert send.ended_at == 11.5


async def test_observers_may_pause_an_operation_while_they_are_notified(stage, it):
    move = stage.call(it, "move", 3)
    await stage.clock.sleep(0.5)

    class Pauser:
        agent = "x"

        def observe(self, observation):
            if observation.changed:
                move.execution.pause()

    stage.main.focus(it, Pauser())
    stage.call(it, "mark")
    await stage.clock.sleep(5.0)
    assert units(stage, it) == 101, "the mark, and the move up to its next pause point"
    stage.main.stop_focus(it, stage.main.observers(it)[0])
    move.execution.resume()
    await move.wait()
    assert units(stage, it) == 103


async def test_a_refused_request_can_be_treated_like_any_other(stage, it):
    refused = stage.call(it, "no_such").execution
    refused.pause()
    refused.on_pause(lambda: None)
    refused.resume()
    refused.cancel()
    assert (refused.ended, refused.paused, refused.pausable) == (True, False, False)
    assert refused.take_paused_time() == 0.0
