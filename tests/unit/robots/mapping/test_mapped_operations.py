"""Operations of mapped artifacts: publishing, services, actions, parameters, on the graph inside the process."""

from collections.abc import Callable

import pytest
from mapped_lab import mapped, settle
from robot_lab import STANDSTILL, Lab, Run, made

from jacaros.artifacts import ArtifactId, Atom, Out, Structure
from jacaros.robots.artifacts.driving import motions_of
from jacaros.robots.mapping.file import MappingError, read_mapping
from jacaros.robots.ros.guarded import guarded_by
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


pytestmark = made(mapped(DRIVE), recorded=True)


async def test_publishing_once(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "go", 0.5)
    await settle()
    assert lab.last_command == (0.5, 0.0)


async def test_publishing_for_a_while_ends_with_zero(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "drive", 0.5, 180, 1)
    await settle()
    assert [time for time, *_ in lab.commands] == [round(0.1 * n, 6) for n in range(11)]
    assert lab.commands[0][1:] == pytest.approx((0.5, 3.141592653589793))
    assert lab.last_command == STANDSTILL


def freeze(lab: Lab, run: Run) -> None:
    lab.clock.busy(2000 * lab.clock.CYCLES_PER_MILLISECOND)


def trip_guard(lab: Lab, run: Run) -> None:
    guarded_by(lab.backend).interrupt()


@pytest.mark.parametrize(
    ("interrupt", "reason"),
    [
        (lambda lab, run: run.execution.cancel(), None),
        (freeze, "interrupted(3)"),
        (trip_guard, "interrupted(1)"),
    ],
    ids=["dropped", "frozen", "stopped by a guard"],
)
async def test_a_robot_stops_when_its_operation_is_interrupted(
    lab: Lab, artifact: ArtifactId, interrupt: Callable[[Lab, Run], None], reason: str | None
) -> None:
    run = await lab.begun(1, artifact, "drive", 0.5, 0, 10)
    interrupt(lab, run)
    if reason is not None:
        await run.done
        assert run.reason == reason
    await settle()
    assert lab.last_command == STANDSTILL


async def test_a_pause_stops_the_robot_and_does_not_count(lab: Lab, artifact: ArtifactId) -> None:
    run = await lab.begun(1.05, artifact, "drive", 0.5, 0, 2)
    run.execution.pause()
    await settle()
    assert lab.last_command == STANDSTILL
    count = len(lab.commands)
    await lab.sleep(5)
    assert len(lab.commands) == count
    await run.resumed()
    assert lab.clock.elapsed == pytest.approx(7.0)
    assert lab.last_command == STANDSTILL


async def test_one_motion_waits_for_another(lab: Lab, artifact: ArtifactId) -> None:
    for run in [lab.begin(artifact, "drive", speed, 0, 1) for speed in (0.5, -0.5)]:
        await run.done
    assert lab.clock.elapsed == pytest.approx(2.0)
    signs = [speed for _, speed, _ in lab.commands if speed]
    assert signs == sorted(signs, reverse=True)


async def test_a_motion_that_is_suspended_while_it_waits_does_not_stop_the_one_that_drives(
    lab: Lab, artifact: ArtifactId
) -> None:
    first = lab.begin(artifact, "drive", 0.5, 0, 2)
    second = await lab.begun(1.05, artifact, "drive", -0.5, 0, 1)
    await second.pause(0.5)
    assert STANDSTILL not in [command for _, *command in lab.commands]
    assert all(speed == 0.5 for _, speed, _ in lab.commands)
    second.execution.cancel()
    await first.done
    await settle()
    assert lab.commands[-1][0] == pytest.approx(2)
    assert lab.last_command == STANDSTILL


@pytest.mark.parametrize("end", ["artifact", "process"])
async def test_a_robot_that_was_sent_a_velocity_stops_when_the_artifact_or_the_process_ends(
    lab: Lab, artifact: ArtifactId, end: str
) -> None:
    await lab.do(artifact, "go", 0.5)
    if end == "artifact":
        lab.workspace.dispose_artifact(artifact)
    else:
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
    lab: Lab, artifact: ArtifactId, arguments: tuple[object, ...], reason: str
) -> None:
    assert (await lab.call(artifact, "go", *arguments)).reason == reason
    await settle()
    assert lab.commands == []


@made(mapped("operations: {go: {parameters: [v], publish: cmd_vel, fields: {linear.x: $v}}}"))
async def test_a_missing_type_is_taken_from_the_subscriber(lab: Lab, artifact: ArtifactId) -> None:
    failed = await lab.call(artifact, "go", 1)
    assert failed.reason == 'type_unknown("/cmd_vel")'
    assert "write its type in m.yaml:1" in failed.message
    lab.record()
    await lab.do(artifact, "go", 1)
    await settle()
    assert lab.last_command == (1.0, 0.0)


