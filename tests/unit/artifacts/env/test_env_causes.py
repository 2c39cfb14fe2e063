"""Causes: why a property changed, and the tracer, which receives every link."""

import pytest

from jacaros.artifacts import Artifact, Environment, OperationRequest, internal_operation, link, operation
from jacaros.runtime.trace import Cause


class Recorder:
    def __init__(self, clock):
        self.clock, self.links = clock, []

    def link(self, kind, what, parent=None, about=None):
        made = Cause(len(self.links) + 100, parent.id if parent is not None else 0, kind, what)
        self.links.append((made, self.clock.now()))
        return made

    def chain(self, cause):
        """What led to *cause*, the latest first."""
        known = {each.id: each for each, _ in self.links}
        chain = []
        while cause is not None:
            chain.append(f"{cause.kind} {cause.what}")
            cause = known.get(cause.parent)
        return chain


class Lamp(Artifact):
    ports = ("next",)

    def init(self):
        self.define_property("power", 0)

    @operation
    def switch(self):
        self.update_property("power", 1)
        self.start(self.later)

    @internal_operation
    async def later(self):
        await self.sleep(1.0)
        self.signal("burnt", 1)

    @operation
    async def forward(self):
        await self.call_linked("next", "set", 5)

    @link(name="set")
    def set_power(self, power: int):
        self.update_property("power", power)

    @internal_operation
    def sample(self, power: int):
        self.update_property("power", power)


pytestmark = pytest.mark.makes(it=Lamp)


async def test_without_a_tracer_the_cause_of_the_request_is_passed_on(stage, it):
    watcher = stage.watch(it)
    why = Cause(1, 0, "act", "switch")
    stage.call(it, "switch", cause=why)
    await stage.clock.sleep(2.0)
    assert [observation.cause for observation in watcher.observations] == [None, why, why]


async def test_with_a_tracer_each_operation_and_each_commit_is_a_link(stage):
    stage.environment.tracer = recorder = Recorder(stage.clock)
    assert stage.environment.tracer is recorder
    lamp = await stage.make(Lamp)
    watcher = stage.watch(lamp)
    why = Cause(1, 0, "act", "agent acts")
    stage.call(lamp, "switch", cause=why)
    await stage.clock.sleep(2.0)
    changed, signalled = (observation.cause for observation in watcher.observations[1:])
    assert recorder.chain(changed) == ["property /main/it power", "operation /main/it switch/0"]
    assert recorder.chain(signalled) == ["signal /main/it burnt", "operation /main/it switch/0"]
    assert recorder.links[-1][1] == stage.clock.start + 1.0
    first = next(each for each, _ in recorder.links if each.kind == "operation")
    assert first.parent == why.id


async def test_the_chain_goes_through_links(stage):
    stage.environment.tracer = recorder = Recorder(stage.clock)
    first, second = await stage.make(Lamp, name="first"), await stage.make(Lamp, name="second")
    stage.main.link(first, "next", second)
    watcher = stage.watch(second)
    await stage.call(first, "forward").wait()
    assert recorder.chain(watcher.observations[-1].cause) == [
        "property /main/second power",
        "operation /main/second set/1",
        "operation /main/first forward/0",
    ]


async def test_a_process_started_by_a_callback_is_caused_by_its_sample(made, watcher):
    sample = Cause(1, 0, "sample", "/power")
    made.start(made.sample, 7, cause=sample)
    assert watcher.observations[-1].cause == sample


async def test_commits_are_traced_even_without_observers(stage, it):
    stage.environment.tracer = recorder = Recorder(stage.clock)
    stage.call(it, "switch")
    assert [each.kind for each, _ in recorder.links] == ["operation", "property"]


async def test_an_environment_works_with_minimal_arguments(stage):
    environment = Environment(stage.clock)
    assert environment.tracer is None
    assert environment.clock is stage.clock
    assert environment.resources == {}
    lamp = await environment.workspace("/main").make_artifact("lamp", Lamp)
    execution = environment.execute(OperationRequest(lamp, "switch"))
    assert execution.ended
    await environment.close()
