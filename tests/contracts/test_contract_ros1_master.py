"""ROS 1 alone: a master that is late, goes away, and comes back without memory."""

import asyncio
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from graphs import InProcesses
from masters import Master
from programs import run_program

from jacaros.robots.ros.errors import ParameterUnknown, ServiceUnavailable
from jacaros.robots.ros.qos import QoS

pytestmark = [pytest.mark.ros1, pytest.mark.slow]


@pytest.fixture
def ros1(master: Master) -> Iterator[InProcesses]:
    """A graph around the test's own master."""
    made = InProcesses("ros1", master.environment)
    yield made
    made.close()


def exchange(ros1: InProcesses, left: Any, right: Any, value: int) -> None:
    def arrives() -> bool:
        left.publish("/before", {"data": value})
        return {"data": value} in right.received("/before")

    ros1.wait_until(arrives, f"{value} arrives")


def test_a_restarted_master_learns_everything_again(master: Master, ros1: InProcesses) -> None:
    master.start()
    left, right = ros1.peer("left"), ros1.peer("right")
    left.advertise("/before", "std_msgs/msg/Int32")
    right.subscribe("/before", "std_msgs/msg/Int32")
    right.serve("/add")
    exchange(ros1, left, right, 1)
    assert left.call("/add", {"a": 1, "b": 1}, timeout=60) == {"sum": 2}

    master.kill()
    ros1.wait_until(lambda: not left.connected() and not right.connected(), "both notice the loss")
    exchange(ros1, left, right, 2)  # connections between nodes outlive the master
    left.advertise("/during", "std_msgs/msg/Int32")  # neither blocks nor is it lost
    right.subscribe("/during", "std_msgs/msg/Int32")
    left.publish("/during", {"data": 5})

    master.start()
    ros1.wait_until(lambda: left.connected() and right.connected(), "both notice the return")
    assert left.connection() == [True, False, True]
    exchange(ros1, left, right, 3)
    ros1.wait_until(lambda: left.ready("/add"), "the service is found again")
    assert left.call("/add", {"a": 1, "b": 1}, timeout=60) == {"sum": 2}
    ros1.wait_until(lambda: left.subscription_count("/during") == 1, "the topic made meanwhile is joined")

    newcomer = ros1.peer("newcomer")
    newcomer.subscribe("/before", "std_msgs/msg/Int32")
    exchange(ros1, left, newcomer, 4)
    assert newcomer.call("/add", {"a": 2, "b": 2}, timeout=60) == {"sum": 4}
    assert any("had forgotten" in line and "/before" in line for line in left.log())


