"""Operations of mapped artifacts: publishing, services, actions, parameters, on the graph inside the process."""

import math
from collections.abc import Awaitable, Callable

import pytest
from mapped_lab import mapped, settle
from robot_lab import STANDSTILL, Lab, in_lab

from jacaros.artifacts import ArtifactId, Atom, Out, Structure
from jacaros.robots.artifacts.motion_claim import motions_of
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.ros.guarded import guarded_by
from jacaros.robots.ros.node import Capability
from jacaros.robots.ros.parameter import DeclaredParameter

DRIVE = """
operations:
  drive:
    parameters: [speed, turn, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed, angular.z: {value: $turn, unit: degrees}}
    rate: 10
    duration: $seconds
  go: {parameters: [speed], publish: cmd_vel, type: geometry_msgs/msg/Twist, fields: {linear.x: $speed}}
"""


# ---- publishing


async def test_publishing_once(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    await lab.do(artifact, "go", 0.5)
    await settle()
    assert lab.last_command == (0.5, 0.0)


async def test_publishing_for_a_while_ends_with_zero(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    await lab.do(artifact, "drive", 0.5, 180, 1)
    await settle()
    times = [time for time, *_ in lab.commands]
    assert times == [round(0.1 * n, 6) for n in range(11)]
    assert lab.commands[0][1:] == pytest.approx((0.5, 3.141592653589793))
    assert lab.last_command == STANDSTILL


async def test_a_robot_stops_when_its_operation_is_cancelled(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    run = lab.begin(artifact, "drive", 0.5, 0, 10)
    await lab.sleep(1)
    run.execution.cancel()
    await settle()
    assert lab.last_command == STANDSTILL


async def test_publishing_for_a_while_fails_when_the_process_was_frozen_meanwhile(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    run = lab.begin(artifact, "drive", 0.5, 0, 10)
    await lab.sleep(1)
    lab.clock.busy(2000 * lab.clock.CYCLES_PER_MILLISECOND)
    await run.done
    await settle()
    assert run.reason == "interrupted(3)"
    assert lab.last_command == STANDSTILL


async def test_publishing_for_a_while_fails_when_a_guard_has_stopped_the_robot(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    run = lab.begin(artifact, "drive", 0.5, 0, 10)
    await lab.sleep(1)
    guarded_by(lab.backend).interrupt()
    await run.done
    await settle()
    assert run.reason == "interrupted(1)"
    assert lab.last_command == STANDSTILL


async def test_a_pause_stops_the_robot_and_does_not_count(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    run = lab.begin(artifact, "drive", 0.5, 0, 2)
    await lab.sleep(1.05)
    run.execution.pause()
    await settle()
    assert lab.last_command == STANDSTILL
    count = len(lab.commands)
    await lab.sleep(5)
    assert len(lab.commands) == count
    run.execution.resume()
    await run.done
    assert lab.clock.elapsed == pytest.approx(7.0)
    assert lab.last_command == STANDSTILL


async def test_one_motion_waits_for_another(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    first = lab.begin(artifact, "drive", 0.5, 0, 1)
    second = lab.begin(artifact, "drive", -0.5, 0, 1)
    await first.done
    await second.done
    assert lab.clock.elapsed == pytest.approx(2.0)
    signs = [speed for _, speed, _ in lab.commands if speed]
    assert signs == sorted(signs, reverse=True)


async def test_a_motion_that_is_suspended_while_it_waits_does_not_stop_the_one_that_drives(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    first = lab.begin(artifact, "drive", 0.5, 0, 2)
    second = lab.begin(artifact, "drive", -0.5, 0, 1)
    await lab.sleep(1.05)
    second.execution.pause()
    await lab.sleep(0.5)
    assert STANDSTILL not in [command for _, *command in lab.commands]
    assert all(speed == 0.5 for _, speed, _ in lab.commands)
    second.execution.cancel()
    await first.done
    await settle()
    assert lab.commands[-1][0] == pytest.approx(2)
    assert lab.last_command == STANDSTILL


async def test_a_robot_that_was_sent_a_velocity_stops_when_the_artifact_goes(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    await lab.do(artifact, "go", 0.5)
    lab.workspace.dispose_artifact(artifact)
    await settle()
    assert lab.last_command == STANDSTILL


async def test_a_robot_that_was_sent_a_velocity_stops_when_the_process_ends(lab: Lab) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    await lab.do(artifact, "go", 0.5)
    lab.backend.lifetime.stop()  # type: ignore[attr-defined]  # what a signal of the system does
    await settle()
    assert lab.last_command == STANDSTILL


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("fast",), 'wrong_value("linear.x")'),
        ((float("nan"),), 'wrong_value("linear.x")'),
        ((float("inf"),), 'wrong_value("velocity")'),
    ],
)
async def test_a_value_that_does_not_fit_fails_and_sends_nothing(
    lab: Lab, arguments: tuple[object, ...], reason: str
) -> None:
    artifact = await lab.make(mapped(DRIVE))
    lab.record()
    assert (await lab.call(artifact, "go", *arguments)).reason == reason
    await settle()
    assert lab.commands == []


async def test_a_missing_type_is_taken_from_the_subscriber(lab: Lab) -> None:
    text = "operations: {go: {parameters: [v], publish: cmd_vel, fields: {linear.x: $v}}}"
    artifact = await lab.make(mapped(text))
    failed = await lab.call(artifact, "go", 1)
    assert failed.reason == 'type_unknown("/cmd_vel")'
    assert failed.outcome is not None
    assert "write its type in m.yaml:1" in (failed.outcome.message or "")
    lab.record()
    await lab.do(artifact, "go", 1)
    await settle()
    assert lab.last_command == (1.0, 0.0)


async def test_a_last_message_of_ones_own(lab: Lab) -> None:
    text = """
operations:
  horn:
    publish: horn
    type: std_msgs/msg/Bool
    fields: {data: true}
    at_end: {data: false}
    rate: 4
    duration: 1
"""
    artifact = await lab.make(mapped(text))
    heard: list[bool] = []
    lab.backend.subscription("horn", "std_msgs/msg/Bool", lambda sample: heard.append(sample.message.data))
    await lab.do(artifact, "horn")
    await settle()
    assert heard == [True] * 4 + [False]


# ---- waiting for a subscriber

SAY = """
operations:
  say: {parameters: [text], publish: speech, type: std_msgs/msg/String, fields: {data: $text}}
  must_say:
    parameters: [text]
    publish: speech
    type: std_msgs/msg/String
    fields: {data: $text}
    match_timeout: 1
    unmatched: fail
"""


def on_a_graph(text: str, body: Callable[[Lab, ArtifactId], Awaitable[None]], *arguments: object) -> Lab:
    """Run *body* where a subscription that a test makes later is like one that is matched late."""

    async def in_it(lab: Lab) -> None:
        lab.backend.capabilities |= {Capability.DISCOVERY}  # type: ignore[misc]  # the graph in memory has none
        await body(lab, await lab.make(mapped(text), *arguments))

    return in_lab(in_it, world=None)


def test_the_first_message_waits_until_a_subscriber_is_matched() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        said = lab.begin(artifact, "say", "first")
        await lab.sleep(1.0)
        heard: list[str] = []
        lab.backend.subscription(
            "speech", "std_msgs/msg/String", lambda sample: heard.append(sample.message.data)
        )
        await said.done
        began = lab.clock.elapsed
        await lab.do(artifact, "say", "second")
        await settle()
        assert (heard, lab.clock.elapsed) == (["first", "second"], began)

    on_a_graph(SAY, body)


def test_a_message_without_subscribers_is_delayed_and_warned_about_once() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        await lab.do(artifact, "say", "first")
        assert lab.clock.elapsed == pytest.approx(3.0)
        await lab.do(artifact, "say", "second")
        assert lab.clock.elapsed == pytest.approx(3.0)
        assert len(lab.logged) == 1
        assert "m.yaml:3:38: no subscriber on topic /speech after 3 s; publishing anyway" in lab.logged[0]

    on_a_graph(SAY, body)


def test_a_message_without_subscribers_fails_if_the_mapping_requires_it() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        for _ in range(2):
            assert (await lab.call(artifact, "must_say", "first")).reason == 'unmatched("/speech")'
        assert lab.clock.elapsed == pytest.approx(1.0)
        assert lab.logged == []

    on_a_graph(SAY, body)


def test_settings_missing_in_the_mapping_are_options_of_the_artifact() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        assert (await lab.call(artifact, "say", "first")).reason == 'unmatched("/speech")'
        assert lab.clock.elapsed == pytest.approx(0.5)

    on_a_graph(SAY, body, Structure("match_timeout", (0.5,)), Structure("unmatched", (Atom("fail"),)))


def test_velocities_wait_until_the_base_is_matched() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        run = lab.begin(artifact, "drive", 0.5, 0, 1)
        await lab.sleep(1.0)
        lab.record()
        await run.done
        await settle()
        assert len(lab.commands) == 11
        assert lab.last_command == STANDSTILL

    on_a_graph(DRIVE, body)


def test_zero_velocity_never_waits() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        await lab.do(artifact, "go", 0)
        assert lab.clock.elapsed == 0.0
        await lab.do(artifact, "drive", 0, 0, 1)
        assert lab.clock.elapsed == pytest.approx(1.0)

    on_a_graph(DRIVE, body)


def test_a_velocity_that_waits_for_its_base_is_not_sent_after_a_stop() -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        run = lab.begin(artifact, "go", 0.5)
        await lab.sleep(0.5)
        await lab.do(artifact, "go", 0)
        assert lab.clock.elapsed == pytest.approx(0.5)
        lab.record()
        await run.done
        await settle()
        assert run.reason == "aborted(0)"
        assert lab.commands == []

    on_a_graph(DRIVE, body)


@pytest.mark.parametrize("end", ["drop", "suspend", "abort"])
def test_a_velocity_that_waits_for_its_base_is_not_sent_after(end: str) -> None:
    async def body(lab: Lab, artifact: ArtifactId) -> None:
        runs = [lab.begin(artifact, "drive", 0.5, 0, 1), lab.begin(artifact, "go", 0.5)]
        await lab.sleep(0.5)
        for run in runs:
            if end == "drop":
                run.execution.cancel()
            elif end == "suspend":
                run.execution.pause()
        if end == "abort":
            motions_of(lab.backend, "").abort()
        lab.record()
        await lab.sleep(5.0)
        assert all(tuple(command) == STANDSTILL for _, *command in lab.commands)

    on_a_graph(DRIVE, body)


# ---- services

ADD = """
operations:
  add: {parameters: [x, y], service: add, type: example_interfaces/srv/AddTwoInts, request: {a: $x, b: $y}, outputs: [sum]}
"""


async def test_a_service_with_request_and_output(lab: Lab) -> None:
    artifact = await lab.make(mapped(ADD), "r1")
    lab.backend.service("/r1/add", "example_interfaces/srv/AddTwoInts", lambda r: {"sum": r.a + r.b})
    out = Out()
    await lab.do(artifact, "add", 2, 3, out)
    assert out.value == 5


async def test_a_service_that_is_not_there(lab: Lab) -> None:
    artifact = await lab.make(mapped(ADD))
    assert (await lab.call(artifact, "add", 2, 3, Out())).reason == "service_unavailable(add)"
    assert lab.clock.elapsed == pytest.approx(10.0)


async def test_a_request_that_does_not_fit(lab: Lab) -> None:
    artifact = await lab.make(mapped(ADD))
    assert (await lab.call(artifact, "add", 2.5, 3, Out())).reason == 'wrong_value("a")'


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ("", 'service_refused(s,"not now")'),
        (", success: none", "None"),
        (", success: success", 'service_refused(s,"not now")'),
        (", success: {path: message, is: not now}", "None"),
    ],
)
async def test_a_service_that_refuses(lab: Lab, more: str, reason: str) -> None:
    text = f"operations: {{go: {{service: s, type: std_srvs/srv/Trigger{more}}}}}"
    artifact = await lab.make(mapped(text))
    lab.backend.service("s", "std_srvs/srv/Trigger", lambda _: {"success": False, "message": "not now"})
    assert (await lab.call(artifact, "go")).reason == reason


async def test_the_type_of_a_service_is_found(lab: Lab) -> None:
    text = "operations: {go: {service: s, outputs: [message]}}"
    artifact = await lab.make(mapped(text))
    assert (await lab.call(artifact, "go", Out())).reason == 'type_unknown("/s")'
    lab.backend.service("s", "std_srvs/srv/Trigger", lambda _: {"success": True, "message": "done"})
    out = Out()
    await lab.do(artifact, "go", out)
    assert out.value == "done"


async def test_frames_in_goals_get_the_prefix_of_the_robot(lab: Lab) -> None:
    text = """
operations:
  look:
    publish: p
    type: geometry_msgs/msg/PointStamped
    fields: {header.frame_id: base_link, header.stamp: now}
  far: {publish: p, type: geometry_msgs/msg/PointStamped, fields: {header.frame_id: map}}
"""
    artifact = await lab.make(mapped(text), "r1")
    heard: list[str] = []
    lab.backend.subscription(
        "/r1/p",
        "geometry_msgs/msg/PointStamped",
        lambda sample: heard.append(sample.message.header.frame_id),
    )
    await lab.do(artifact, "look")
    await lab.do(artifact, "far")
    await settle()
    assert heard == ["r1/base_link", "map"]


# ---- parameters, and properties on demand

PARAMETERS = """
operations:
  limit: {parameters: [v], set_parameter: speed, node: lab, value: {value: $v, unit: centimetres}}
  limited: {get_parameter: speed, node: lab, outputs: [v]}
  set: {parameters: [v], set_parameter: speed, node: lab, value: $v}
  lost: {get_parameter: spede, node: lab}
"""


async def test_parameters_of_nodes_are_set_and_given(lab: Lab) -> None:
    artifact = await lab.make(mapped(PARAMETERS))
    own = lab.backend.parameters()
    own.declare("speed", DeclaredParameter(0.5, maximum=2.0))
    await lab.do(artifact, "limit", 75)
    assert await own.get("speed") == 0.75
    await lab.do(artifact, "set", 1)
    out = Out()
    await lab.do(artifact, "limited", out)
    assert out.value == 1.0
    assert (await lab.call(artifact, "set", 3)).reason == "parameter_refused(speed)"
    assert (await lab.call(artifact, "lost", Out())).reason == "parameter_unknown(spede)"


async def test_a_parameter_that_is_not_a_number_has_no_unit(lab: Lab) -> None:
    text = """
operations:
  turn: {get_parameter: turn, node: lab, outputs: [{path: ., unit: degrees, round: 0, names: {none: nowhere}}]}
"""
    artifact = await lab.make(mapped(text))
    own, out = lab.backend.parameters(), Out()
    own.declare("turn", DeclaredParameter("left"))
    failed = await lab.call(artifact, "turn", out)
    assert failed.reason == 'wrong_value("turn")'
    assert failed.outcome is not None
    assert 'parameter `turn`: expected a number, found "left": leave out its unit' in failed.outcome.message
    await own.set("turn", "none")
    await lab.do(artifact, "turn", out)
    assert out.value == Atom("nowhere")
    own.withdraw("turn")
    own.declare("turn", DeclaredParameter([0.0, math.pi]))
    await lab.do(artifact, "turn", out)
    assert out.value == [0, 180]


@pytest.mark.world("empty")
async def test_read_gives_the_newest_values(lab: Lab) -> None:
    text = """
properties:
  pose: {topic: odom, fields: [pose.pose.position.x, {path: pose.pose.orientation, as: yaw, unit: degrees}]}
operations:
  where: {read: pose}
"""
    artifact = await lab.make(mapped(text))
    x, yaw = Out(), Out()
    await lab.do(artifact, "where", x, yaw)
    assert (x.value, yaw.value) == (0.0, 0.0)


async def test_operations_have_their_arities_and_names_of_parameters(lab: Lab) -> None:
    artifact = await lab.make(mapped(ADD))
    interface = lab.workspace.interface(artifact)
    assert interface.operations.keys() == ["add/3"]
    found = interface.operations.find("add", 3)
    assert found is not None
    assert str(found.signature) == "x: any value, y: any value, -sum"
    assert (await lab.call(artifact, "add", 1)).reason != "None"


async def test_a_mismatched_term_is_reported_in_the_notation_of_agents(lab: Lab) -> None:
    text = "operations: {say: {parameters: [a], publish: s, type: std_msgs/msg/String, fields: {data: $a}}}"
    artifact = await lab.make(mapped(text))
    run = await lab.call(artifact, "say", Structure("f", (Atom("x"), "y")))
    assert run.outcome is not None
    assert run.outcome.message == 'std_msgs/msg/String: field data is string, but f(x,"y") is given'


async def test_operations_of_one_name_with_other_numbers_of_arguments(lab: Lab) -> None:
    text = """
operations:
  say:
    - {publish: s, type: std_msgs/msg/String, fields: {data: nothing}}
    - {parameters: [a], publish: s, type: std_msgs/msg/String, fields: {data: $a}}
    - {parameters: [a], service: ask, type: std_srvs/srv/SetBool, request: {data: $a}, outputs: [message]}
"""
    artifact = await lab.make(mapped(text))
    heard: list[str] = []
    lab.backend.subscription("s", "std_msgs/msg/String", lambda sample: heard.append(sample.message.data))
    lab.backend.service("ask", "std_srvs/srv/SetBool", lambda request: {"success": True, "message": "ok"})
    await lab.do(artifact, "say")
    await lab.do(artifact, "say", "word")
    answer = Out()
    await lab.do(artifact, "say", True, answer)
    await settle()
    assert (heard, answer.value) == (["nothing", "word"], "ok")


def test_operations_of_one_name_with_as_many_arguments_are_refused() -> None:
    text = (
        "operations:\n  say:\n    - {parameters: [a], publish: s}\n    - {service: t, outputs: [message]}\n"
    )
    with pytest.raises(
        MappingError, match=r"4:7: error: duplicate operation `say` with 1 arguments; the first is on line 3"
    ):
        read_mapping(text, "m.yaml")