# ---- waiting for a subscriber

SAY = """
operations:
  say: {parameters: [text], publish: speech, type: std_msgs/msg/String, fields: {data: $text}}
"""


@made(mapped(SAY), on_graph=True)
async def test_the_first_message_waits_until_a_subscriber_is_matched(lab: Lab, artifact: ArtifactId) -> None:
    said = await lab.begun(1.0, artifact, "say", "first")
    heard = lab.hear("speech", "std_msgs/msg/String")
    await said.done
    began = lab.clock.elapsed
    await lab.do(artifact, "say", "second")
    await settle()
    assert ([each.data for each in heard], lab.clock.elapsed) == (["first", "second"], began)


@made(mapped(SAY), on_graph=True)
async def test_a_message_without_subscribers_is_delayed_and_warned_about_once(
    lab: Lab, artifact: ArtifactId
) -> None:
    for text in ("first", "second"):
        await lab.do(artifact, "say", text)
        assert lab.clock.elapsed == pytest.approx(3.0)
    assert len(lab.logged) == 1
    assert "m.yaml:3:38: no subscriber on topic /speech after 3 s; publishing anyway" in lab.logged[0]


@made(mapped(SAY), Structure("match_timeout", (0.5,)), Structure("unmatched", (Atom("fail"),)), on_graph=True)
async def test_a_message_without_subscribers_fails_if_an_option_requires_it(
    lab: Lab, artifact: ArtifactId
) -> None:
    for _ in range(2):
        assert (await lab.call(artifact, "say", "first")).reason == 'unmatched("/speech")'
    assert lab.clock.elapsed == pytest.approx(0.5)
    assert lab.logged == []


@made(mapped(DRIVE), on_graph=True)
async def test_velocities_wait_until_the_base_is_matched(lab: Lab, artifact: ArtifactId) -> None:
    run = await lab.begun(1.0, artifact, "drive", 0.5, 0, 1)
    lab.record()
    await run.done
    await settle()
    assert len(lab.commands) == 11
    assert lab.last_command == STANDSTILL


@made(mapped(DRIVE), on_graph=True)
async def test_zero_velocity_never_waits(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "go", 0)
    assert lab.clock.elapsed == 0.0
    await lab.do(artifact, "drive", 0, 0, 1)
    assert lab.clock.elapsed == pytest.approx(1.0)


@made(mapped(DRIVE), on_graph=True)
async def test_a_velocity_that_waits_for_its_base_is_not_sent_after_a_stop(
    lab: Lab, artifact: ArtifactId
) -> None:
    run = await lab.begun(0.5, artifact, "go", 0.5)
    await lab.do(artifact, "go", 0)
    assert lab.clock.elapsed == pytest.approx(0.5)
    lab.record()
    await run.done
    await settle()
    assert run.reason == "aborted(0)"
    assert lab.commands == []


@pytest.mark.parametrize("end", ["cancel", "pause", "abort"])
@made(mapped(DRIVE), on_graph=True)
async def test_a_velocity_that_waits_for_its_base_is_not_sent_after(
    lab: Lab, artifact: ArtifactId, end: str
) -> None:
    runs = [lab.begin(artifact, "drive", 0.5, 0, 1), await lab.begun(0.5, artifact, "go", 0.5)]
    for run in runs:
        if end != "abort":
            getattr(run.execution, end)()
    if end == "abort":
        motions_of(lab.backend, "").abort()
    lab.record()
    await lab.sleep(5.0)
    assert all(tuple(command) == STANDSTILL for _, *command in lab.commands)


# ---- services

ADD = """
operations:
  add: {parameters: [x, y], service: add, type: example_interfaces/srv/AddTwoInts, request: {a: $x, b: $y}, outputs: [sum]}
"""


@made(mapped(ADD), "r1")
async def test_a_service_with_request_and_output(lab: Lab, artifact: ArtifactId) -> None:
    lab.backend.service("/r1/add", "example_interfaces/srv/AddTwoInts", lambda r: {"sum": r.a + r.b})
    out = Out()
    await lab.do(artifact, "add", 2, 3, out)
    assert out.value == 5


