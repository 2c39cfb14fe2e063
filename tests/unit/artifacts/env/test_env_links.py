"""Linked operations: out ports, outputs, failures that propagate, cancelling a chain."""

import pytest

from jacaros.artifacts import (
    Artifact,
    ArtifactId,
    OperationFailed,
    Out,
    Structure,
    UnknownArtifact,
    link,
    operation,
)


class Lamp(Artifact):
    def init(self):
        self.define_property("power", 0)

    @link(name="raise")
    def raise_power(self, amount: int):
        self.update_property("power", self.value("power") + amount)

    @link
    @operation
    def read(self, power: Out):
        power.set(self.value("power"))

    @link
    def refuse(self):
        self.fail("refused", "refused_by", self.name)

    @link
    def who(self, name: Out):
        name.set(self.caller)

    @link
    async def slowly(self, seconds: float):
        try:
            await self.sleep(seconds)
            self.update_property("power", 50)
        finally:
            self.signal("ended")

    @link
    async def late_refusal(self):
        await self.sleep(1.0)
        self.fail("late", "late", self.name)

    @link(guard="is_on")
    def when_on(self):
        pass

    def is_on(self):
        return self.value("power") > 0


class Switch(Artifact):
    ports = ("out", "spare")

    def init(self):
        self.define_property("presses", 0)

    @operation
    async def press(self, amount: int, power: Out):
        await self.call_linked("out", "raise", amount)
        await self.call_linked("out", "read", power)
        self.update_property("presses", self.value("presses") + 1)

    @operation
    async def owner(self, name: Out):
        await self.call_linked("out", "who", name)

    @operation
    async def forward(self, operation: str, *args: object):
        self.update_property("presses", 9)
        await self.call_linked("out", operation, *args)

    @operation
    async def shine(self):
        await self.call_linked("spare", "raise", 3)

    @operation
    async def wrong_port(self):
        await self.call_linked("in", "raise", 1)

    @operation
    async def careful(self, reason: Out):
        try:
            await self.call_linked("out", "refuse")
        except OperationFailed as failure:
            reason.set(failure.reason)

    @operation
    async def owner_behind_me(self, name: Out):
        await self.call_linked("out", "tell_caller", name)

    @link
    def tell_caller(self, name: Out):
        name.set(self.caller)

    @operation
    async def owner_behind(self, name: Out):
        await self.call_linked("out", "relay", name)

    @link
    async def relay(self, name: Out):
        await self.call_linked("out", "who", name)

    @operation
    def ping(self):
        pass


async def linked(stage):
    lamp, switch = await stage.make(Lamp, name="lamp"), await stage.make(Switch, name="switch")
    stage.main.link(switch, "out", lamp)
    return lamp, switch


async def test_the_chain_runs_on_behalf_of_the_agent_that_started_it(stage):
    _, first = await linked(stage)
    far = await stage.make(Switch, name="far")
    stage.main.link(far, "out", first)
    assert await stage.output(first, "owner", agent="bob") == "bob"
    assert await stage.output(far, "owner_behind", agent="carol") == "carol"


async def test_a_failure_passes_through_with_its_reason_unless_the_caller_handles_it(stage):
    lamp, switch = await linked(stage)
    refused = Structure("refused_by", ("lamp",))
    for name, reason in (
        ("refuse", refused),
        ("late_refusal", Structure("late", ("lamp",))),
        ("ping", Structure("unknown_operation", (lamp, "ping"))),
    ):
        call = await stage.ended(switch, "forward", name)
        assert call.reason == reason
    assert "unknown linked operation `ping/0`" in call.outcome.message
    assert stage.property(switch, "presses") == (9,), "the call was a step boundary"
    assert await stage.output(switch, "careful") == refused


async def test_agents_cannot_call_linked_operations_unless_they_are_operations_too(stage):
    lamp, _ = await linked(stage)
    call = stage.call(lamp, "raise", 1)
    assert call.reason == Structure("unknown_operation", (lamp, "raise"))
    assert "its linked operation of this name is for other artifacts only" in call.outcome.message
    assert stage.call(lamp, "read", Out()).ok


async def test_an_unlinked_or_unknown_port_fails(stage):
    switch = await stage.make(Switch, name="switch")
    call = await stage.ended(switch, "forward", "refuse")
    assert call.reason == Structure("operation_error", ("forward/1",)), "as in CArtAgO"
    assert call.outcome.message == "port out of artifact switch is not linked"
    wrong = await stage.ended(switch, "wrong_port")
    assert wrong.reason == Structure("operation_error", ("wrong_port/0",))
    assert "unknown out port `in`" in wrong.outcome.message


async def test_all_artifacts_behind_a_port_are_called_and_waited_for(stage):
    lamp, switch = await linked(stage)
    second = await stage.make(Lamp, name="second")
    stage.main.link(switch, "out", second)
    stage.main.link(switch, "out", second)
    await stage.output(switch, "press", 5)
    assert [stage.property(each, "power") for each in (lamp, second)] == [(5,), (5,)]
    call = await stage.ended(switch, "forward", "late_refusal")
    assert call.reason == Structure("late", ("lamp",)), "the first in the order of linking"
    assert stage.main.linked(switch, "out") == (lamp, second)


async def test_the_caller_is_free_for_others_while_it_waits(stage):
    _, switch = await linked(stage)
    slow = stage.call(switch, "forward", "slowly", 1.0)
    await stage.clock.sleep(0.5)
    assert stage.call(switch, "ping").ok
    await slow.wait()
    assert slow.ended_at == 1.0


