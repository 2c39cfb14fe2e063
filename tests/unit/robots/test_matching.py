"""Operations that publish wait until a subscription is matched, so that their first message arrives."""

from typing import cast

import pytest
from robot_lab import STANDSTILL, Lab, made

from jacaros.artifacts import ArtifactId, Structure
from jacaros.robots.artifacts.thesis import ArtCleaning
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.kit.connection import GUARD_TIMEOUT, SETTLING, TURN, Matching
from jacaros.robots.ros.guarded import guarded_by
from jacaros.robots.ros.node import Publisher


def driving(lab: Lab) -> list[float]:
    """The times of the commands that move the robot."""
    return [time for time, *command in lab.commands if tuple(command) != STANDSTILL]


def warnings(lab: Lab) -> list[str]:
    return [line for line in lab.logged if "subscriber" in line]


pytestmark = made(ArtCmdVel, on_graph=True)


async def test_an_open_loop_motion_loses_no_command_to_a_base_that_is_matched_late(
    lab: Lab, artifact: ArtifactId
) -> None:
    motion = await lab.begun(1.0, artifact, "move", 25)
    lab.record()
    await motion.done
    await lab.sleep(0.1)
    assert len(driving(lab)) == 26
    assert driving(lab)[0] == pytest.approx(1.25, abs=0.06)
    assert lab.last_command == STANDSTILL
    assert warnings(lab) == []


async def test_a_motion_begins_immediately_when_a_base_is_matched(lab: Lab, artifact: ArtifactId) -> None:
    lab.record()
    await lab.do(artifact, "move", 4)
    await lab.sleep(0.1)
    assert driving(lab) == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])


@made(ArtCmdVel)
async def test_in_the_graph_inside_the_process_nothing_waits(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "move", 4)
    assert lab.clock.elapsed == pytest.approx(0.5)
    assert len(warnings(lab)) == 1


async def test_a_motion_without_a_base_warns_once_and_begins(lab: Lab, artifact: ArtifactId) -> None:
    for ends in (3.5, 7.0):
        await lab.do(artifact, "move", 4)
        assert lab.clock.elapsed == pytest.approx(ends, abs=0.11)
    (warning,) = warnings(lab)
    assert warning.endswith(
        " warning: no subscriber on topic /cmd_vel after 3 s; publishing anyway\n"
        "  help: start the node that subscribes to it; `jacaros ros list` shows the topics of the graph"
    )


async def test_a_base_that_left_is_waited_for_again(lab: Lab, artifact: ArtifactId) -> None:
    base = lab.backend.subscription("/cmd_vel", "geometry_msgs/msg/Twist", lambda sample: None)
    await lab.do(artifact, "move", 4)
    base.close()
    motion = await lab.begun(2.0, artifact, "move", 4)
    lab.record()
    await motion.done
    await lab.sleep(0.1)
    assert len(driving(lab)) == 5


@made(ArtCmdVel, Structure("unmatched", ("fail",)), Structure("match_timeout", (1,)), on_graph=True)
async def test_a_motion_fails_by_option_when_no_base_is_matched(lab: Lab, artifact: ArtifactId) -> None:
    run = await lab.call(artifact, "move", 4)
    assert lab.clock.elapsed == pytest.approx(1.0)
    assert run.reason == 'unmatched("/cmd_vel")'
    assert warnings(lab) == []


async def test_a_motion_that_waits_for_its_base_is_aborted_immediately(
    lab: Lab, artifact: ArtifactId
) -> None:
    motion = await lab.begun(0.5, artifact, "move", 25)
    await lab.do(artifact, "abortMoving")
    await motion.done
    assert lab.clock.elapsed == pytest.approx(0.5)
    assert motion.reason == "aborted(0)"


@pytest.mark.parametrize("end", ["dropped", "suspended"])
async def test_a_motion_that_ends_while_it_waits_for_its_base_does_not_drive_unless_it_is_resumed(
    lab: Lab, artifact: ArtifactId, end: str
) -> None:
    motion = await lab.begun(0.5, artifact, "move", 4)
    (motion.execution.cancel if end == "dropped" else motion.execution.pause)()
    lab.record()
    await lab.sleep(5.0)
    assert driving(lab) == []
    if end == "suspended":
        await motion.resumed()
        await lab.sleep(0.1)
        assert len(driving(lab)) == 5


