"""Operations of one step: lookup, arguments, outcomes, failures, and what they undo."""

import pytest

from jacaros.artifacts import (
    Artifact,
    Atom,
    InvalidArtifact,
    OperationRequest,
    Out,
    Structure,
    operation,
)
from jacaros.runtime.errors import InternalError


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)

    @operation
    def half(self, number: int, result: Out):
        result.set(number / 2)

    @operation
    def root(self, number: float, label: str, result: Out):
        result.set([type(number).__name__, label])

    @operation
    def crash(self):
        self.update_property("count", 99)
        self.define_property("extra", 1)
        raise RuntimeError("boom")

    @operation
    def defect(self):
        raise InternalError("our own fault")

    @operation
    def badly(self):
        return self._late()

    async def _late(self):
        pass

    @operation
    def greet(self, name: str, greeting: str = "hello", *more: str):
        self.log(" ".join([greeting, name, *more]))


pytestmark = pytest.mark.makes(it=Counter)


async def test_a_plain_operation_has_ended_when_execute_returns(stage):
    counter = await stage.make(Counter, 5)
    call = stage.call(counter, "inc")
    assert call.ok
    assert call.execution.ended
    assert stage.property(counter, "count") == (6,)
    stage.call(counter, "inc", 10)
    assert stage.property(counter, "count") == (16,), "default values give several arities"


async def test_observers_are_notified_before_the_caller(stage, it):
    stage.watch(it)
    stage.story.clear()
    stage.call(it, "inc")
    assert stage.story == [("main", "-count(0) +count(1)"), ("inc", "ok")]


async def test_an_operation_with_any_number_of_arguments_still_has_a_least_number(stage, it):
    assert stage.call(it, "greet", "bob").ok
    assert stage.call(it, "greet", "bob", "hi", "and", "bye").ok
    call = stage.call(it, "greet")
    assert call.reason == Structure("unknown_operation", (it, "greet"))
    assert "greet/any" in call.outcome.message
    assert stage.lines == ["[it] hello bob", "[it] hi bob and bye"]


async def test_whole_real_numbers_are_integers_and_integers_are_real_numbers(stage, it):
    assert await stage.output(it, "half", 8.0) == 4.0
    assert await stage.output(it, "root", 2, Atom("label")) == ["float", "label"]


@pytest.mark.parametrize(
    ("operation", "arguments", "parameter", "expected", "got"),
    [
        ("half", (3.5, Out()), "argument 1 (number)", "an integer", "3.5"),
        ("half", (True, Out()), "argument 1 (number)", "an integer", "true"),
        ("half", ("three", Out()), "argument 1 (number)", "an integer", '"three"'),
        ("half", (3, 4), "argument 2 (result)", "an unbound variable", "4"),
        ("half", (Out(), Out()), "argument 1 (number)", "an integer", "an unbound variable"),
        ("root", (1.5, 7, Out()), "argument 2 (label)", "a text", "7"),
        ("root", (10**400, "x", Out()), "argument 1 (number)", "a number", "1000"),
    ],
)
async def test_a_wrong_argument_fails_and_is_named(stage, it, operation, arguments, parameter, expected, got):
    call = stage.call(it, operation, *arguments)
    key = f"{operation}/{len(arguments)}"
    assert call.reason == Structure("wrong_op_arguments", (it, key))
    assert f"operation {key} of artifact it: {parameter}: expected {expected}" in call.outcome.message
    assert f"found {got}" in call.outcome.message


@pytest.mark.parametrize(
    ("name", "arguments", "parts"),
    [
        ("incc", (), ("did you mean `inc`?", "inc/0, inc/1, half/2")),
        ("inc", (1, 2, 3), ("unknown operation `inc/3` of artifact it (Counter); it has inc/0, inc/1",)),
    ],
)
async def test_an_unknown_operation_fails_with_a_suggestion(stage, it, name, arguments, parts):
    call = stage.call(it, name, *arguments)
    assert call.reason == Structure("unknown_operation", (it, name))
    assert [part for part in parts if part not in call.outcome.message] == []
    assert call.execution.ended


async def test_an_unexpected_error_is_rolled_back_logged_with_its_traceback_and_an_operation_error(
    stage, it, watcher
):
    call = stage.call(it, "crash")
    assert call.reason == Structure("operation_error", ("crash/0",))
    assert "RuntimeError" in call.outcome.message
    assert "boom" in call.outcome.message
    assert stage.logged("[it] error in operation crash/0")
    assert stage.logged("in crash")
    assert stage.logged("RuntimeError: boom")
    assert not stage.logged("kernel/steps.py"), "the trace begins in the author's code"
    assert stage.call(it, "inc").ok
    assert watcher.take() == ["-count(0) +count(1)"]


@pytest.mark.expects_defects
async def test_an_internal_error_is_reported_and_the_operation_fails(stage, it):
    call = stage.call(it, "defect")
    assert call.reason == Structure("internal_error", ("defect/0",))
    assert [str(error) for error in stage.defects] == ["our own fault"]
    assert stage.call(it, "inc").ok


async def test_a_plain_method_that_returns_a_coroutine_is_an_explained_error(stage, it):
    call = stage.call(it, "badly")
    assert call.reason == Structure("operation_error", ("badly/0",))
    assert "write async def" in call.outcome.message


async def test_properties_cannot_be_changed_outside_of_operations(made):
    for misuse in (
        lambda: made.update_property("count", 2),
        lambda: made.define_property("q", 2),
        lambda: made.remove_property("count"),
        lambda: made.signal("s"),
        made.commit,
        lambda: made.current,
    ):
        with pytest.raises(InvalidArtifact, match=r"within an operation.*self\.start"):
            misuse()
    assert made.value("count") == 0, "reading is allowed"
    assert made.values("count") == (0,)
    assert made.has_property("count", 0)
    assert not made.has_property("count", 2)
    assert made.caller is None


@pytest.mark.expects_defects
async def test_an_error_in_the_callers_callback_is_reported_without_other_effects(stage, it):
    def broken(outcome):
        raise ValueError("broken caller")

    stage.main.execute(OperationRequest(it, "inc", on_done=broken))
    assert [str(error) for error in stage.defects] == ["broken caller"]
    assert stage.call(it, "inc").ok
    assert stage.property(it, "count") == (2,)


async def test_a_call_from_a_callback_is_served_after_waiting_ones(stage, it):
    order = []

    class Again:
        agent = "x"

        def observe(self, observation):
            order.append(observation.changed[0][1].values[0] if observation.changed else "focus")
            if len(order) == 2:
                nested = stage.call(it, "inc", 100)
                assert not nested.ok, "the artifact is not free while it publishes"
                order.append("asked")

    stage.main.focus(it, Again())
    stage.call(it, "inc")
    assert order == ["focus", 1, "asked", 101]
    assert stage.story == [("inc", "ok"), ("inc", "ok")]
