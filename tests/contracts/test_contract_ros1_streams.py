"""ROS 1 alone: messages read on the loop, also where rospy itself listens in the same process."""

import pytest
from masters import Master
from programs import run_program

pytestmark = [pytest.mark.ros1, pytest.mark.slow]

TOGETHER = """
import asyncio, threading
import rospy
from std_msgs.msg import String
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend

MAIN = threading.current_thread()

async def until(condition):
    async with asyncio.timeout(30):
        while not condition():
            await asyncio.sleep(0.01)

async def main():
    backend = open_backend("ros1", WallClock(), "both")
    await backend.start()

    async def heard_by_both(topic, ours, theirs):
        publisher = backend.publisher(topic, "std_msgs/msg/String")
        await until(lambda: publisher.subscription_count)
        for number in range(20):
            publisher.publish({"data": str(number)})
            await until(lambda: ours[-1:] == [str(number)] and theirs[-1:] == [str(number)])

    ours, theirs = [], []
    def take(sample):
        assert threading.current_thread() is MAIN
        ours.append(sample.message.data)

    backend.subscription("/first", "std_msgs/msg/String", take)
    await until(lambda: any(name == "/first" for name, _ in rospy.topics.get_topic_manager().get_subscriptions()))
    rospy.Subscriber("/first", String, lambda message: theirs.append(message.data))
    await heard_by_both("/first", ours, theirs)
    assert ours == theirs == [str(number) for number in range(20)], (ours, theirs)

    early = []
    rospy.Subscriber("/second", String, lambda message: early.append(message.data))
    publisher = backend.publisher("/second", "std_msgs/msg/String")
    await until(lambda: publisher.subscription_count)
    publisher.publish({"data": "before"})
    await until(lambda: early)
    late = []
    backend.subscription("/second", "std_msgs/msg/String", lambda sample: late.append(sample.message.data))
    await until(lambda: len(rospy.topics.get_topic_manager().get_subscriber_impl("/second").callbacks) == 2)
    await heard_by_both("/second", late, early)
    assert late == [str(number) for number in range(20)], late
    assert early == ["before", *late], early
    await backend.close()
    print("both")

run(main, WallClock())
"""

LARGE = """
import asyncio
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import QoS

async def until(condition):
    async with asyncio.timeout(60):
        while not condition():
            await asyncio.sleep(0.01)

async def main():
    backend = open_backend("ros1", WallClock(), "large")
    await backend.start()
    got = []
    backend.subscription("/image", "std_msgs/msg/UInt8MultiArray", lambda s: got.append(s.message.data), QoS(depth=1))
    publisher = backend.publisher("/image", "std_msgs/msg/UInt8MultiArray", QoS(depth=1))
    await until(lambda: publisher.subscription_count)
    image = bytes(range(256)) * 100_000
    for number in range(3):
        publisher.publish({"data": image + bytes([number])})
        await until(lambda: len(got) == number + 1)
        assert bytes(got[-1]) == image + bytes([number])
    await backend.close()
    print("whole")

run(main, WallClock())
"""


def output_of(program: str, master: Master) -> str:
    master.start()
    answer = run_program(program, master.environment)
    assert answer.returncode == 0, answer.stderr
    return answer.stdout


def test_a_rospy_subscriber_in_the_same_process_receives_every_message(master: Master) -> None:
    assert output_of(TOGETHER, master) == "both\n"


def test_a_message_of_many_megabytes_comes_whole(master: Master) -> None:
    assert output_of(LARGE, master) == "whole\n"
