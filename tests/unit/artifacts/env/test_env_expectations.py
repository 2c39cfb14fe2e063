"""Operations that say what they expect: an effect after their end, and what must hold while they run."""

import pytest

from jacaros.artifacts import Artifact, Expect, InvalidArtifact, operation
from jacaros.artifacts.env.expectation import mistake_in
from jacaros.artifacts.env.operation import OperationRequest
from jacaros.artifacts.env.values import Atom, Structure, text
from stage_lab import Call


class Base(Artifact):
    """A robot's base, which shows what its sensors report."""

    def init(self, robot: str = ""):
        self.robot_prefix = robot

    @operation
    def report(self, name: str, *values: object):
        self.define_property(name, *values)

    @operation
    def change(self, name: str, *values: object):
        self.update_property(name, *values)

    @operation
    def lose(self, name: str):
        self.remove_property(name)

    @operation
    def send(self, name: str, where: str):
        self.signal(name, where)


class Motion(Base):
    """Its motions, which end without a look at the sensors."""

    def init(self, robot: str = ""):
        self.robot_prefix, self.events = robot, []

    @operation(
        expect=(
            Expect("docked", [True], within=2),
            Expect("battery", ["_", "charging"], within=5, reason="idle"),
        )
    )
    async def dock(self):
        await self.sleep(1)

    @operation(uses="wheels", pausable=True, expect=Expect("docked", [True], within=10))
    async def enter(self):
        await self.sleep(1)

    @operation(uses="wheels")
    async def flee(self):
        await self.sleep(3)

    @operation(expect=Expect("docked", [False]))
    def undock(self):
        """End immediately."""

    @operation(expect=Expect("pose", [{"near": "$x", "by": 0.5}], within=1))
    async def drive(self, x: float = 7.0):
        await self.sleep(1)

    @operation(
        pausable=True,
        meanwhile=(
            Expect("battery", ["_", {"not": "discharging"}], reason="falling"),
            Expect("docked", [True], within=2, reason="loose"),
            Expect("bump", ["front"], signal=True),
        ),
    )
    async def charge(self):
        try:
            await self.sleep(10)
        finally:
            self.events.append(f"{self.clock.elapsed:g}")


async def two(stage, robot=""):
    """A motion, and the base of another robot's or the same robot."""
    return await stage.make(Motion, "r1", name="motion"), await stage.make(Base, robot or "r1", name="base")


async def test_an_operation_succeeds_as_soon_as_its_effects_show(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "docked", False)
    stage.call(base, "report", "battery", 40, Atom("discharging"))
    call = stage.call(motion, "dock")
    await stage.after(1.5, stage.call, base, "change", "docked", True)
    await stage.after(0.5, stage.call, base, "change", "docked", False)  # it was true once, which is enough
    assert call.outcome is None
    await stage.after(1, stage.call, base, "change", "battery", 40, "charging")
    await call.wait()
    assert (call.ok, call.ended_at) == (True, 3)


@pytest.mark.parametrize(
    ("docked", "status", "reason", "at"),
    [
        (False, "charging", "expected(docked(true),found(docked(false)))", 3),
        (True, "discharging", "idle", 6),
    ],
)
async def test_a_missing_effect_fails_the_operation_with_its_reason(stage, docked, status, reason, at):
    motion, base = await two(stage)
    stage.call(base, "report", "docked", docked)
    stage.call(base, "report", "battery", 40, Atom(status))
    call = stage.call(motion, "dock")
    await call.wait()
    assert (text(call.reason), call.ended_at) == (reason, at)


async def test_a_property_that_was_there_is_missed(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "pose", 0)
    call = stage.call(motion, "drive", 2)
    await stage.after(0.5, stage.call, base, "lose", "pose")
    await call.wait()
    assert text(call.reason) == "expected(pose(near(2,0.5)),found(nothing))"
    assert "expected pose(near(2,0.5)) within 1 s, found nothing" in call.outcome.message