def test_an_early_message_that_cannot_be_serialised_does_not_silence_its_topic(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # rospy serialises only with a connection, which at this moment is a race; so its publisher is a stand-in.
    rospy = pytest.importorskip("rospy", reason="no ROS 1 here; see test_contract_presence")

    from jacaros.robots.ros.drivers.ros1 import topics as ros1_topics

    sent: list[int] = []

    class Connected:
        def publish(self, message: Any) -> None:
            if message.data < 0:
                raise rospy.ROSSerializationException("field data is wrong")
            sent.append(message.data)

    monkeypatch.setattr(rospy, "Publisher", lambda *arguments, **options: Connected())
    loop = asyncio.new_event_loop()
    log: list[str] = []
    registrations: list[Callable[[], None]] = []
    node: Any = SimpleNamespace(
        factory=SimpleNamespace(message_class=lambda name: SimpleNamespace),
        lifetime=SimpleNamespace(send=lambda send, message: send(message)),
        link=SimpleNamespace(do=registrations.append),
        members={},
        unsent={},
        loop=loop,
        log=log.append,
        tracer=None,
    )
    publisher = ros1_topics.Ros1Publisher(node, "/before", "std_msgs/msg/Int32", QoS())
    for number in (1, -1, 2):
        publisher.publish(SimpleNamespace(data=number))
    registrations[0]()
    publisher.publish(SimpleNamespace(data=3))
    loop.run_until_complete(asyncio.sleep(0))
    loop.close()
    assert sent == [1, 2, 3]
    assert log == ["topic /before: message dropped: field data is wrong"]


def test_a_master_restarted_in_a_moment_learns_everything_again(master: Master, ros1: InProcesses) -> None:
    master.start()
    left = ros1.peer("left")
    left.advertise("/before", "std_msgs/msg/Int32")
    left.serve("/add")
    ros1.wait_until(lambda: left.ready("/add"), "the service is registered")
    master.kill()
    master.start()
    newcomer = ros1.peer("newcomer")
    newcomer.subscribe("/before", "std_msgs/msg/Int32")
    exchange(ros1, left, newcomer, 1)
    assert newcomer.call("/add", {"a": 2, "b": 2}, timeout=60) == {"sum": 4}


def test_actions_and_parameters_outlive_a_restarted_master(master: Master, ros1: InProcesses) -> None:
    master.start()
    left, right = ros1.peer("left"), ros1.peer("right", parameters={"wheels/radius": 0.25})
    right.serve_action("/count")
    left.send_goal("before", "/count", {"target": 1000, "period": 0.05}, timeout=60)
    right.set_parameter("speed", 1, timeout=60)
    left.watch_parameters("right", "/right")

    master.kill()
    ros1.wait_until(lambda: not left.connected() and not right.connected(), "both notice the loss")
    left.send_goal("during", "/count", {"target": 3}, timeout=60)  # the five connections are still there
    assert left.outcome("during", timeout=60)["status"] == "succeeded"
    with pytest.raises(ServiceUnavailable, match=r"the ROS master at .* did not answer within 1 s"):
        left.get_parameter("speed", "/right", timeout=1)
    with pytest.raises(ServiceUnavailable, match=r"the ROS master at .* does not answer"):
        left.contents()

    master.start()
    ros1.wait_until(lambda: left.connected() and right.connected(), "both notice the return")
    assert left.cancel_goal("before", timeout=60) is True
    assert left.outcome("before", timeout=60)["status"] == "canceled"
    newcomer = ros1.peer("newcomer")
    newcomer.send_goal("after", "/count", {"target": 2}, timeout=60)
    assert newcomer.outcome("after", timeout=60)["status"] == "succeeded"
    assert newcomer.contents()["actions"] == {"/count": "jacaros_interfaces/action/Count"}
    assert any("the parameters stored in it are lost" in line for line in right.log())
    with pytest.raises(ParameterUnknown):
        right.get_parameter("speed", timeout=60)
    ros1.wait_until(
        lambda: "wheels/radius" in left.parameter_names("/right"), "those from outside are set again"
    )
    assert left.get_parameter("wheels/radius", "/right", timeout=60) == 0.25

    def change_is_told() -> bool:
        newcomer.set_parameter("speed", 2, "/right", timeout=60)
        return {"speed": 2} in left.parameter_changes("right")

    ros1.wait_until(change_is_told, "changes are reported again")


def test_a_late_master_is_awaited_without_blocking_the_loop(master: Master, ros1: InProcesses) -> None:
    robot = ros1.peer("robot")  # start() returns though there is no master
    robot.watch_loop()
    assert robot.connected() is False
    assert robot.log() == [f"waiting for the ROS master at {master.uri}"]
    robot.advertise("/map", "std_msgs/msg/String", durability="transient_local", depth=1)
    robot.publish("/map", {"data": "kitchen"})
    robot.serve("/add")
    ros1.wait_until(lambda: len(robot.log()) == 2, "the master is called missing")
    assert "is missing; still trying; start it with `roscore`" in robot.log()[1]
    master.start()
    ros1.wait_until(robot.connected, "the master is found")
    assert robot.connection() == [True]
    assert f"found the ROS master at {master.uri}" in robot.log()
    visitor = ros1.peer("visitor")
    visitor.subscribe("/map", "std_msgs/msg/String")
    ros1.wait_until(lambda: visitor.received("/map") == [{"data": "kitchen"}], "the early message arrives")
    assert visitor.call("/add", {"a": 1, "b": 2}, timeout=60) == {"sum": 3}
    assert robot.longest_pause() < 2.0


def test_a_call_without_a_master_is_unavailable(master: Master, ros1: InProcesses) -> None:
    robot = ros1.peer("robot")
    with pytest.raises(Exception, match="no node offered service /add"):
        robot.call("/add", {"a": 1, "b": 1}, timeout=1)


def test_a_node_that_never_found_its_master_ends_cleanly(master: Master, ros1: InProcesses) -> None:
    robot = ros1.peer("robot")
    robot.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
    robot.hook("/cmd_vel", {})
    getattr(robot, "return")()
    assert robot.wait() == 0


def test_a_second_node_of_the_same_name_is_reported(master: Master, ros1: InProcesses) -> None:
    master.start()
    first = ros1.peer("twin")
    ros1.peer("twin")
    ros1.wait_until(lambda: not first.connected(), "the first notices")
    assert any("is its name taken" in line for line in first.log())


def test_messages_arrive_with_warnings_as_errors(master: Master, ros1: InProcesses) -> None:
    master.start()
    flags = "-W error::DeprecationWarning"
    left, right = ros1.peer("left", flags=flags), ros1.peer("right", flags=flags)
    left.advertise("/before", "std_msgs/msg/Int32")
    right.subscribe("/before", "std_msgs/msg/Int32")
    exchange(ros1, left, right, 1)


def test_a_process_has_one_node(master: Master) -> None:
    master.start()
    program = """
import asyncio
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend
async def main():
    one, two = open_backend("ros1", WallClock(), "one"), open_backend("ros1", WallClock(), "two")
    await one.start()
    try:
        await two.start()
    except Exception as problem:
        print(type(problem).__name__, problem)
    await one.close()
run(main, WallClock())
"""
    answer = run_program(program, master.environment)
    assert answer.stdout.startswith("RosError ROS 1 allows one node per process"), answer.stderr
    assert answer.returncode == 0


def test_a_signal_in_the_middle_of_joining_ends_the_start(master: Master) -> None:
    master.start()
    program = """
import asyncio
import rospy
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend
async def main():
    backend = open_backend("ros1", WallClock(), "hasty")
    def interrupted(*_, **__):
        backend.lifetime.leave_now()
        raise rospy.exceptions.ROSInitException("shut down meanwhile")
    rospy.init_node = interrupted
    async with asyncio.timeout(30):
        await backend.start()
        await backend.close()
    print("ended")
run(main, WallClock())
"""
    answer = run_program(program, master.environment)
    assert answer.stdout == "ended\n", answer.stderr
    assert answer.returncode == 0


def test_a_publisher_with_a_broken_connection_is_connected_again(master: Master, ros1: InProcesses) -> None:
    master.start()
    talker = ros1.peer("talker")
    talker.advertise("/before", "std_msgs/msg/Int32")
    program = """
import asyncio, sys
import rospy
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend
async def until(condition):
    async with asyncio.timeout(60):
        while not condition():
            await asyncio.sleep(0.01)
async def main():
    backend = open_backend("ros1", WallClock(), "listener")
    await backend.start()
    listening = backend.subscription("/before", "std_msgs/msg/Int32", lambda sample: print(sample.message.data, flush=True))
    for number in range(2):
        await until(lambda: listening.publisher_count == 1)
        print("connected", flush=True)
        await asyncio.get_running_loop().run_in_executor(None, sys.stdin.readline)
        # As when the network was away for longer than TCP is patient: the master is not notified.
        for each in list(rospy.topics.get_topic_manager().get_subscriber_impl("/before").connections):
            each.close()
        await until(lambda: listening.publisher_count == 0)
    await backend.close()
run(main, WallClock())
"""
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [sys.executable, "-c", program],
        env=os.environ | master.environment,
        stdin=pipe,
        stdout=pipe,
        text=True,
    ) as listener:
        assert listener.stdin is not None
        assert listener.stdout is not None
        try:
            for number in range(2):
                assert listener.stdout.readline() == "connected\n"
                ros1.wait_until(
                    lambda: talker.subscription_count("/before") == 1, "the talker knows of one listener"
                )
                talker.publish("/before", {"data": number})
                assert listener.stdout.readline() == f"{number}\n"
                listener.stdin.write("break\n")
                listener.stdin.flush()
            assert listener.wait(60) == 0
        finally:
            listener.kill()
