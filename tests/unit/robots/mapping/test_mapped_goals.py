"""Operations of mapped artifacts over actions, on the graph inside the process."""

import asyncio
from typing import Any

import pytest
from mapped_lab import mapped, settle, with_mapped
from robot_lab import Lab

from jacaros.artifacts import ArtifactId, Out
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


async def test_a_goal_with_feedback_and_result(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "")))
    offer(lab)
    watcher, out = lab.watch(artifact), Out()
    await lab.do(artifact, "count", 3, 1, out)
    await settle()
    assert out.value == 3
    assert watcher.values("at") == [(1,), (2,), (3,)]
    assert watcher.holds("at") == []


async def test_a_cancelled_operation_cancels_its_goal(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "")))
    events = offer(lab)
    watcher = lab.watch(artifact)
    run = lab.begin(artifact, "count", 9, 1, Out())
    await lab.sleep(1.5)
    assert watcher.holds("at") == [(1,)]
    run.execution.cancel()
    await lab.sleep(0.1)
    assert events == ["begin", "cancelled"]
    assert watcher.holds("at") == []


async def test_an_aborted_goal_fails_with_the_reason(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "")))
    offer(lab)
    assert (await lab.call(artifact, "count", 20, 0.1, Out())).reason == 'aborted(0,"unlucky")'


async def test_a_goal_that_is_rejected(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "")))
    offer(lab, ActionPolicy(accept=lambda goal: "no"))
    assert (await lab.call(artifact, "count", 20, 0.1, Out())).reason == "rejected"


async def test_a_goal_that_takes_too_long(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "timeout: 3")))
    events = offer(lab)
    assert (await lab.call(artifact, "count", 20, 1, Out())).reason == "timeout(3)"
    await lab.sleep(0.1)
    assert events == ["begin", "cancelled"]


async def test_a_goal_without_success_fails(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "success: {path: last, is: 3}")))
    offer(lab)
    assert (await lab.call(artifact, "count", 2, 1, Out())).reason == 'aborted(0,"")'
    await lab.do(artifact, "count", 3, 1, Out())


async def test_a_suspended_goal_is_cancelled_and_sent_again(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "suspend: cancel")))
    events = offer(lab)
    out = Out()
    run = lab.begin(artifact, "count", 3, 1, out)
    await lab.sleep(1.5)
    run.execution.pause()
    await lab.sleep(1)
    assert events == ["begin", "cancelled"]
    run.execution.resume()
    await run.done
    assert events == ["begin", "cancelled", "begin"]
    assert out.value == 3


def test_a_goal_is_cancelled_while_suspended_by_default() -> None:
    async def suspended(lab: Lab, artifact: ArtifactId) -> list[str]:
        events = offer(lab)
        run = lab.begin(artifact, "count", 3, 1, Out())
        await lab.sleep(1.5)
        run.execution.pause()
        await lab.sleep(1)
        run.execution.resume()
        await run.done
        return events

    async def stops(lab: Lab, artifact: ArtifactId) -> None:
        assert await suspended(lab, artifact) == ["begin", "cancelled", "begin"]

    async def continues(lab: Lab, artifact: ArtifactId) -> None:
        assert await suspended(lab, artifact) == ["begin"]

    with_mapped(COUNT.replace("MORE", ""), stops)
    with_mapped(COUNT.replace("MORE", "suspend: go_on"), continues)


MARK = """
operations:
  mark: {parameters: [seconds], publish: m, type: visualization_msgs/msg/Marker, fields: {lifetime: $seconds}}
"""


BOUNDED = """
operations:
  say:
    parameters: [text]
    publish: s
    type: type_description_interfaces/msg/FieldType
    fields: {nested_type_name: $text}
  form: {parameters: [sizes], publish: f, type: shape_msgs/msg/SolidPrimitive, fields: {dimensions: $sizes}}
  buzz: {parameters: [strength], publish: b, type: sensor_msgs/msg/JoyFeedback, fields: {id: $strength}}
"""


async def test_a_value_outside_the_range_of_its_field_fails_the_operation(lab: Lab) -> None:
    artifact = await lab.make(mapped(BOUNDED))
    assert (await lab.call(artifact, "say", 256 * "x")).reason == 'wrong_value("nested_type_name")'
    assert (await lab.call(artifact, "form", [1, 2, 3, 4])).reason == 'wrong_value("dimensions")'
    assert (await lab.call(artifact, "buzz", 256)).reason == 'wrong_value("id")'
    await lab.do(artifact, "say", 255 * "x")
    await lab.do(artifact, "form", [1, 2, 3])
    await lab.do(artifact, "buzz", 255)