async def test_the_default_of_a_parameter_is_expected(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "pose", 7)
    assert (await stage.ended(motion, "drive")).ok


async def test_a_plain_method_can_expect_and_the_own_property_counts(stage):
    motion, _ = await two(stage)
    stage.call(motion, "report", "docked", True)
    call = await stage.ended(motion, "undock")
    assert text(call.reason) == "expected(docked(false),found(docked(true)))"
    stage.call(motion, "change", "docked", False)
    assert (await stage.ended(motion, "undock")).ok


async def test_another_robot_and_a_property_with_other_values_do_not_count(stage):
    motion, base = await two(stage, "r2")
    stage.call(base, "report", "docked", True)
    stage.call(motion, "report", "docked", True, 5)
    for _ in range(2):
        assert (await stage.ended(motion, "undock")).ok
    assert [line for line in stage.lines if "docked/1" in line] == [
        "[motion] warning: cannot check the effect of undock/0: no artifact of this robot shows docked/1"
    ]


@pytest.mark.parametrize(("back", "at"), [(False, 11), (True, 5)])
async def test_a_more_urgent_operation_gets_the_wheels_while_an_effect_is_waited_for(stage, back, at):
    motion, base = await two(stage)
    stage.call(base, "report", "docked", False)
    call = stage.call(motion, "enter")
    await stage.clock.sleep(2)
    fleeing = Call(stage, "flee")
    stage.main.execute(OperationRequest(motion, "flee", (), on_done=fleeing.on_done, urgency=9))
    await stage.after(1, stage.call, base, "change", "docked", back)
    await call.wait()
    assert (call.ok, call.ended_at, fleeing.ended_at) == (back, at, 5)


@pytest.mark.parametrize(
    ("act", "arguments", "reason", "at"),
    [
        ("change", ("battery", 39, Atom("discharging")), "falling", 3),
        ("change", ("docked", False), "loose", 5),
        ("send", ("bump", "front"), 'occurred(bump("front"))', 3),
        ("send", ("bump", "back"), None, 10),
        ("send", ("bell", "front"), None, 10),
        ("lose", ("docked",), None, 10),
    ],
)
async def test_what_must_hold_meanwhile_stops_the_operation(stage, act, arguments, reason, at):
    motion, base = await two(stage)
    stage.call(base, "report", "battery", 40, Atom("charging"))
    stage.call(base, "report", "docked", True)
    call = stage.call(motion, "charge")
    await stage.after(3, stage.call, base, act, *arguments)
    await call.wait()
    assert call.ended_at == at
    assert stage.environment.artifact(motion).events == [str(at)]  # its code has been cancelled
    assert call.ok if reason is None else text(call.reason) == reason


async def test_a_violation_shorter_than_within_or_in_a_pause_does_not_count(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "docked", True)
    call = stage.call(motion, "charge")
    await stage.after(1, stage.call, base, "change", "docked", False)
    await stage.after(1, stage.call, base, "change", "docked", True)
    await stage.after(3, call.execution.pause)
    stage.call(base, "send", "bump", "front")
    call.execution.resume()
    await stage.after(4, stage.call, base, "change", "docked", False)
    await call.wait()
    await stage.clock.sleep(5)
    assert (call.ok, call.ended_at) == (True, 10)


async def test_a_violation_that_outlasts_a_pause_counts(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "battery", 40, Atom("charging"))
    call = stage.call(motion, "charge")
    await stage.after(1, call.execution.pause)
    stage.call(base, "change", "battery", 40, Atom("discharging"))
    await stage.after(1, call.execution.resume)
    await call.wait()
    assert (text(call.reason), call.ended_at) == ("falling", 2)


async def test_an_artifact_that_is_made_meanwhile_counts(stage):
    motion = await stage.make(Motion, name="motion")
    call = stage.call(motion, "drive", 2)
    await stage.clock.sleep(0.5)
    base = await stage.make(Base, name="base")
    stage.call(base, "report", "pose", 0)
    await call.wait()
    assert text(call.reason) == "expected(pose(near(2,0.5)),found(pose(0)))"


