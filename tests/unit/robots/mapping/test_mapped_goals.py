"""Operations of mapped artifacts over actions, on the graph inside the process."""

import asyncio
from typing import Any

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Out
from jacaros.robots.mapping.artifact import MappedArtifact
from jacaros.robots.ros.action import Abort, ActionPolicy, ServerGoal

COUNT = """
operations:
  count:
    parameters: [n, period]
    action: count
    type: jacaros_interfaces/action/Count
    goal: {target: $n, period: $period}
    feedback: {at: [current]}
    outputs: [last]
    MORE
"""


def count(more: str = "") -> type[MappedArtifact]:
    """The artifact that counts, with *more* of its operation."""
    return mapped(COUNT.replace("MORE", more))


async def counted(lab: Lab, artifact: ArtifactId, *arguments: object) -> str:
    """Count; the reason why that failed."""
    return (await lab.call(artifact, "count", *arguments, Out())).reason


async def counting(goal: ServerGoal, lab: Lab) -> dict[str, Any]:
    """Count, one number each period."""
    for number in range(1, int(goal.request.target) + 1):
        await lab.clock.sleep(float(goal.request.period))
        goal.feedback(current=number)
        if number == 13:
            raise Abort("unlucky")
    return {"last": int(goal.request.target)}


def offer(lab: Lab, policy: ActionPolicy | None = None) -> list[str]:
    """Offer the action; the events of its goals."""
    events: list[str] = []

    async def execute(goal: ServerGoal) -> Any:
        events.append("begin")
        try:
            return await counting(goal, lab)
        except asyncio.CancelledError:
            events.append("cancelled")
            raise

    lab.backend.action_server("count", "jacaros_interfaces/action/Count", execute, policy or ActionPolicy())
    return events


pytestmark = made(count())


async def test_a_goal_with_feedback_and_result(lab: Lab, artifact: ArtifactId) -> None:
    offer(lab)
    watcher, out = lab.watch(artifact), Out()
    await lab.do(artifact, "count", 3, 1, out)
    await settle()
    assert out.value == 3
    assert watcher.values("at") == [(1,), (2,), (3,)]
    assert watcher.holds("at") == []


async def test_a_cancelled_operation_cancels_its_goal(lab: Lab, artifact: ArtifactId) -> None:
    events = offer(lab)
    watcher = lab.watch(artifact)
    run = await lab.begun(1.5, artifact, "count", 9, 1, Out())
    assert watcher.holds("at") == [(1,)]
    await run.drop(0.1)
    assert events == ["begin", "cancelled"]
    assert watcher.holds("at") == []


async def test_an_aborted_or_rejected_goal_fails_with_the_reason(lab: Lab, artifact: ArtifactId) -> None:
    offer(lab)
    assert await counted(lab, artifact, 20, 0.1) == 'aborted(0,"unlucky")'
    offer(lab, ActionPolicy(accept=lambda goal: "no"))
    assert await counted(lab, artifact, 20, 0.1) == "rejected"


@made(count("timeout: 3"))
async def test_a_goal_that_takes_too_long(lab: Lab, artifact: ArtifactId) -> None:
    events = offer(lab)
    assert await counted(lab, artifact, 20, 1) == "timeout(3)"
    await lab.sleep(0.1)
    assert events == ["begin", "cancelled"]


@made(count("success: {path: last, is: 3}"))
async def test_a_goal_without_success_fails(lab: Lab, artifact: ArtifactId) -> None:
    offer(lab)
    assert await counted(lab, artifact, 2, 1) == 'aborted(0,"")'
    await lab.do(artifact, "count", 3, 1, Out())


@pytest.mark.parametrize(
    ("more", "while_suspended", "afterwards"),
    [
        ("", ["begin", "cancelled"], ["begin", "cancelled", "begin"]),
        ("suspend: cancel", ["begin", "cancelled"], ["begin", "cancelled", "begin"]),
        ("suspend: go_on", ["begin"], ["begin"]),
    ],
)
async def test_a_suspended_goal_is_cancelled_and_sent_again_unless_it_goes_on(
    lab: Lab, more: str, while_suspended: list[str], afterwards: list[str]
) -> None:
    events, out = offer(lab), Out()
    run = await lab.begun(1.5, await lab.make(count(more)), "count", 3, 1, out)
    await run.pause(1)
    assert events == while_suspended
    await run.resumed()
    assert events == afterwards
    assert out.value == 3


BOUNDED = """
operations:
  say: {parameters: [t], publish: s, type: type_description_interfaces/msg/FieldType, fields: {nested_type_name: $t}}
  form: {parameters: [sizes], publish: f, type: shape_msgs/msg/SolidPrimitive, fields: {dimensions: $sizes}}
  buzz: {parameters: [strength], publish: b, type: sensor_msgs/msg/JoyFeedback, fields: {id: $strength}}
  mark: {parameters: [seconds], publish: m, type: visualization_msgs/msg/Marker, fields: {lifetime: $seconds}}
"""


@pytest.mark.parametrize(
    ("operation", "wrong", "field", "right"),
    [
        ("say", 256 * "x", "nested_type_name", 255 * "x"),
        ("form", [1, 2, 3, 4], "dimensions", [1, 2, 3]),
        ("buzz", 256, "id", 255),
        ("mark", -3, "lifetime", 3),
    ],
)
@made(mapped(BOUNDED))
async def test_a_value_outside_the_range_of_its_field_fails_the_operation(
    lab: Lab, artifact: ArtifactId, operation: str, wrong: object, field: str, right: object
) -> None:
    assert (await lab.call(artifact, operation, wrong)).reason == f'wrong_value("{field}")'
    await lab.do(artifact, operation, right)


@made(mapped("operations: {dock: {action: dock, type: nav2_msgs/action/DockRobot}}"))
async def test_an_aborted_goal_has_the_code_of_its_result(lab: Lab, artifact: ArtifactId) -> None:
    async def execute(goal: ServerGoal) -> Any:
        raise Abort("no dock", {"error_code": 902, "num_retries": 3})

    lab.backend.action_server("dock", "nav2_msgs/action/DockRobot", execute)
    assert (await lab.call(artifact, "dock")).reason == 'aborted(902,"no dock")'


@made(count("suspend: cancel"))
async def test_feedback_that_comes_while_a_dropped_goal_ends_shows_nothing(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    async def brake(goal: ServerGoal) -> Any:
        try:
            goal.feedback(current=1)
            await lab.clock.sleep(100)
        except asyncio.CancelledError:
            for number in range(2, 9):
                goal.feedback(current=number)
                await lab.clock.sleep(0.1)
            raise

    lab.backend.action_server("count", "jacaros_interfaces/action/Count", brake)
    run = await lab.begun(1, artifact, "count", 9, 1, Out())
    shown = [watcher.holds("at")]
    for change, seconds in (("pause", 2), ("resume", 1), ("cancel", 2)):
        getattr(run.execution, change)()
        await lab.sleep(seconds)
        shown.append(watcher.holds("at"))
    assert shown == [[(1,)], [], [(1,)], []]
    assert watcher.values("at") == [(1,), (1,)]
