"""ArtOdometry and ArtOdometryOnDemand: one event a message, or one a request."""

from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, OperationFailed, Out, Structure
from jacaros.robots.artifacts.odometry import ArtOdometry, ArtOdometryOnDemand
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.ros.drivers.memory.backend import MemoryBackend
from jacaros.runtime.trace import Cause

pytestmark = pytest.mark.world("empty")


async def test_verbose_odometry_gives_one_change_and_no_signal_for_each_new_message(lab: Lab) -> None:
    """Defect 8: a signal beside the update gave up to three events for a message."""
    odometry = await lab.make(ArtOdometry)
    watcher = lab.watch(odometry)
    assert watcher.holds("odom") == [(0, 0, 0)]
    motion = await lab.make(ArtCmdVel)
    await lab.do(motion, "moveForward", 1)
    await lab.sleep(1)
    xs = [values[0] for values in watcher.values("odom")[1:]]
    assert xs == sorted(set(xs))  # type: ignore[type-var]
    assert len(xs) > 40
    assert xs[-1] == pytest.approx(1, abs=0.01)
    assert watcher.signals == []
    changed = len(watcher.changes)
    await lab.sleep(5)
    assert len(watcher.changes) == changed, "a standing robot causes no change"


class Causes:
    def link(self, kind: str, what: str, parent: Cause | None = None, about: object = None) -> Cause:
        return Cause(1, 0, kind, what)

    def received_message(self, topic: str, message: Any) -> Cause:
        return Cause(1, 0, "sample", topic)

    def sent_message(self, topic: str, message: Any, parent: Cause | None) -> None:
        pass


async def test_properties_change_in_steps_of_the_artifact_with_the_cause_of_the_message(lab: Lab) -> None:
    """Defect 4: the original changed properties outside of the lock, from the threads of ROS."""
    lab.backend.tracer = Causes()
    odometry = await lab.make(ArtOdometry)
    watcher = lab.watch(odometry)
    motion = await lab.make(ArtCmdVel)
    await lab.do(motion, "moveForward", 0.5)
    kinds = {observation.cause.kind for observation in watcher.observations if observation.cause}
    assert kinds == {"sample"}


async def test_pose_has_the_heading_in_degrees(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtOdometry))
    await lab.do(await lab.make(ArtCmdVel), "goTo", 1, 0, 135)
    await lab.sleep(0.2)
    assert watcher.holds("pose")[0] == pytest.approx((1, 0, 135), abs=0.2)


async def test_rate_and_dead_band_limit_the_changes(lab: Lab) -> None:
    slow = lab.watch(await lab.make(ArtOdometry, Structure("rate", (2,))))
    coarse = lab.watch(await lab.make(ArtOdometry, {"dead_band": 0.25}))
    motion = await lab.make(ArtCmdVel)
    await lab.do(motion, "moveForward", 1)
    await lab.sleep(1)
    assert len(slow.values("odom")) < 10
    assert slow.holds("odom")[0] == pytest.approx((1, 0, 0), abs=0.01)
    assert 4 <= len(coarse.values("odom")) <= 6


@pytest.mark.parametrize(
    "arguments", [(ArtOdometryOnDemand,), (ArtOdometry, Structure("mode", ("on_demand",)))]
)
async def test_on_demand_odometry_changes_only_when_asked(lab: Lab, arguments: tuple[Any, ...]) -> None:
    odometry = await lab.make(*arguments)
    watcher = lab.watch(odometry)
    await lab.do(await lab.make(ArtCmdVel), "moveForward", 0.5)
    await lab.sleep(0.1)
    assert watcher.values("odom") == [(0, 0, 0)]
    await lab.do(odometry, "getCurrentOdom")
    assert watcher.values("odom")[1] == pytest.approx((0.5, 0, 0), abs=0.01)
    await lab.do(odometry, "getCurrentOdom")
    assert len(watcher.values("odom")) == 3, "an answer is shown although it is the same"
    assert watcher.signals == []


