"""Operations that use resources: they wait, yield, resume, and always release what they hold."""

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, operation
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.operation import OperationRequest
from jacaros.artifacts.env.values import text
from jacaros.artifacts.presence.session import Session
from played import played
from stage_lab import play


class Robot(Artifact):
    """A robot that drives by the second, and an arm."""

    def init(self):
        self.lines = []

    def note(self, line):
        self.lines.append(f"{self.clock.elapsed:g} {line}")

    @operation(uses="wheels", pausable=True)
    async def drive(self, name: str, seconds: float):
        """Drive; braking takes half a second."""
        self.note(f"{name} begins")
        left = float(seconds)
        while left > 1e-6:
            if self._steps.current("x").paused:
                await self.sleep(0.5)
                self.note(f"{name} stands")
                await self.pause_point()
                self.note(f"{name} continues")
            await self.sleep(0.1)
            left -= 0.1
        self.note(f"{name} ends")

    @operation(uses="wheels")
    async def dock(self, name: str, seconds: float):
        """Dock, which cannot be interrupted."""
        self.note(f"{name} begins")
        await self.sleep(seconds)
        self.note(f"{name} ends")

    @operation(uses=("wheels", "arm"), when_preempted="cancel")
    async def grasp(self, name: str, seconds: float):
        """Grasp; the attempt is lost when it is interrupted."""
        self.note(f"{name} begins")
        try:
            await self.sleep(seconds)
        finally:
            self.note(f"{name} is over")


class Lab:
    """Operations of a robot that are begun with an urgency."""

    def __init__(self, environment, robot):
        self.environment, self.id, self.clock = environment, robot, environment.clock
        self.lines = environment.artifact(robot).lines
        self.told, self.outcomes = [], {}

    def begin(self, name, seconds, urgency=0, do="drive"):
        def done(outcome):
            self.outcomes[name] = "ok" if outcome.ok else text(outcome.reason, True)

        request = OperationRequest(self.id, do, (name, seconds), "a", on_done=done, urgency=urgency)
        request.on_preempted = lambda resource: self.told.append(f"{name} {resource}")
        return self.environment.execute(request)


def in_lab(body):
    async def scene(stage):
        await body(Lab(stage.environment, await stage.make(Robot, name="robot")))

    play(scene)


@played(in_lab)
async def test_operations_with_the_same_resource_run_in_turn(lab):
    lab.begin("one", 1)
    lab.begin("two", 1, do="dock")
    await lab.clock.sleep(3)
    assert lab.lines == ["0 one begins", "1 one ends", "1 two begins", "2 two ends"]


@played(in_lab)
async def test_an_urgent_operation_gets_the_wheels_when_the_robot_has_stopped_and_the_other_continues(lab):
    lab.begin("tour", 3)
    await lab.clock.sleep(1.05)
    lab.begin("flee", 1, urgency=10)
    assert lab.told == ["tour wheels"]
    await lab.clock.sleep(10)
    assert lab.lines == [
        "0 tour begins",
        "1.6 tour stands",
        "1.6 flee begins",
        "2.6 flee ends",
        "2.6 tour continues",
        "4.5 tour ends",
    ]
    assert lab.told == ["tour wheels", "tour None"]
    assert lab.outcomes == {"tour": "ok", "flee": "ok"}


@played(in_lab)
async def test_preemption_finishes_or_cancels_what_cannot_pause(lab):
    lab.begin("dock", 2, do="dock")
    lab.begin("grasp", 5, do="grasp")
    await lab.clock.sleep(1)
    lab.begin("flee", 1, urgency=1)
    await lab.clock.sleep(3)
    assert lab.lines[:4] == ["0 dock begins", "2 dock ends", "2 flee begins", "3 flee ends"]
    lab.begin("again", 1, urgency=1)
    await lab.clock.sleep(3)
    assert lab.lines[4:] == ["3 grasp begins", "4 grasp is over", "4 again begins", "5 again ends"]
    assert lab.outcomes["grasp"] == "preempted(wheels)"


@played(in_lab)
async def test_a_suspended_caller_releases_the_wheels_and_waits_for_them_afterwards(lab):
    tour = lab.begin("tour", 2)
    await lab.clock.sleep(1.05)
    tour.pause()
    await lab.clock.sleep(1)
    lab.begin("other", 2)
    await lab.clock.sleep(1)
    tour.resume()
    await lab.clock.sleep(5)
    assert lab.lines == [
        "0 tour begins",
        "1.6 tour stands",
        "2.05 other begins",
        "4.05 other ends",
        "4.05 tour continues",
        "4.95 tour ends",
    ]
    assert not lab.told, "it was suspended by its caller"