@made(mapped(ADD))
async def test_a_request_that_does_not_fit_or_has_no_server(lab: Lab, artifact: ArtifactId) -> None:
    assert (await lab.call(artifact, "add", 2.5, 3, Out())).reason == 'wrong_value("a")'
    assert (await lab.call(artifact, "add", 2, 3, Out())).reason == "service_unavailable(add)"
    assert lab.clock.elapsed == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ("", 'service_refused(s,"not now")'),
        (", success: none", "None"),
        (", success: success", 'service_refused(s,"not now")'),
        (", success: {path: message, is: not now}", "None"),
        (", success: {path: success, else: no_brakes}", "no_brakes"),
    ],
)
async def test_a_service_that_refuses(lab: Lab, more: str, reason: str) -> None:
    text = f"operations: {{go: {{service: s, type: std_srvs/srv/Trigger{more}}}}}"
    artifact = await lab.make(mapped(text))
    lab.backend.service("s", "std_srvs/srv/Trigger", lambda _: {"success": False, "message": "not now"})
    assert (await lab.call(artifact, "go")).reason == reason


@made(mapped("operations: {go: {service: s, outputs: [message]}}"))
async def test_the_type_of_a_service_is_found(lab: Lab, artifact: ArtifactId) -> None:
    assert (await lab.call(artifact, "go", Out())).reason == 'type_unknown("/s")'
    lab.backend.service("s", "std_srvs/srv/Trigger", lambda _: {"success": True, "message": "done"})
    out = Out()
    await lab.do(artifact, "go", out)
    assert out.value == "done"


LOOK = """
operations:
  look: {publish: p, type: geometry_msgs/msg/PointStamped, fields: {header.frame_id: base_link, header.stamp: now}}
  far: {publish: p, type: geometry_msgs/msg/PointStamped, fields: {header.frame_id: map}}
"""


@made(mapped(LOOK), "r1")
async def test_frames_in_goals_get_the_prefix_of_the_robot(lab: Lab, artifact: ArtifactId) -> None:
    heard = lab.hear("/r1/p", "geometry_msgs/msg/PointStamped")
    await lab.do(artifact, "look")
    await lab.do(artifact, "far")
    await settle()
    assert [each.header.frame_id for each in heard] == ["r1/base_link", "map"]


# ---- parameters, and properties on demand

PARAMETERS = """
operations:
  limit: {parameters: [v], set_parameter: speed, node: lab, value: {value: $v, unit: centimetres}}
  set: {parameters: [v], set_parameter: speed, node: lab, value: $v}
  lose: {set_parameter: spede, node: lab, value: 1}
"""


@made(mapped(PARAMETERS))
async def test_parameters_of_nodes_are_set(lab: Lab, artifact: ArtifactId) -> None:
    own = lab.backend.parameters()
    own.declare("speed", DeclaredParameter(0.5, maximum=2.0))
    await lab.do(artifact, "limit", 75)
    assert await own.get("speed") == 0.75
    await lab.do(artifact, "set", 1)
    assert await own.get("speed") == 1.0
    assert (await lab.call(artifact, "set", 3)).reason == "parameter_refused(speed)"
    assert (await lab.call(artifact, "lose")).reason == "parameter_unknown(spede)"


async def test_operations_have_their_arities_and_names_of_parameters(lab: Lab) -> None:
    artifact = await lab.make(mapped(ADD))
    interface = lab.workspace.interface(artifact)
    assert interface.operations.keys() == ["add/3"]
    found = interface.operations.find("add", 3)
    assert found is not None
    assert str(found.signature) == "x: any value, y: any value, -sum"
    assert (await lab.call(artifact, "add", 1)).reason != "None"


OVERLOADED = """
operations:
  say:
    - {publish: s, type: std_msgs/msg/String, fields: {data: nothing}}
    - {parameters: [a], publish: s, type: std_msgs/msg/String, fields: {data: $a}}
    - {parameters: [a], service: ask, type: std_srvs/srv/SetBool, request: {data: $a}, outputs: [message]}
"""


@made(mapped(OVERLOADED))
async def test_operations_of_one_name_with_other_numbers_of_arguments(lab: Lab, artifact: ArtifactId) -> None:
    heard = lab.hear("s", "std_msgs/msg/String")
    lab.backend.service("ask", "std_srvs/srv/SetBool", lambda request: {"success": True, "message": "ok"})
    answer = Out()
    for arguments in ((), ("word",), (True, answer)):
        await lab.do(artifact, "say", *arguments)
    await settle()
    assert ([each.data for each in heard], answer.value) == (["nothing", "word"], "ok")
    run = await lab.call(artifact, "say", Structure("f", (Atom("x"), "y")))
    assert run.message == 'std_msgs/msg/String: field data is string, but f(x,"y") is given'


def test_operations_of_one_name_with_as_many_arguments_are_refused() -> None:
    text = (
        "operations:\n  say:\n    - {parameters: [a], publish: s}\n    - {service: t, outputs: [message]}\n"
    )
    with pytest.raises(
        MappingError, match=r"4:7: error: duplicate operation `say` with 1 arguments; the first is on line 3"
    ):
        read_mapping(text, "m.yaml")
