"""The artifacts of the recorded environment cases, run without agents: the kernel's part of each case."""

import importlib.util
from pathlib import Path

import pytest

from jacaros.artifacts import Atom, OperationFailed, Out, Structure
from played import played
from stage_lab import play

CASES = Path(__file__).parents[3] / "conformance_environment"


def artifacts(case):
    path = CASES / case / "artifacts.py"
    spec = importlib.util.spec_from_file_location(f"artifacts_of_{case.replace('/', '_')}", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def result(stage, artifact_id, operation, *args, outputs=1):
    outs = [Out() for _ in range(outputs)]
    call = stage.call(artifact_id, operation, *args, *outs)
    assert call.ok, call.outcome
    return outs[0].value if outputs == 1 else [out.value for out in outs]


def test_every_case_with_artifacts_of_its_own_has_them():
    missing = [
        spec.parent.name
        for spec in sorted(CASES.glob("*/*/spec.md"))
        if not (spec.parent / "artifacts.py").exists() and "Type `" in spec.read_text()
    ]
    assert missing == []


@played(play)
async def test_make_args(stage):
    case = artifacts("creation/make_args")
    a, b = await stage.make(case.Counter, name="a"), await stage.make(case.Counter, 7, name="b")
    d = await stage.make(case.Labelled, "kitchen", 12, name="d")
    assert [stage.property(each, "count") for each in (a, b)] == [(0,), (7,)]
    assert [p.values for p in stage.main.properties(d)] == [("kitchen",), (12,)]


@played(play)
async def test_make_failures(stage):
    case = artifacts("creation/make_failures")
    stage.types = {"Counter": case.Counter, "Fussy": case.Fussy}
    await stage.main.make_artifact("c", "Counter")
    failures = [
        ("c", "Counter", [], ("artifact_already_present", "c")),
        ("d", "NoSuchType", [], ("unknown_artifact_template", "NoSuchType")),
        ("e", "Counter", [1, 2], ("init_failed", "e")),
        ("g", "Fussy", [-1], ("init_failed", "g")),
        ("h", "Fussy", [0], ("init_failed", "h")),
        ("i", "Fussy", ["one"], ("init_failed", "i")),
    ]
    for name, type_name, args, reason in failures:
        with pytest.raises(OperationFailed) as caught:
            await stage.main.make_artifact(name, type_name, args)
        assert caught.value.reason == Structure("makeArtifactFailure", reason)
    await stage.main.make_artifact("f", "Fussy", [])
    assert stage.property(await stage.main.make_artifact("g", "Fussy", [4]), "level") == (4,)


@played(play)
async def test_numbers(stage):
    echo = await stage.make(artifacts("data_conversion/numbers").Echo)
    for value in (0, -1, 128, 40000, 3000000000, 0.5, 0.1, 3.0):
        assert result(stage, echo, "echo", value) == value
        assert result(stage, echo, "kind", value) == "number"
    for value, kind in ((True, "boolean"), ("x", "text"), ([1], "list"), (Structure("p", (1,)), "other")):
        assert result(stage, echo, "kind", value) == kind
    assert [result(stage, echo, "half", n) for n in (7, -8)] == [3.5, -4]
    assert [result(stage, echo, "trunc", r) for r in (2.9, 5, 0.1)] == [2, 5, 0]
    assert result(stage, echo, "big") == 12345678901
    assert result(stage, echo, "small") == 0.0000001
    assert result(stage, echo, "whole") == 3
    bad = stage.call(echo, "half", 3.5, Out())
    assert bad.reason == Structure("wrong_op_arguments", (echo, "half/2"))


@pytest.mark.parametrize(
    "case", ["focus/idempotent", "focus/stop_and_refocus", "observable_properties/agent_edits"]
)
@played(play)
async def test_focus_cases(stage, case):
    counter = await stage.make(artifacts(case).Counter, 10)
    watcher = stage.watch(counter)
    stage.main.focus(counter, watcher)
    stage.call(counter, "inc")
    stage.main.stop_focus(counter, watcher)
    stage.call(counter, "inc")
    stage.main.focus(counter, watcher)
    assert watcher.notes == ["+count(10)", "-count(10) +count(11)", "-count(11)", "+count(12)"]


@played(play)
async def test_two_agents(stage):
    counter = await stage.make(artifacts("focus/two_agents").Counter)
    main, bob = stage.watch(counter, "main"), stage.watch(counter, "bob")
    stage.call(counter, "inc", agent="main")
    stage.call(counter, "inc", agent="bob")
    stage.main.stop_focus(counter, bob)
    stage.call(counter, "inc")
    assert main.notes == ["+count(0)", *(f"-count({n}) +count({n + 1})" for n in range(3))]
    assert bob.notes == [*main.notes[:3], "-count(2)"]


@played(play)
async def test_await_time_interleaving(stage):
    lane = await stage.make(artifacts("guards_and_await/await_time_interleaving").Lane)
    a = stage.call(lane, "run", "a", 3, 400)
    await stage.clock.sleep(0.13)
    stage.call(lane, "run", "b", 2, 400)
    await stage.clock.sleep(0.13)
    stage.call(lane, "mark", "x")
    await a.wait()
    assert stage.story == [("mark", "ok"), ("run", "ok"), ("run", "ok")]
    assert stage.property(lane, "trace") == (["a1", "b1", "x", "a2", "b2", "a3"],)


@played(play)
async def test_failing_late_step(stage):
    two = await stage.make(artifacts("guards_and_await/failing_late_step").Two)
    watcher = stage.watch(two)
    call = stage.call(two, "go")
    await call.wait()
    assert call.reason == Structure("late", (2,))
    assert watcher.notes == ["+n(0)", "-n(0) +n(1)"]


@played(play)
async def test_guard_blocks_intention(stage):
    store = await stage.make(artifacts("guards_and_await/guard_blocks_intention").Store)
    take = stage.call(store, "take", 3)
    stage.call(store, "fill", 2)
    assert take.outcome is None
    stage.call(store, "fill", 2)
    assert take.ok
    assert stage.property(store, "level") == (1,)
    assert stage.call(store, "take", 1).ok


@played(play)
async def test_suspend_pending(stage):
    worker = await stage.make(artifacts("intentions/suspend_pending").Worker)
    number = Out()
    work, bad = stage.call(worker, "work", 300, number), stage.call(worker, "workFail", 300)
    work.execution.pause()
    bad.execution.pause()
    await stage.clock.sleep(0.7)
    assert work.ok
    assert number.value == 1
    assert bad.reason == Structure("no_work", (300,))


@played(play)
async def test_internal_clock(stage):
    clock = await stage.make(artifacts("internal_operations/clock").Clock, 100)
    watcher = stage.watch(clock)
    assert stage.call(clock, "start", 3).ok
    await stage.clock.sleep(0.5)
    assert watcher.take()[2:] == ["~tick(1)", "~tick(2)", "~tick(3)", "-running('yes') +running('no')"]
    stage.call(clock, "start", 1000)
    await stage.clock.sleep(0.5)
    stage.call(clock, "stop")
    watcher.take()
    await stage.clock.sleep(0.2)
    assert not any("tick" in note for note in watcher.take())


@played(play)
async def test_linked_operation(stage):
    case = artifacts("links/linked_operation")
    lamp, switch = await stage.make(case.Lamp, name="lamp"), await stage.make(case.Switch, name="sw")
    stage.main.link(switch, "out", lamp)
    power, name = Out(), Out()
    await stage.call(switch, "press", 5, power).wait()
    await stage.call(switch, "press", 2, power).wait()
    assert power.value == 7
    assert stage.property(lamp, "power") == (7,)
    assert stage.property(switch, "presses") == (2,)
    await stage.call(switch, "owner", name, agent="main").wait()
    assert name.value == "main"
    assert stage.call(lamp, "refuse").reason.functor == "unknown_operation", "for other artifacts only"


@played(play)
async def test_coalescing(stage):
    burst = await stage.make(artifacts("observable_properties/coalescing").Burst)
    watcher = stage.watch(burst)
    stage.call(burst, "burst", 5)
    await stage.call(burst, "pauses", 3).wait()
    stage.call(burst, "flash")
    assert watcher.notes == [
        "+count(0)",
        "-count(0) +count(5)",
        "-count(5) +count(6)",
        "-count(6) +count(7)",
        "-count(7) +count(8)",
    ]


@played(play)
async def test_define_update_remove(stage):
    board = await stage.make(artifacts("observable_properties/define_update_remove").Board)
    watcher = stage.watch(board)
    for operation, *args in (("post", "one"), ("edit", "two"), ("wipe",), ("post", "three")):
        assert stage.call(board, operation, *args).ok
    assert watcher.notes == [
        "+note('one')",
        "-note('one') +note('two')",
        "-note('two')",
        "+note('three')",
    ]


@played(play)
async def test_failure_tuple(stage):
    gate = await stage.make(artifacts("operations/failure_tuple").Gate)
    wrong, jam, plain = stage.call(gate, "open", 3), stage.call(gate, "jam"), stage.call(gate, "plain")
    assert wrong.reason == Structure("wrong_key", (3, "gate", True))
    assert (jam.outcome.message, jam.reason) == ("jammed", None)
    assert isinstance(plain.reason, Atom)
    assert stage.call(gate, "open", 7).ok
    assert stage.property(gate, "state") == ("open",)


@played(play)
async def test_outputs(stage):
    calc = await stage.make(artifacts("operations/outputs").Calc)
    assert result(stage, calc, "add", 2, 3) == 5
    assert result(stage, calc, "divmod", 17, 5, outputs=2) == [3, 2]
    first, second = Out(), Out()
    stage.call(calc, "swap", first, second, 1, 2)
    assert (first.value, second.value) == (2, 1)
    assert result(stage, calc, "answer") == 42
    assert stage.call(calc, "check", 3, 10).ok
    assert stage.call(calc, "check", 30, 10).reason == Structure("too_big", (30, 10))


@played(play)
async def test_overload(stage):
    show = await stage.make(artifacts("operations/overload").Show)
    assert result(stage, show, "show", 1) == "one 1"
    assert result(stage, show, "show", 1, 2) == "two 1 2"
    assert result(stage, show, "sum", 1, 2, 3, 4) == 10
    assert result(stage, show, "sum", 5, 6) == 11
    assert result(stage, show, "sum", 9) == "exact 9"
    assert result(stage, show, "sum") == 0


@played(play)
async def test_patrol_recharge(stage):
    case = artifacts("robot_like/patrol_recharge")
    motion = await stage.make(case.Motion, "linked", name="motion")
    battery = await stage.make(case.Battery, 60, name="battery")
    stage.main.link(motion, "battery", battery)
    watcher = stage.watch(battery)
    moves = [stage.call(motion, "moveForward", 2), stage.call(motion, "rotate", 90)]
    moves.append(stage.call(motion, "moveForward", 2))
    assert moves[1].outcome is None, "a move is in progress"
    await moves[2].wait()
    assert stage.property(motion, "pose") == (2, 2, 90)
    assert watcher.notes[1:] == [
        "-battery(60) +battery(40) -diagnostics('Full Battery') +diagnostics('Medium Battery')",
        "-battery(40) +battery(20) -diagnostics('Medium Battery') +diagnostics('Low Battery')",
    ]
    recharge = stage.call(battery, "operationRecharge")
    await recharge.wait()
    assert result(stage, battery, "getCurrentBattery") == 100
    move = stage.call(motion, "moveForward", 4)
    await stage.clock.sleep(0.06)
    assert stage.call(motion, "abortMoving").ok
    await move.wait()
    assert move.reason == Structure("aborted", (1,))
    assert stage.call(motion, "rotate", -180).ok
    assert stage.property(motion, "pose") == (2, 3, 270)


@played(play)
async def test_own_oldest_first(stage):
    named = artifacts("selection/own_oldest_first").Named
    ids = [await stage.make(named, text, name=text) for text in ("first", "second", "third")]
    assert stage.main.providers("whoami", 1) == tuple(ids)
    assert result(stage, ids[2], "whoami") == "third"
    stage.main.dispose_artifact(ids[0])
    assert stage.main.providers("whoami", 1) == tuple(ids[1:])


@played(play)
async def test_signals_not_stored(stage):
    bell = await stage.make(artifacts("signals/not_stored").Bell)
    stage.call(bell, "ring", 1)
    watcher = stage.watch(bell)
    stage.call(bell, "ring", 2)
    stage.main.stop_focus(bell, watcher)
    stage.call(bell, "ring", 3)
    stage.main.focus(bell, watcher)
    stage.call(bell, "ring", 4)
    assert watcher.notes == ["~rung(2,'loud')", "~rung(4,'loud')"]


@played(play)
async def test_signals_order_with_changes(stage):
    ticker = await stage.make(artifacts("signals/order_with_changes").Ticker)
    watcher = stage.watch(ticker)
    for operation in ("tickInc", "tickInc", "sigFirst"):
        stage.call(ticker, operation)
    assert watcher.notes == [
        "+count(0)",
        "~tick(1) -count(0) +count(1)",
        "~tick(2) -count(1) +count(2)",
        "~early(0)",
        "-count(2) +count(3)",
    ]


@played(play)
async def test_create_and_join(stage):
    counter = artifacts("workspaces/create_and_join").Counter
    lab = stage.environment.create_workspace("/main/lab")
    here, there = await stage.make(counter, 1, name="c"), await lab.make_artifact("c", counter, [100])
    assert lab.providers("inc", 0) == (there,)
    assert stage.main.providers("inc", 0) == (here,)
    assert stage.call(there, "inc").ok
    assert [stage.property(each, "count") for each in (here, there)] == [(1,), (101,)]
