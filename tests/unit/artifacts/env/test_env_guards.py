"""Guards: an operation waits until its guard is true, in the order of arrival."""

import pytest

from jacaros.artifacts import Artifact, Structure, operation


class Store(Artifact):
    def init(self, capacity: int = 100):
        self.define_property("level", 0)
        self.capacity = capacity
        self.checks = []
        self.closed = False

    @operation
    def fill(self, amount: int = 1):
        self.update_property("level", self.value("level") + amount)

    @operation(guard="has")
    def take(self, amount: int = 1):
        self.update_property("level", self.value("level") - amount)

    def has(self, amount: int = 1):
        self.checks.append((self.caller, amount))
        return self.value("level") >= amount

    @operation(guard="has")
    async def slowly(self, amount: int):
        self.update_property("level", self.value("level") - amount)
        await self.sleep(1.0)

    @operation(guard="is_open")
    def visit(self, name: str):
        self.log(name)

    def is_open(self):
        return not self.closed

    @operation
    def close(self, closed: bool):
        self.closed = closed

    @operation(guard="broken")
    def wrong(self):
        self.log("never")

    def broken(self):
        raise KeyError("guard")

    @operation(guard="is_owner")
    def use(self):
        self.log(self.caller)

    def is_owner(self):
        return self.caller == "owner"

    @operation(guard="broken_later")
    def wrong_later(self):
        self.log("never")

    def broken_later(self):
        return self.closed and 1 / 0


pytestmark = pytest.mark.makes(it=Store)


def level(stage, store):
    return stage.property(store, "level")[0]


async def test_a_step_completes_before_the_operations_that_it_enables(stage, it):
    stage.watch(it)
    stage.call(it, "take", 1)
    stage.story.clear()
    stage.call(it, "fill", 1)
    assert stage.story == [
        ("main", "-level(0) +level(1)"),
        ("fill", "ok"),
        ("main", "-level(1) +level(0)"),
        ("take", "ok"),
    ]


async def test_a_waiting_request_is_withdrawn_by_cancel_without_an_outcome(stage, it):
    first, second = stage.call(it, "take"), stage.call(it, "take")
    first.execution.cancel()
    assert first.execution.ended
    stage.call(it, "fill", 5)
    assert (first.outcome, second.ok) == (None, True)
    assert level(stage, it) == 4


async def test_a_guarded_coroutine_begins_when_its_guard_is_true(stage, it):
    slowly = stage.call(it, "slowly", 1)
    await stage.clock.sleep(1.0)
    stage.call(it, "fill", 1)
    await slowly.wait()
    assert slowly.ended_at == 2.0


async def test_a_guard_may_be_without_parameters(stage, it):
    stage.call(it, "close", True)
    visit = stage.call(it, "visit", "bob")
    assert visit.outcome is None
    stage.call(it, "close", False)
    assert visit.ok


async def test_an_error_in_a_guard_fails_the_operation_now_or_later(stage, it):
    assert stage.call(it, "wrong").reason == Structure("operation_error", ("wrong/0",))
    later = stage.call(it, "wrong_later")
    assert later.outcome is None
    stage.call(it, "close", True)
    assert later.reason == Structure("operation_error", ("wrong_later/0",))
    assert stage.lines
    assert not any(line.endswith("never") for line in stage.lines)


async def test_a_guard_can_read_the_caller(stage, it):
    stage.call(it, "use", agent="thief")
    stage.call(it, "use", agent="owner")
    assert stage.lines == ["[it] owner"]


async def test_guards_are_evaluated_on_arrival_and_after_each_step_only(stage, it, made):
    stage.call(it, "take", agent="a")
    await stage.clock.sleep(1.0)
    assert made.checks == [("a", 1)]
    stage.call(it, "close", True)
    stage.call(it, "close", False)
    assert made.checks == [("a", 1)] * 3


async def test_a_chain_of_hundreds_of_waiting_operations_needs_no_deep_stack(stage, it):
    chain = [stage.call(it, "take", 1) for _ in range(400)]

    class Refill:
        agent = "x"

        def observe(self, observation):
            if observation.changed and chain[-1].outcome is None and observation.changed[0][1].values == (0,):
                stage.call(it, "fill")

    stage.main.focus(it, Refill())
    stage.call(it, "fill")
    assert chain[0].ok
    assert chain[-1].ok
