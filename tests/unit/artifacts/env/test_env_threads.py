"""Threads: blocking code of an operation runs in one, and other threads start internal operations."""

import asyncio
import threading

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, Out, Structure, operation
from stage_lab import play


class Blocking(Artifact):
    def init(self):
        self.define_property("count", 0)
        self.gate = threading.Event()
        self.inside = threading.Event()

    def wait_at_gate(self):
        self.inside.set()
        assert self.gate.wait(60.0)
        return 42

    @operation
    async def work(self, result: Out):
        self.update_property("count", 1)
        found = await self.step(asyncio.to_thread(self.wait_at_gate))
        self.update_property("count", self.value("count") + 1)
        result.set(found)

    @operation
    async def meddle(self):
        await self.step(asyncio.to_thread(self.update_property, "count", 5))

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 10)


pytestmark = pytest.mark.makes(it=Blocking)


async def until_inside(made):
    """Wait until the worker thread reaches its gate. Virtual time does not advance meanwhile."""
    await asyncio.get_running_loop().run_in_executor(None, made.inside.wait, 60.0)


async def test_others_use_the_artifact_while_a_thread_works_for_an_operation(stage, it, made):
    result = Out()
    call = stage.call(it, "work", result)
    await until_inside(made)
    assert stage.property(it, "count") == (1,)
    assert stage.call(it, "inc").ok
    made.gate.set()
    await call.wait()
    assert (result.value, stage.property(it, "count")) == (42, (12,))
    assert stage.elapsed == 0.0, "virtual time stood still"


async def test_disposal_does_not_wait_for_a_thread(stage, it, made):
    call = stage.call(it, "work", Out())
    await until_inside(made)
    stage.main.dispose_artifact(it)
    await call.wait()
    assert call.reason == Structure("artifact_disposed", ("it",))
    await stage.environment.close()
    made.gate.set()


async def test_a_thread_changes_nothing_itself(stage, it):
    call = await stage.ended(it, "meddle")
    assert call.outcome.message.startswith(InvalidArtifact.__name__)
    assert "self.start(...)" in call.outcome.message
    assert stage.property(it, "count") == (0,)


def test_a_thread_that_starts_a_process_after_the_end_of_the_loop_does_no_harm():
    kept = []

    async def scene(stage):
        kept.append(stage.environment.artifact(await stage.make(Blocking)))

    play(scene)
    kept[0].start("inc")