async def test_an_artifact_can_start_its_own_operation_that_expects(stage):
    motion = await stage.make(Motion, name="motion")
    made = stage.environment.artifact(motion)
    made.start(made.drive, 2.0)
    await stage.clock.sleep(2)
    assert stage.logged("cannot check the effect of drive/1")


async def test_a_condition_that_is_violated_at_the_start_fails_the_operation(stage):
    motion, base = await two(stage)
    stage.call(base, "report", "battery", 40, Atom("discharging"))
    call = await stage.ended(motion, "charge")
    assert (text(call.reason), call.ended_at) == ("falling", 0)
    assert stage.environment.artifact(motion).events == []


async def test_expectations_do_not_focus_and_leave_nothing_behind(stage):
    motion, base = await two(stage)
    call = stage.call(motion, "charge")
    await stage.clock.sleep(1)
    assert stage.main.observers(base) == ()
    call.execution.cancel()
    await stage.clock.sleep(1)
    publication = stage.main.of_same_robot(base)[0]
    assert list(publication._observers) == []


@pytest.mark.parametrize(
    ("pattern", "value", "matches"),
    [
        ("_", 3, True),
        (True, 1, False),
        (3, 3.0, True),
        ("charging", Atom("charging"), True),
        ({"not": {"in": ["full", "charging"]}}, Atom("full"), False),
        ({"near": 179, "by": 5, "unit": "degrees"}, -178, True),
        ({"near": 179, "by": 5}, -178, False),
        ({"near": "$x", "by": 0.5}, 2.5, True),
        ({"near": "$x", "by": 0.5}, float("nan"), False),
        ({"near": "$x", "by": 0.5}, "here", False),
        ("$x", 2, True),
        (["$x", {"not": "_"}], [2, 3], False),
        (["$x", "_"], [2, 3], True),
        (["$x"], [2, 3], False),
    ],
)
def test_patterns(pattern, value, matches):
    assert mistake_in(pattern, ("x",)) is None
    assert Expect("p", [pattern]).bound({"x": 2}).matches((value,)) is matches


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"expect": Expect("pose", ["$distance"])}, "pose: the operation has no parameter `distance`"),
        ({"expect": Expect("pose", [[{"nera": 1}]])}, "pose: invalid pattern; write a constant, _"),
        ({"expect": Expect("pose", [{"near": "$x", "by": -1}])}, "pose: `near` needs two numbers"),
        ({"expect": Expect("pose", 3)}, "Wrong.go: expected an Expect with a list of patterns, found Expect"),
        ({"meanwhile": {"pose": [3]}}, "expected an Expect with a list of patterns, found 'pose'"),
        (
            {"expect": Expect("pose", [3], within=-1)},
            "pose: within must be a number of seconds, 0 or more, not -1",
        ),
        ({"expect": Expect("pose", [3], within="2")}, "pose: within must be a number of seconds, .* not '2'"),
        (
            {"expect": Expect("pose", [3], within=float("nan"))},
            "within must be a number of seconds, .* not nan",
        ),
        (
            {"meanwhile": Expect("pose", [3], reason="Not there")},
            "pose: reason must be a lower-case .* 'Not there'",
        ),
        ({"meanwhile": Expect("pose", [3], reason=7)}, "pose: reason must be a lower-case letter, .* not 7"),
        (
            {"expect": Expect("Pose", [3])},
            "Pose: name must be a lower-case letter, then letters, .* not 'Pose'",
        ),
        ({"expect": Expect("bump", signal=True)}, "expected a property in expect, found a signal"),
    ],
)
def test_wrong_expectations_are_found_when_the_class_is_made(options, text):
    with pytest.raises(InvalidArtifact, match=text):

        class Wrong(Artifact):
            @operation(**options)
            def go(self, x: float): ...


def test_a_reason_can_be_a_structure():
    assert Expect("a", [1], reason=Structure("lost", (1,))).missed(None)[1] == Structure("lost", (1,))