@played(in_lab)
async def test_a_preempted_operation_that_is_suspended_does_not_continue(lab):
    tour = lab.begin("tour", 2)
    await lab.clock.sleep(1.05)
    lab.begin("flee", 1, urgency=1)
    await lab.clock.sleep(1)
    tour.pause()
    assert lab.told == ["tour wheels", "tour None"]
    await lab.clock.sleep(5)
    assert lab.lines[-1] == "2.6 flee ends"
    tour.resume()
    await lab.clock.sleep(5)
    assert lab.lines[-2:] == ["7.05 tour continues", "7.95 tour ends"]


@played(in_lab)
async def test_the_end_of_an_agent_releases_what_it_held_and_waited_for(lab):
    first, second = lab.begin("first", 9), lab.begin("second", 9)
    lab.begin("third", 1)
    await lab.clock.sleep(0.05)
    second.cancel()
    first.cancel()
    await lab.clock.sleep(2)
    assert lab.lines == ["0 first begins", "0.05 third begins", "1.05 third ends"]
    lab.begin("fourth", 9)
    lab.begin("fifth", 9)
    lab.environment.workspace("/main").dispose_artifact(lab.id)
    await lab.clock.sleep(1)
    arbiter = lab.environment.arbiter
    assert not arbiter.waiting()
    assert not arbiter.holders("wheels")
    assert lab.outcomes["fifth"] == 'artifact_disposed("robot")'


@played(in_lab)
async def test_a_claim_that_must_not_wait_is_refused_immediately(lab):
    lab.begin("tour", 2)
    outcomes = []
    request = OperationRequest(lab.id, "drive", ("x", 1), "a", on_done=outcomes.append, policy="refuse")
    lab.environment.execute(request)
    assert text(outcomes[0].reason, True) == "resource_busy(wheels)"
    assert outcomes[0].message == "operation drive/2 of artifact robot: wheels is in use"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"uses": "two words"}, "invalid resource `two words`"),
        ({"uses": "lift(2)"}, "write a name, such as wheels"),
        ({"uses": "x", "when_preempted": "pause"}, "needs pausable=True"),
        ({"uses": "x", "when_preempted": "never"}, "expected pause, cancel or finish"),
    ],
)
def test_wrong_declarations_are_refused_when_the_class_is_made(arguments, message):
    def work(self): ...

    with pytest.raises(InvalidArtifact, match=message):
        type("Wrong", (Artifact,), {"work": operation(**arguments)(work)})


@played(in_lab)
async def test_two_environments_share_nothing(lab):
    environment = Environment(lab.clock)
    other = Lab(environment, await environment.workspace("/main").make_artifact("robot", Robot))
    lab.begin("one", 1)
    other.begin("two", 1)
    await lab.clock.sleep(1.5)
    assert other.lines == ["0 two begins", "1 two ends"]


@played(in_lab)
async def test_operations_of_a_session_have_an_urgency(lab):
    session = Session(lab.environment, "script")
    tour = session.begin("drive", "tour", 2)
    await lab.clock.sleep(1.05)
    await session.act("drive", "flee", 1, urgency=5)
    await tour
    assert lab.lines[2:] == ["1.6 flee begins", "2.6 flee ends", "2.6 tour continues", "3.5 tour ends"]


class Clumsy(Artifact):
    def init(self):
        self.carried = 0

    @operation(uses="arm")
    def carry(self):
        self.carried += 1

    @operation(uses="arm")
    async def rest(self):
        await self.sleep(1)

    @operation
    def ask_for_it(self):
        self.start(self.carry)


@played(in_lab)
async def test_an_operation_that_its_artifact_starts_does_not_begin_without_its_resources(lab):
    clumsy = await lab.environment.workspace("/main").make_artifact("clumsy", Clumsy)
    artifact = lab.environment.artifact(clumsy)
    lab.environment.execute(OperationRequest(clumsy, "rest"))
    artifact.start("carry")
    lab.environment.execute(OperationRequest(clumsy, "ask_for_it"))
    await lab.clock.sleep(0.5)
    assert artifact.carried == 0
    await lab.clock.sleep(1)
    assert artifact.carried == 2
