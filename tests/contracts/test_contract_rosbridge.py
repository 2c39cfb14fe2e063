"""What is particular to the rosbridge backend: the link comes and goes, and the server says little."""

import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bridges import BehindBridge, BridgeServer, heard, talking

from jacaros.robots.ros.errors import (
    CallFailed,
    CallTimedOut,
    CapabilityMissing,
    ParameterUnknown,
    ServerLost,
    UnknownInterface,
)
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import WallClock, run

pytestmark = pytest.mark.rosbridge

STRING = "std_msgs/msg/String"


def test_the_server_tells_which_ros_it_is(bridged: BehindBridge) -> None:
    client = bridged.peer("client")
    assert client.ros_version() == int(bridged.kind[-1])


def test_a_restarted_server_is_found_again_and_gets_everything_again(bridged: BehindBridge) -> None:
    robot, client = talking(bridged)
    client.serve("/sum")
    client.advertise("/map", STRING, durability="transient_local", depth=1)
    client.publish("/map", {"data": "the map"})
    bridged.server.do("stop")
    bridged.wait_until(lambda: client.connected() is False, "the loss is noticed")
    assert any("rosbridge server at ws://127.0.0.1" in line for line in client.log())
    client.publish("/to_robot", {"data": "lost"})
    assert any("topic /to_robot: messages are lost" in line for line in client.log())
    bridged.server.do("start")
    bridged.wait_until(client.connected, "the connection is there again")
    assert client.connection() == [True, False, True]
    bridged.wait_until(lambda: client.publisher_count("/to_client") == 1, "the topic is subscribed again")
    robot.publish("/to_client", {"data": "again"})
    bridged.wait_until(heard(client, "/to_client", "again"), "messages come again")
    client.publish("/to_robot", {"data": "here again"})
    bridged.wait_until(heard(robot, "/to_robot", "here again"), "messages go again")
    assert {"data": "lost"} not in robot.received("/to_robot")
    assert robot.call("/sum", {"a": 1, "b": 2}, timeout=60) == {"sum": 3}
    robot.subscribe("/map", STRING, durability="transient_local", depth=1)
    bridged.wait_until(heard(robot, "/map", "the map"), "the latched message is there again")


def test_a_server_that_starts_later_is_awaited(robot_of_ros2: BehindBridge) -> None:
    graph, first = robot_of_ros2, robot_of_ros2.server
    first.kill()
    client = graph.peer("client")
    assert client.connected() is False
    client.subscribe("/a", STRING)
    client.advertise("/a", STRING)
    graph.wait_until(
        lambda: any("rosbridge_websocket_launch.xml" in line for line in client.log()), "the help is logged"
    )
    graph.server = BridgeServer("ros2", port=first.port)
    graph.wait_until(client.connected, "the server is found")
    graph.wait_until(lambda: client.subscription_count("/a") == 1, "the topic is joined")
    client.publish("/a", {"data": "x"})
    graph.wait_until(heard(client, "/a", "x"), "the message arrives")
    assert any(line.startswith("found the rosbridge server") for line in client.log())


def test_a_frozen_network_is_noticed_and_survived(bridged: BehindBridge) -> None:
    robot, client = talking(bridged)
    bridged.server.do("freeze")
    bridged.wait_until(lambda: client.connected() is False, "pings without an answer end the connection")
    bridged.server.do("thaw")
    bridged.wait_until(client.connected, "the connection is there again")
    bridged.wait_until(lambda: client.publisher_count("/to_client") == 1, "the topic is subscribed again")
    robot.publish("/to_client", {"data": "again"})
    bridged.wait_until(heard(client, "/to_client", "again"), "messages come again")