@made(ArtCleaning, on_graph=True)
async def test_the_first_task_of_the_household_is_published_when_its_listener_is_matched(
    lab: Lab, artifact: ArtifactId
) -> None:
    work = await lab.begun(1.0, artifact, "clean", 3)
    tasks = lab.hear("/cleaning/task", "std_msgs/msg/String")
    await work.done
    assert [each.data for each in tasks] == ["scrub tub bathroom", "mop floor bathroom"]


@made(ArtCleaning, on_graph=True)
async def test_a_household_without_subscribers_is_delayed_once(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "clean", 1)
    assert lab.clock.elapsed == pytest.approx(5.5)
    await lab.do(artifact, "clean", 1)
    assert lab.clock.elapsed == pytest.approx(8.0)
    assert len(warnings(lab)) == 1


class Topic:
    """A publisher as far as `Matching` knows it."""

    topic = "/report"

    def __init__(self) -> None:
        self.subscription_count = 0


def line_of(topic: Topic) -> Matching:
    def missed(name: str, seconds: float, again: bool) -> None:
        raise AssertionError(f"{name} was matched")

    return Matching(cast(Publisher, topic), 3.0, missed)


def test_a_later_message_does_not_overtake_one_that_waits() -> None:
    topic = Topic()
    matching = line_of(topic)
    first = matching.pauses()
    next(first)
    topic.subscription_count = 1
    assert not matching.exists()
    second = matching.pauses()
    assert next(second) == TURN
    assert list(first) == [SETTLING]
    assert list(second) == []
    assert matching.exists()


def test_a_message_that_is_suspended_while_it_waits_does_not_block_the_others() -> None:
    topic = Topic()
    matching = line_of(topic)
    suspended = matching.pauses()
    next(suspended)
    topic.subscription_count = 1
    assert sum(matching.pauses()) == pytest.approx(3.0)
    assert matching.exists()
    assert list(suspended) == [SETTLING]
    assert matching.exists()


async def test_the_first_command_waits_until_the_guard_has_found_the_base(
    lab: Lab, artifact: ArtifactId
) -> None:
    found = guarded_by(lab.backend).found
    found["guard"] = {}
    lab.record()
    motion = await lab.begun(5.0, artifact, "move", 4)
    assert driving(lab) == []
    found["guard"] = {"/cmd_vel": 1}
    await motion.done
    assert driving(lab)[0] == pytest.approx(5.0 + SETTLING, abs=0.06)
    await lab.do(artifact, "move", 4)
    assert warnings(lab) == []


async def test_a_guard_that_has_found_fewer_subscribers_than_the_robot_has_is_not_ready(
    lab: Lab, artifact: ArtifactId
) -> None:
    guarded_by(lab.backend).found["guard"] = {"/cmd_vel": 1}
    lab.record()
    lab.record()
    await lab.begun(1.0, artifact, "move", 4)
    assert driving(lab) == []


async def test_a_guard_that_never_finds_the_base_delays_one_command_and_is_reported_once(
    lab: Lab, artifact: ArtifactId
) -> None:
    guarded_by(lab.backend).found["guard"] = {"/other": 1}
    lab.record()
    await lab.do(artifact, "move", 4)
    assert driving(lab)[0] == pytest.approx(GUARD_TIMEOUT, abs=0.06)
    begun = lab.clock.elapsed
    await lab.do(artifact, "move", 4)
    assert lab.clock.elapsed - begun == pytest.approx(0.5, abs=0.06)
    [warning] = warnings(lab)
    assert "the guard has not found the subscriber of topic /cmd_vel after 10 s; publishing anyway" in warning
    assert "`jacaros ros show /cmd_vel`" in warning


@made(ArtCleaning, on_graph=True)
async def test_topics_that_drive_nothing_do_not_wait_for_a_guard(lab: Lab, artifact: ArtifactId) -> None:
    guarded_by(lab.backend).found["guard"] = {}
    lab.hear("/cleaning/task", "std_msgs/msg/String")
    await lab.do(artifact, "clean", 1)
    assert lab.clock.elapsed == pytest.approx(2.5)