async def test_cancelling_the_caller_cancels_the_linked_operations(stage):
    lamp, switch = await linked(stage)
    watcher = stage.watch(lamp)
    slow = stage.call(switch, "forward", "slowly", 1.0)
    waiting = stage.call(switch, "forward", "when_on")
    await stage.after(0.5, slow.execution.cancel)
    waiting.execution.cancel()
    await stage.clock.sleep(5.0)
    assert watcher.notes == ["+power(0)", "~ended"]
    assert (slow.outcome, waiting.outcome) == (None, None)
    assert stage.call(switch, "ping").ok


async def test_disposing_the_target_fails_the_caller_and_unlinks_it(stage):
    lamp, switch = await linked(stage)
    slow = stage.call(switch, "forward", "slowly", 1.0)
    await stage.after(0.5, stage.main.dispose_artifact, lamp)
    await slow.wait()
    assert slow.reason == Structure("artifact_disposed", ("lamp",))
    again = await stage.ended(switch, "forward", "refuse")
    assert again.reason == Structure("operation_error", ("forward/1",))


async def test_disposing_the_caller_leaves_the_other_links_alone(stage):
    lamp, switch = await linked(stage)
    other = await stage.make(Switch, name="other")
    stage.main.link(other, "out", lamp)
    stage.main.dispose_artifact(switch)
    assert stage.main.linked(switch, "out") == ()
    assert stage.main.linked(other, "out") == (lamp,)


async def test_linking_is_checked(stage):
    lamp, switch = await linked(stage)
    with pytest.raises(
        OperationFailed, match=r"unknown out port `up` of .*; its ports are out, spare"
    ) as caught:
        stage.main.link(switch, "up", lamp)
    assert caught.value.reason == Structure("unknown_port", ("up",))
    with pytest.raises(OperationFailed, match="it has none"):
        stage.main.link(lamp, "out", switch)
    stage.main.dispose_artifact(lamp)
    with pytest.raises(UnknownArtifact) as gone:
        stage.main.link(switch, "out", lamp)
    assert gone.value.reason == Structure("artifact_not_available", ("lamp",))


async def test_links_reach_other_workspaces(stage):
    _, switch = await linked(stage)
    lab = stage.environment.create_workspace("/main/lab")
    far = await lab.make_artifact("far", Lamp)
    stage.main.link(switch, "spare", far)
    await stage.ended(switch, "shine")
    assert stage.main.properties(far)[0].values == (3,)


async def test_a_target_that_is_disposed_during_the_call_is_not_available(stage):
    class Jealous(Artifact):
        @link
        def greet(self):
            for rival in self.workspace.linked(self.workspace.lookup("switch"), "out"):
                if rival is not self.id:
                    self.workspace.dispose_artifact(rival)

    switch = await stage.make(Switch, name="switch")
    first, second = await stage.make(Jealous, name="first"), await stage.make(Jealous, name="second")
    stage.main.link(switch, "out", first)
    stage.main.link(switch, "out", second)
    call = await stage.ended(switch, "forward", "greet")
    assert call.reason == Structure("artifact_not_available", ("second",))


async def test_a_link_to_itself_does_not_block(stage):
    switch = await stage.make(Switch, name="switch")
    stage.main.link(switch, "out", switch)
    assert await stage.output(switch, "owner_behind_me", agent="bob") == "bob"


class Hub(Artifact):
    ports = ("first", "second")

    async def init(self, name=None, kind: object = None):
        if name is not None:
            made = await self.workspace.make_artifact(name, kind)
            self.workspace.link(self.id, None, made)

    @operation
    async def through_any(self, power: Out):
        await self.call_linked(None, "read", power)

    @operation
    async def directly(self, target: ArtifactId, power: Out):
        await self.call_linked(target, "read", power)

    @operation
    def name_of_first(self, name: Out):
        (target,) = self.workspace.linked(self.id, "first")
        name.set(target.name)


class Dim(Artifact):
    def init(self):
        self.define_property("power", 3)

    @link
    def read(self, power: Out):
        power.set(self.value("power"))


async def test_an_artifact_makes_and_links_another_in_its_init(stage):
    hub = await stage.make(Hub, "inner", Dim, name="hub")
    assert await stage.output(hub, "name_of_first") == "inner"
    assert await stage.output(hub, "through_any") == 3


async def test_without_a_port_the_first_one_is_meant(stage):
    hub, dim = await stage.make(Hub, name="hub"), await stage.make(Dim, name="dim")
    stage.main.link(hub, None, dim)
    assert stage.main.linked(hub, "first") == (dim,)
    with pytest.raises(OperationFailed, match=r"unknown out port `any` of .*; it has none"):
        stage.main.link(dim, None, hub)


async def test_a_linked_operation_of_an_artifact_that_is_not_linked_is_called_by_its_id(stage):
    hub = await stage.make(Hub, name="hub")
    lab = stage.environment.create_workspace("/main/lab")
    dim = await lab.make_artifact("dim", Dim)
    assert await stage.output(hub, "directly", dim) == 3
    lab.dispose_artifact(dim)
    call = await stage.ended(hub, "directly", dim, Out())
    assert call.reason == Structure("artifact_not_available", ("dim",))


async def test_an_operation_pending_in_a_linked_call_fails_when_its_artifact_is_disposed(stage):
    lamp, switch = await linked(stage)
    call = stage.call(switch, "forward", "slowly", 5)
    await stage.after(0.1, stage.main.dispose_artifact, switch)
    await call.wait()
    assert call.reason == Structure("artifact_disposed", ("switch",))
    assert stage.main.pending(lamp) == (), "the linked operation is dropped with its caller"