@made(ArtOdometryOnDemand)
async def test_odometry_can_be_given_to_the_caller_alone(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    await lab.do(await lab.make(ArtCmdVel), "goTo", 0.5, 0, 90)
    await lab.sleep(0.1)
    outs = Out(), Out(), Out()
    await lab.do(artifact, "getCurrentOdom", *outs)
    assert [out.value for out in outs] == pytest.approx([0.5, 0, 0], abs=0.01)
    await lab.do(artifact, "getCurrentPose", *outs)
    assert [out.value for out in outs] == pytest.approx([0.5, 0, 90], abs=0.2)
    assert watcher.values("odom") == [(0, 0, 0)]


@made(ArtOdometry)
async def test_a_question_before_the_first_message_waits_for_it(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "getCurrentOdom")
    assert 0 < lab.clock.elapsed <= 0.1


@pytest.mark.world(None)
@made(ArtOdometry)
async def test_a_question_without_a_message_fails(lab: Lab, artifact: ArtifactId) -> None:
    assert (await lab.call(artifact, "getCurrentOdom")).reason == "no_odometry(5)"
    assert lab.clock.elapsed == 5


@pytest.mark.world(None)
async def test_creation_neither_sleeps_nor_waits_for_anything(lab: Lab) -> None:
    """Defect 11: five seconds for each topic, and for ever without a master."""
    await lab.make(ArtOdometry, "robot_7")
    await lab.make(ArtCmdVel, "robot_7")
    assert lab.clock.elapsed == 0


@pytest.mark.world(None)
async def test_a_disposed_artifact_leaves_its_topics(lab: Lab) -> None:
    """Defect 11: nodes, publishers and subscriptions leaked."""
    assert isinstance(lab.backend, MemoryBackend)
    before = lab.backend.graph.topics()
    made = [await lab.make(ArtOdometry, {"rate": 1}), await lab.make(ArtCmdVel, "r")]
    assert lab.backend.graph.topics() != before
    for artifact in made:
        lab.workspace.dispose_artifact(artifact)
    await lab.sleep(3)
    assert lab.backend.graph.topics() == before
    assert lab.logged == []


@pytest.mark.world("two_robots")
async def test_a_robot_name_and_a_namespace_prefix_the_topic_but_no_property(lab: Lab) -> None:
    for number, argument in enumerate(["robot_0", Structure("namespace", ("robot_1",))]):
        odometry = await lab.make(ArtOdometry, argument)
        watcher = lab.watch(odometry)
        await lab.sleep(0.1)
        assert watcher.holds("odom") == [((-1, -1, 0), (1, 1, 0))[number]]


@pytest.mark.world("two_robots")
async def test_another_topic_is_an_option_and_an_unknown_option_is_refused(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtOdometry, Structure("topic", ("robot_0/odom",))))
    await lab.sleep(0.1)
    assert watcher.holds("odom") == [(-1, -1, 0)]
    with pytest.raises(OperationFailed) as refused:
        await lab.make(ArtOdometry, Structure("speed", (1,)))
    assert "dead_band, expire, frame, latest_only, mode, namespace, rate, topic, watch_connection" in str(
        refused.value
    )
    with pytest.raises(OperationFailed, match="robot 1"):
        await lab.make(ArtOdometry, "robot 1")
    assert lab.logged == []


async def test_a_topic_without_publishers_is_logged_after_some_seconds(lab: Lab) -> None:
    await lab.make(ArtOdometry, Structure("topic", ("odomm",)), name="compass")
    await lab.sleep(2.9)
    assert lab.logged == []
    await lab.sleep(10)
    [told] = lab.logged
    assert told == (
        "[compass] no publisher on topic /odomm (nav_msgs/msg/Odometry); still listening\n"
        "  help: did you mean `/odom`? `--namespace NAME` and `--remap OLD:=NEW` change the names of a run"
    )


async def test_a_topic_that_appeared_or_was_closed_is_not_logged(lab: Lab) -> None:
    await lab.make(ArtOdometry)
    given_up = await lab.make(ArtOdometry, Structure("topic", ("odomm",)))
    await lab.sleep(1)
    lab.workspace.dispose_artifact(given_up)
    await lab.sleep(10)
    assert lab.logged == []


@pytest.mark.world(None)
async def test_a_missing_topic_is_not_logged_while_the_graph_is_lost(lab: Lab) -> None:
    lab.backend.set_connected(False)  # type: ignore[attr-defined]
    await lab.make(ArtOdometry)
    await lab.sleep(10)
    lab.backend.set_connected(True)  # type: ignore[attr-defined]
    await lab.sleep(2.9)
    assert lab.logged == []
    await lab.sleep(6)
    assert len(lab.logged) == 1
