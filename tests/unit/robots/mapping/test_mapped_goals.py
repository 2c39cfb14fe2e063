"""Operations of mapped artifacts over actions, on the graph inside the process."""

import asyncio
from typing import Any

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Out
from jacaros.robots.mapping.artifact import MappedArtifact
from jacaros.robots.mapping.checking import check_mapping
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.mapping.interfaces import stored_interfaces
from jacaros.robots.ros.action import Abort, ActionPolicy, ServerGoal
from jacaros.robots.ros.parameter import DeclaredParameter

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


def count(more: str = "", after: str = "") -> type[MappedArtifact]:
    """The artifact that counts, with *more* of its operation, and other operations after it."""
    return mapped(COUNT.replace("MORE", more) + after)


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


DOCK = """
operations:
  dock:
    action: dock
    type: nav2_msgs/action/DockRobot
    MORE
"""


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ("", 'aborted(902,"no dock")'),
        ("code: num_retries", 'aborted(3,"no dock")'),
        ("code: {path: error_code, as: name}", 'aborted(dock_not_valid,"no dock")'),
        ("aborted: [num_retries, success]", 'aborted(902,"no dock",3,true)'),
    ],
)
async def test_an_aborted_goal_has_the_code_and_the_fields_of_the_mapping(
    lab: Lab, more: str, reason: str
) -> None:
    artifact = await lab.make(mapped(DOCK.replace("MORE", more)))

    async def execute(goal: ServerGoal) -> Any:
        raise Abort("no dock", {"error_code": 902, "num_retries": 3})

    lab.backend.action_server("dock", "nav2_msgs/action/DockRobot", execute)
    assert (await lab.call(artifact, "dock")).reason == reason


def test_a_code_or_field_that_the_result_does_not_have_is_an_error() -> None:
    with pytest.raises(MappingError, match="reason"):
        check_mapping(read_mapping(DOCK.replace("MORE", "code: reason")), stored_interfaces(()))


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


SET_BOOL = "type: std_srvs/srv/SetBool, "


def held(type_key: str = SET_BOOL) -> type[MappedArtifact]:
    """The artifact whose goals are paused and resumed by a service."""
    hold = f"  hold: {{service: hold, {type_key}timeout: 2, request: {{data: true}}}}\n"
    go_on = f"  go_on: {{service: hold, {type_key}timeout: 2, request: {{data: false}}}}\n"
    return count("suspend: {pause: hold, resume: go_on}", hold + go_on)


class Holding:
    """A server that counts, and that a service pauses."""

    def __init__(self, lab: Lab, agrees: bool = True) -> None:
        self.lab, self.agrees = lab, agrees
        self.asked: list[bool] = []
        self.held = False
        self.cancelled = 0
        lab.backend.action_server("count", "jacaros_interfaces/action/Count", self.execute)
        lab.backend.service("hold", "std_srvs/srv/SetBool", self.hold)

    def hold(self, request: Any) -> dict[str, Any]:
        self.asked.append(request.data)
        self.held = request.data and self.agrees
        return {"success": self.agrees, "message": "" if self.agrees else "no brakes"}

    async def execute(self, goal: ServerGoal) -> dict[str, Any]:
        done = 0
        try:
            while done < goal.request.target:
                await self.lab.clock.sleep(1)
                done += 0 if self.held else 1
        except asyncio.CancelledError:
            self.cancelled += 1
            raise
        return {"last": done}


@pytest.mark.parametrize("type_key", [SET_BOOL, ""], ids=["with type", "type found"])
async def test_a_goal_is_paused_and_resumed_by_services(lab: Lab, type_key: str) -> None:
    artifact = await lab.make(held(type_key))
    server, out = Holding(lab), Out()
    run = await lab.begun(1.5, artifact, "count", 4, 1, out)
    await run.pause(10)
    assert server.held
    await run.resumed()
    assert lab.clock.elapsed == pytest.approx(14)
    assert (server.asked, server.cancelled, out.value) == ([True, False], 0, 4)
    await lab.do(artifact, "hold")  # they are operations like any others
    assert server.held


@made(held())
async def test_a_goal_whose_server_refuses_to_pause_is_cancelled_and_sent_again(
    lab: Lab, artifact: ArtifactId
) -> None:
    server = Holding(lab, agrees=False)
    run = await lab.begun(0.5, artifact, "count", 2, 1, Out())
    await run.pause(5)
    assert server.cancelled == 1
    told = "could not be paused: OperationFailed: service /hold refused: no brakes"
    assert any(told in line for line in lab.logged)
    await run.resumed()
    assert run.ok


TOPIC_AND_PARAMETER = """\
  hold: {publish: hold, type: std_msgs/msg/Bool, fields: {data: true}}
  go_on: {set_parameter: speed, node: lab, value: 1}
"""


@made(count("suspend: {pause: hold, resume: go_on}", TOPIC_AND_PARAMETER))
async def test_a_goal_is_paused_by_a_topic_and_resumed_by_a_parameter(lab: Lab, artifact: ArtifactId) -> None:
    own = lab.backend.parameters()
    own.declare("speed", DeclaredParameter(0))
    held = lab.hear("hold", "std_msgs/msg/Bool")
    offer(lab)
    run = await lab.begun(0.5, artifact, "count", 3, 1, Out())
    await run.pause(1)
    assert [each.data for each in held] == [True]
    assert await own.get("speed") == 0
    await run.resumed()
    assert await own.get("speed") == 1


@made(held())
async def test_a_dropped_goal_leaves_no_paused_server_behind(lab: Lab, artifact: ArtifactId) -> None:
    server = Holding(lab)
    run = await lab.begun(0.5, artifact, "count", 4, 1, Out())
    await run.pause(1)
    await run.drop(1)
    assert (server.asked, server.held, server.cancelled) == ([True, False], False, 1)