async def test_a_negative_duration_is_refused_before_anything_is_sent(lab: Lab) -> None:
    artifact = await lab.make(mapped(MARK))
    assert (await lab.call(artifact, "mark", -3)).reason == 'wrong_value("lifetime")'
    await lab.do(artifact, "mark", 3)


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


async def test_feedback_that_comes_while_a_dropped_goal_ends_shows_nothing(lab: Lab) -> None:
    artifact = await lab.make(mapped(COUNT.replace("MORE", "suspend: cancel")))

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
    watcher = lab.watch(artifact)
    run = lab.begin(artifact, "count", 9, 1, Out())
    await lab.sleep(1)
    assert watcher.holds("at") == [(1,)]
    run.execution.pause()
    await lab.sleep(2)
    assert watcher.holds("at") == []
    run.execution.resume()
    await lab.sleep(1)
    assert watcher.holds("at") == [(1,)]
    run.execution.cancel()
    await lab.sleep(2)
    assert watcher.holds("at") == []
    assert watcher.values("at") == [(1,), (1,)]


HOLD = """
  hold: {service: hold, TYPEtimeout: 2, request: {data: true}}
  go_on: {service: hold, TYPEtimeout: 2, request: {data: false}}
"""


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


@pytest.mark.parametrize("type_key", ["type: std_srvs/srv/SetBool, ", ""], ids=["with type", "type found"])
def test_a_goal_is_paused_and_resumed_by_services(type_key: str) -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        server = Holding(lab)
        out = Out()
        run = lab.begin(artifact, "count", 4, 1, out)
        await lab.sleep(1.5)
        run.execution.pause()
        await lab.sleep(10)
        assert server.held
        run.execution.resume()
        await run.done
        assert lab.clock.elapsed == pytest.approx(14)
        assert (server.asked, server.cancelled, out.value) == ([True, False], 0, 4)
        await lab.do(artifact, "hold")  # they are operations like any others
        assert server.held

    text = COUNT.replace("MORE", "suspend: {pause: hold, resume: go_on}") + HOLD.replace("TYPE", type_key)
    with_mapped(text, body)


def test_a_goal_whose_server_refuses_to_pause_is_cancelled_and_sent_again() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        server = Holding(lab, agrees=False)
        run = lab.begin(artifact, "count", 2, 1, Out())
        await lab.sleep(0.5)
        run.execution.pause()
        await lab.sleep(5)
        assert server.cancelled == 1
        assert any(
            "could not be paused: OperationFailed: service /hold refused: no brakes" in t for t in lab.logged
        )
        run.execution.resume()
        await run.done
        assert run.outcome is not None
        assert run.outcome.ok

    text = COUNT.replace("MORE", "suspend: {pause: hold, resume: go_on}") + HOLD.replace(
        "TYPE", "type: std_srvs/srv/SetBool, "
    )
    with_mapped(text, body)


async def test_a_goal_is_paused_by_a_topic_and_resumed_by_a_parameter(lab: Lab) -> None:
    text = (
        COUNT.replace("MORE", "suspend: {pause: hold, resume: go_on}")
        + """
  hold: {publish: hold, type: std_msgs/msg/Bool, fields: {data: true}}
  go_on: {set_parameter: speed, node: lab, value: 1}
"""
    )
    artifact = await lab.make(mapped(text))
    own = lab.backend.parameters()
    own.declare("speed", DeclaredParameter(0))
    held: list[bool] = []
    lab.backend.subscription("hold", "std_msgs/msg/Bool", lambda sample: held.append(sample.message.data))
    offer(lab)
    run = lab.begin(artifact, "count", 3, 1, Out())
    await lab.sleep(0.5)
    run.execution.pause()
    await lab.sleep(1)
    assert held == [True]
    assert await own.get("speed") == 0
    run.execution.resume()
    await run.done
    assert await own.get("speed") == 1


def test_a_dropped_goal_leaves_no_paused_server_behind() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        server = Holding(lab)
        run = lab.begin(artifact, "count", 4, 1, Out())
        await lab.sleep(0.5)
        run.execution.pause()
        await lab.sleep(1)
        run.execution.cancel()
        await lab.sleep(1)
        assert (server.asked, server.held, server.cancelled) == ([True, False], False, 1)

    text = COUNT.replace("MORE", "suspend: {pause: hold, resume: go_on}") + HOLD.replace(
        "TYPE", "type: std_srvs/srv/SetBool, "
    )
    with_mapped(text, body)