def test_only_ros1_reports_a_failing_service(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.serve("/fail", "fail")
    bridged.wait_until(lambda: client.ready("/fail"), "the service is there")
    told = bridged.kind == "rosbridge-ros1"
    with pytest.raises(
        CallFailed if told else CallTimedOut, match="no sums today" if told else "did not answer"
    ):
        client.call("/fail", {"a": 1, "b": 2}, timeout=60 if told else 1)


def test_a_lost_link_fails_the_calls_under_way(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.serve("/never", "never")
    bridged.wait_until(lambda: client.ready("/never"), "the service is there")
    client.begin_call("c", "/never", {"a": 1, "b": 2})
    assert client.connected(), "by now the call is on its way"
    bridged.server.do("stop")
    with pytest.raises(CallFailed, match="the connection to the rosbridge server was lost during the call"):
        client.end_call("c")


def test_a_lost_link_loses_the_goals_under_way(bridged: BehindBridge) -> None:
    server, client = bridged.peer("server"), bridged.peer("client")
    server.serve_action("/count")
    client.send_goal("g", "/count", {"target": 1000, "period": 0.05}, timeout=60)
    bridged.wait_until(lambda: client.feedback("g"), "the goal is under way")
    client.begin_outcome("g")
    bridged.server.do("stop")
    with pytest.raises(ServerLost, match="it is unknown whether the goal continues"):
        client.end_outcome("g")
    # On the other side the clients receive that the goal is aborted, so its code is stopped.
    bridged.wait_until(lambda: ["end", 1000, False] in server.deeds("/count"), "the code is stopped")
    bridged.server.do("start")
    bridged.wait_until(lambda: client.connected() and server.connected(), "both are there again")
    client.send_goal("h", "/count", {"target": 2, "period": 0.01}, timeout=60)
    assert client.outcome("h", timeout=60)["status"] == "succeeded"


def test_an_action_server_that_goes_is_noticed_between_two_goals(robot_of_ros2: BehindBridge) -> None:
    """During a goal rosapi takes the bridge's own client for a server."""
    graph = robot_of_ros2
    robot, client = graph.peer("robot"), graph.peer("client")
    robot.serve_action("/count")
    client.send_goal("g", "/count", {"target": 2, "period": 0.01}, timeout=60)
    assert client.outcome("g", timeout=60)["status"] == "succeeded"
    graph.kill(robot)
    graph.wait_until(lambda: not client.action_ready("/count"), "the loss is noticed")


@pytest.mark.parametrize("robot_of_ros2", ["--without-actions"], indirect=True)
def test_a_goal_without_any_sign_fails(robot_of_ros2: BehindBridge) -> None:
    """Servers older than actions say nothing at all of an operation that they do not know."""
    robot, client = robot_of_ros2.peer("robot"), robot_of_ros2.peer("client")
    robot.serve_action("/count")
    with pytest.raises(
        CallFailed, match=r"no answer about the goal .* does this rosbridge server support actions"
    ):
        client.send_goal("g", "/count", {"target": 2, "period": 0.01}, timeout=60)
    assert robot.deeds("/count") == []


def test_a_goal_is_cancelled_when_the_program_ends(bridged: BehindBridge) -> None:
    server, client = bridged.peer("server"), bridged.peer("client")
    server.serve_action("/count")
    client.send_goal("g", "/count", {"target": 1000, "period": 0.05}, timeout=60)
    bridged.wait_until(lambda: client.feedback("g"), "the goal is under way")
    bridged.dispose(client)
    bridged.wait_until(lambda: ["end", 1000, True] in server.deeds("/count"), "the goal is cancelled")


def test_a_topic_of_another_type_is_reported(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.advertise("/a", "geometry_msgs/msg/Twist")
    client.subscribe("/a", STRING)
    bridged.wait_until(
        lambda: f"topic /a carries geometry_msgs/msg/Twist, not {STRING}" in client.log(),
        "the refusal, of which the server says nothing, is noticed",
    )
    client.advertise("/a", STRING)
    bridged.wait_until(
        lambda: any(line.startswith("nothing is published: topic /a") for line in client.log()),
        "and that of the publisher",
    )


def test_a_topic_that_gets_the_right_type_is_joined_again(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.advertise("/a", "geometry_msgs/msg/Twist")
    client.subscribe("/a", STRING)
    bridged.wait_until(lambda: any("topic /a carries" in line for line in client.log()), "it is refused")
    bridged.kill(robot)
    second = bridged.peer("other_robot")
    second.advertise("/a", STRING)

    def arrives() -> bool:
        second.publish("/a", {"data": "x"})
        return {"data": "x"} in client.received("/a")

    bridged.wait_until(arrives, "it is taken now")


def test_a_type_that_the_robot_lacks_is_reported(robot_of_ros2: BehindBridge, tmp_path: Any) -> None:
    (tmp_path / "odd_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "odd_msgs" / "msg" / "Thing.msg").write_text("int8 size\n")
    client = robot_of_ros2.peer("client", start=False, interface_paths=[str(tmp_path)])
    client.start()
    client.subscribe("/thing", "odd_msgs/msg/Thing")
    robot_of_ros2.wait_until(
        lambda: any("is odd_msgs/msg/Thing installed on the robot" in line for line in client.log()),
        "the type is missing there",
    )


@pytest.mark.parametrize("robot_of_ros2", ["--talkative"], indirect=True)
def test_a_refused_message_is_logged_once_if_the_server_reports_it(robot_of_ros2: BehindBridge) -> None:
    bridged = robot_of_ros2
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.subscribe("/a", "geometry_msgs/msg/Twist")
    client.advertise("/a", STRING)
    for _ in range(3):
        client.publish("/a", {"data": "x"})
    bridged.wait_until(
        lambda: any("Cannot infer topic type" in line for line in client.log()), "it is logged"
    )
    client.serve("/sum")
    bridged.wait_until(lambda: client.ready("/sum"), "the bridge has done all of that")
    assert sum("Cannot infer topic type" in line for line in client.log()) == 1


def test_unsupported_requests_have_clear_errors(robot_of_ros2: BehindBridge) -> None:
    client = robot_of_ros2.peer("client")
    with pytest.raises(CapabilityMissing, match="over rosbridge"):
        client.get_parameter("a")
    with pytest.raises(CapabilityMissing, match="cannot be declared"):
        client.declare("a", 1, node="/robot")
    with pytest.raises(CapabilityMissing, match="deadlines"):
        client.subscribe("/a", STRING, deadline=1.0)
    with pytest.raises(UnknownInterface, match=r"is not known here; .* \(in a mapping file: interfaces\)"):
        client.subscribe("/a", "nowhere_msgs/msg/Nothing")


@pytest.mark.parametrize("bridged", ["ros1"], indirect=True)
def test_parameters_of_a_ros1_master(bridged: BehindBridge) -> None:
    client = bridged.peer("client")
    client.set_parameter("speed", 0.5)
    client.set_parameter("names", ["a", "b"], "/other")
    assert client.get_parameter("speed") == 0.5
    assert client.parameter_names() == ["speed"]
    assert client.get_parameter("names", "/other") == ["a", "b"]
    with pytest.raises(ParameterUnknown):
        client.get_parameter("weight")


def test_a_topic_of_1_khz_does_not_starve_the_loop(robot_of_ros2: BehindBridge) -> None:
    robot, client = robot_of_ros2.peer("robot"), robot_of_ros2.peer("client")
    robot.advertise("/fast", "nav_msgs/msg/Odometry", depth=1)
    client.subscribe("/fast", "nav_msgs/msg/Odometry", depth=1)
    robot_of_ros2.wait_until(lambda: robot.subscription_count("/fast") == 1, "the topic is joined")
    robot.keep_publishing("/fast", {"child_frame_id": "base"}, 0.001)
    robot_of_ros2.wait_until(lambda: len(client.received("/fast")) > 200, "messages come")
    # A call needs the loop, and the link, while messages rush in.
    robot.serve("/sum")
    for number in range(20):
        assert client.call("/sum", {"a": number, "b": 1}, timeout=60) == {"sum": number + 1}


def test_a_robot_behind_a_lost_link_gets_zero_when_the_program_ends(bridged: BehindBridge) -> None:
    robot, client = bridged.peer("robot"), bridged.peer("client")
    robot.subscribe("/cmd_vel", "geometry_msgs/msg/Twist", depth=1000)
    client.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
    bridged.wait_until(lambda: client.subscription_count("/cmd_vel") == 1, "the topic is joined")
    client.hook("/cmd_vel", {})
    client.keep_publishing("/cmd_vel", {"linear": {"x": 0.5}})
    bridged.wait_until(lambda: robot.received("/cmd_vel"), "the robot drives")
    bridged.dispose(client)
    bridged.wait_until(lambda: robot.received("/cmd_vel")[-1]["linear"]["x"] == 0.0, "the robot stops")
    count = len(robot.received("/cmd_vel"))
    bridged.pass_time(0.2)
    assert len(robot.received("/cmd_vel")) == count


def test_two_nodes_in_turn_in_one_process(robot_of_ros2: BehindBridge) -> None:
    async def meet(name: str) -> int:
        backend = open_backend("rosbridge", clock, name, url=robot_of_ros2.server.url)
        await backend.start()
        sum_ = (
            await backend.client("/sum", "example_interfaces/srv/AddTwoInts").call({"a": 1, "b": 2}, 20)
        ).sum
        await backend.close()
        return int(sum_)

    robot_of_ros2.peer("robot").serve("/sum")
    for name in ("first", "second"):
        clock = WallClock()
        results: list[int] = []

        async def main(name: str = name, results: list[int] = results) -> None:
            results.append(await meet(name))

        run(main, clock)
        assert results == [3]


@pytest.fixture
def roslibpy_client(bridged: BehindBridge) -> Iterator[Any]:
    """The genuine client library as the other side."""
    import roslibpy

    client = roslibpy.Ros(bridged.server.url, transport="asyncio")
    client.run(20)
    yield client
    client.close()


def test_roslibpy_understands_us_and_we_understand_it(bridged: BehindBridge, roslibpy_client: Any) -> None:
    import roslibpy

    peer = bridged.peer("client")
    peer.subscribe("/there", STRING)
    peer.advertise("/back", STRING)
    got: list[str] = []
    kind = "std_msgs/String" if bridged.kind == "rosbridge-ros1" else STRING
    back, there = (
        roslibpy.Topic(roslibpy_client, "/back", kind),
        roslibpy.Topic(roslibpy_client, "/there", kind),
    )
    back.subscribe(lambda message: got.append(message["data"]))
    there.advertise()
    bridged.wait_until(lambda: peer.subscription_count("/back") == 1, "roslibpy subscribes")
    bridged.wait_until(lambda: peer.publisher_count("/there") == 1, "roslibpy advertises")
    there.publish(roslibpy.Message({"data": "hello"}))
    bridged.wait_until(heard(peer, "/there", "hello"), "its message arrives")
    peer.publish("/back", {"data": "welcome"})
    bridged.wait_until(lambda: got == ["welcome"], "ours arrives")


@pytest.mark.parametrize("bridged", ["ros1"], indirect=True)
def test_goals_between_us_and_roslibpys_actionlib(bridged: BehindBridge, roslibpy_client: Any) -> None:
    import roslibpy
    from roslibpy.ros1 import actionlib

    peer = bridged.peer("client")
    peer.serve_action("/ours")
    bridged.wait_until(lambda: peer.action_ready("/ours"), "our server is there")
    client = actionlib.ActionClient(roslibpy_client, "/ours", "jacaros_interfaces/CountAction")
    goal = actionlib.Goal(client, roslibpy.Message({"target": 3, "period": 0.01}))
    seen: list[int] = []
    goal.on("feedback", lambda feedback: seen.append(feedback["current"]))
    goal.send()
    assert goal.wait(20)["last"] == 3
    assert seen == [1, 2, 3]

    def execute(goal: Any) -> None:
        for number in range(goal["target"]):
            server.send_feedback({"current": number})
            time.sleep(0.01)
        server.set_succeeded({"last": goal["target"], "message": "theirs"})

    server = actionlib.SimpleActionServer(roslibpy_client, "/theirs", "jacaros_interfaces/CountAction")
    server.start(execute)
    peer.send_goal("g", "/theirs", {"target": 4, "period": 0.0}, timeout=60)
    assert peer.outcome("g", timeout=60) == {
        "status": "succeeded",
        "result": {"last": 4, "message": "theirs"},
        "text": "theirs",
    }
    assert peer.feedback("g") == [0, 1, 2, 3]


def test_a_server_without_rosapi_is_logged_and_taken_for_ros2(robot_of_ros2: BehindBridge) -> None:
    robot_of_ros2.server.do("rosapi", False)
    client = robot_of_ros2.peer("client", start=False)
    client.start()
    assert client.ros_version() == 2
    assert sum("has no rosapi node" in line for line in client.log()) == 1
    client.advertise("/a", STRING)
    client.subscribe("/a", STRING)
    robot_of_ros2.wait_until(lambda: _arrives(client), "topics work all the same")


def listening(robot_of_ros2: BehindBridge, tmp_path: Path) -> str:
    """What a run prints that listens to a topic on which a node of the robot publishes nothing."""
    robot_of_ros2.peer("robot").advertise("/odd", STRING)
    mapping, program = tmp_path / "odd.yaml", tmp_path / "listener.asl"
    mapping.write_text(
        f"artifacts: {{odd: {{properties: {{odd: {{topic: odd, type: {STRING}, fields: [data]}}}}}}}}\n"
    )
    program.write_text("!start.\n+!start <- .wait(12000); .stopMAS.\n")
    jacaros = Path(sys.executable).parent / "jacaros"
    options = ("--mapping", str(mapping), "--ros", "rosbridge", "--bridge", robot_of_ros2.server.url)
    done = subprocess.run(
        (jacaros, "run", str(program), "--clock", "real", *options),
        capture_output=True,
        text=True,
        check=True,
    )
    assert "no publisher" not in done.stderr
    return done.stderr


def test_a_run_without_rosapi_does_not_claim_that_a_topic_has_no_publisher(
    robot_of_ros2: BehindBridge, tmp_path: Path
) -> None:
    robot_of_ros2.server.do("rosapi", False)
    printed = listening(robot_of_ros2, tmp_path)
    assert "no message on topic /odd (std_msgs/msg/String); the graph cannot be queried" in printed


def test_a_silent_publisher_behind_a_bridge_is_not_called_missing(
    robot_of_ros2: BehindBridge, tmp_path: Path
) -> None:
    printed = listening(robot_of_ros2, tmp_path)
    assert "no message on topic /odd (std_msgs/msg/String) yet, although it has a publisher" in printed
    assert "sends nothing if it cannot convert the type; its log says so" in printed


def test_the_list_says_why_types_of_actions_are_unknown(robot_of_ros2: BehindBridge) -> None:
    robot_of_ros2.peer("robot").serve_action("/count")
    robot_of_ros2.server.do("rosapi_without", "action_type")
    jacaros = Path(sys.executable).parent / "jacaros"
    options = ("--ros", "rosbridge", "--bridge", robot_of_ros2.server.url, "--timeout", "30")
    done = subprocess.run((jacaros, "ros", "list", *options), capture_output=True, text=True, check=True)
    assert "action /count (unknown)" in done.stdout.splitlines()
    assert "the types of some actions are (unknown): rosapi on the robot cannot report them" in done.stderr


def _arrives(client: Any) -> bool:
    client.publish("/a", {"data": "x"})
    return bool(client.received("/a"))


def test_no_thread_of_ours_is_left_behind_and_no_signal_handler_taken(robot_of_ros2: BehindBridge) -> None:
    import signal

    handlers = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    threads = set(threading.enumerate())

    async def main() -> None:
        backend = open_backend("rosbridge", clock, "node", url=robot_of_ros2.server.url)
        await backend.start()
        await backend.close()

    clock = WallClock()
    run(main, clock)
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == handlers
    # What watches the end of the process looks five times a second whether it is still needed.
    robot_of_ros2.wait_until(lambda: set(threading.enumerate()) <= threads, "the threads end")


def test_parameters_of_our_own_cannot_be_given() -> None:
    with pytest.raises(CapabilityMissing, match="speed cannot be set: over rosbridge there is no node"):
        open_backend("rosbridge", WallClock(), "node", url="ws://127.0.0.1:9090", parameters={"speed": 0.5})
