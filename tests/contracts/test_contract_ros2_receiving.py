"""ROS 2 alone: how messages are taken beside rclpy's executor, within one process."""

from typing import Any

import pytest
from programs import run_program

pytestmark = pytest.mark.ros2

BEGIN = """
import asyncio, sys
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.drivers.ros2 import receiving as ros2_receiving
from jacaros.robots.ros.open import open_backend

STRING = "std_msgs/msg/String"
clock, told, heard = WallClock(), [], []

async def until(condition):
    for _ in range(3000):
        if condition():
            return
        await clock.sleep(0.01)
    sys.exit(f"not within 30 s; heard {heard}, told {told}")

async def talk(publisher, text):
    # Again and again: the first ones may be sent before the two know of each other.
    for _ in range(3000):
        publisher.publish({"data": text})
        await clock.sleep(0.01)
        if text in heard:
            return
    sys.exit(f"{text} not heard; heard {heard}, told {told}")

async def main():
    backend = open_backend("ros2", clock, "node", log=told.append)
    await backend.start()
    publisher = backend.publisher("/a", STRING)
    hear = lambda sample: heard.append(sample.message.data)
    try:
        await test(backend, publisher, hear)
    finally:
        await backend.close()
"""
END = """
run(main, clock)
print("done")
"""


def passes(environment: dict[str, str], test: str, before: str = "") -> None:
    done = run_program(before + BEGIN + test + END, environment)
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr


def test_an_unreadable_message_is_logged_once_and_the_next_is_received(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
left, genuine = 3, ros2_receiving.take_message

def unreadable(handle, kind):
    global left
    if left and genuine(handle, kind):
        left -= 1
        raise ValueError("no text")
    return genuine(handle, kind)

async def test(backend, publisher, hear):
    ros2_receiving.take_message = unreadable
    backend.subscription("/a", STRING, hear)
    await talk(publisher, "a")
    assert left == 0
    assert told == ["a message of type String cannot be read: ValueError: no text"], told
    assert not backend.receiver.group.given_back
""",
    )


def test_messages_that_wait_together_are_delivered_in_the_order_in_which_they_came(
    domain: dict[str, str],
) -> None:
    passes(
        domain,
        """
import threading
genuine, held = ros2_receiving.take_message, threading.Event()

def slow(handle, kind):
    found = genuine(handle, kind)
    if found and found[0].data == "wait":
        held.wait(10)
    return found

async def test(backend, publisher, hear):
    backend.subscription("/a", STRING, hear)
    backend.subscription("/b", STRING, hear)
    other = backend.publisher("/b", STRING)
    await talk(publisher, "a")
    await talk(other, "b")
    heard.clear()
    ros2_receiving.take_message = slow
    publisher.publish({"data": "wait"})
    await clock.sleep(0.1)
    other.publish({"data": "first"})
    await clock.sleep(0.1)
    publisher.publish({"data": "second"})
    await clock.sleep(0.1)
    held.set()
    await until(lambda: "second" in heard and "first" in heard)
    assert heard[-2:] == ["first", "second"], heard
""",
    )


def test_rclpys_executor_takes_over_where_the_wait_set_is_another_one(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
async def test(backend, publisher, hear):
    backend.subscription("/a", STRING, hear)
    await talk(publisher, "a")

    def changed(*_):
        raise TypeError("incompatible function arguments")

    ros2_receiving.wait_set = changed
    second = backend.subscription("/a", STRING, hear)
    await until(lambda: told)
    assert told == ["the fast receiver failed; rclpy's executor takes over: "
                    "TypeError: incompatible function arguments"], told
    await talk(publisher, "b")
    second.close()
    await talk(publisher, "c")
    await until(lambda: len(list(backend.rcl.subscriptions)) == 1)
""",
    )


def _without(*names: str) -> str:
    """Return a program that removes *names* from rclpy's extension module."""
    return f"""
from rclpy.impl.implementation_singleton import rclpy_implementation
import threading

class Without:
    def __getattr__(self, name):
        if name in {names}:
            raise AttributeError(name)
        return getattr(rclpy_implementation, name)

import rclpy, rclpy.node, rclpy.executors
rclpy.impl.implementation_singleton.rclpy_implementation = Without()
"""


@pytest.mark.parametrize("name", ["RCLError", "InvalidHandle", "WaitSet"])
def test_a_node_receives_serves_and_stops_without_an_inner_name_of_rclpy(
    domain: dict[str, str], name: str
) -> None:
    passes(
        domain,
        """
async def serve(request):
    return {"success": request.data, "message": "served"}

async def test(backend, publisher, hear):
    backend.subscription("/a", STRING, hear)
    await talk(publisher, "a")
    backend.service("/s", "std_srvs/srv/SetBool", serve)
    response = await backend.client("/s", "std_srvs/srv/SetBool").call({"data": True}, timeout=30)
    assert (response.success, response.message) == (True, "served"), response
    await backend.close()
    threads = [thread.name for thread in threading.enumerate() if thread.name.startswith(("ros2", "rclpy"))]
    assert not threads, threads
""",
        _without(name),
    )


@pytest.mark.parametrize("names", [["WaitSet"], ["RCLError", "InvalidHandle", "WaitSet"]])
def test_without_rclpys_inner_names_all_goes_through_its_executor(
    domain: dict[str, str], names: list[str]
) -> None:
    passes(
        domain,
        """
from jacaros.robots.ros.errors import RosError

async def test(backend, publisher, hear):
    backend.subscription("/a", STRING, hear)
    await talk(publisher, "a")
    assert told == ["the fast receiver failed; rclpy's executor takes over: "
                    "NotImplementedError: rclpy has no wait sets"], told
    try:
        backend.subscription("/a", "std_msgs/msg/Int32", hear)
    except RosError as problem:
        assert "already uses it with type std_msgs/msg/String" in str(problem), problem
    else:
        sys.exit("a topic has two types")
""",
        _without(*names),
    )


def test_subscriptions_come_and_go_while_messages_arrive(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
async def test(backend, publisher, hear):
    before = len(list(backend.rcl.subscriptions)), len(list(backend.rcl.waitables))
    held = [backend.subscription("/a", STRING, lambda _: None) for _ in range(20)]
    for number in range(200):
        publisher.publish({"data": "x"})
        held.pop(number % len(held)).close()
        held.append(backend.subscription("/a", STRING, hear))
        await asyncio.sleep(0)
    await talk(publisher, "last")
    for subscription in held:
        subscription.close()
        subscription.close()
    await until(lambda: (len(list(backend.rcl.subscriptions)), len(list(backend.rcl.waitables))) == before)
    backend.subscription("/a", STRING, hear)
    await talk(publisher, "after the switch")
    assert told == [], told
""",
    )


def test_a_deadline_is_reported_although_the_executor_takes_no_messages(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
from jacaros.robots.ros.qos import QoS

async def test(backend, publisher, hear):
    prompt, events = QoS(deadline=0.2), []
    offering = backend.publisher("/prompt", STRING, prompt)
    backend.subscription("/prompt", STRING, hear, prompt, events.append)
    await talk(offering, "a")
    await until(lambda: events)
    assert events[0].trouble == "deadline_missed", events
""",
    )


def test_the_clock_that_rclpy_follows_does_not_keep_its_executor_busy(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
async def test(backend, publisher, hear):
    robot = open_backend("ros2", clock, "simulated", log=told.append, parameters={"use_sim_time": True})
    await robot.start()
    time = backend.publisher("/clock", "rosgraph_msgs/msg/Clock")
    for _ in range(3000):
        time.publish({"clock": {"sec": 1234}})
        await clock.sleep(0.01)
        if robot.rcl.get_clock().now().nanoseconds == 1234 * 10**9:
            break
    else:
        sys.exit("the clock is not followed")
    assert [s.callback_group for s in robot.rcl.subscriptions] == [robot.receiver.group]
    await robot.close()
    assert told == [], told
""",
    )


def test_requests_that_were_never_answered_are_forgotten_with_their_goal(domain: dict[str, str]) -> None:
    passes(
        domain,
        """
from jacaros.robots.ros.errors import CallTimedOut

async def test(backend, publisher, hear):
    other = open_backend("ros2", clock, "other", log=told.append)
    await other.start()

    async def wait_for_ever(goal):
        await asyncio.Event().wait()

    other.action_server("/count", "jacaros_interfaces/action/Count", wait_for_ever)
    client = backend.action_client("/count", "jacaros_interfaces/action/Count")
    before = len(backend.members), len(list(backend.rcl.clients))
    for _ in range(20):
        goal = await client.send({"target": 1}, timeout=60)
        await goal.cancel(timeout=60)
    goal = await client.send({"target": 1}, timeout=60)
    assert client.wire._calls, "the result was asked for"
    await goal.cancel(timeout=60)
    await until(lambda: not client.busy)
    assert not client.wire._calls
    assert (len(backend.members), len(list(backend.rcl.clients))) == before
    for one in (client.wire._goal_client, client.wire._cancel_client, client.wire._result_client):
        await until(lambda: not one._pending_requests)
    await other.close()
""",
    )


class _Answering(dict[Any, Any]):
    """Calls of which each is answered, on the executor's thread, at the moment at which the loop forgets it."""

    def pop(self, call: Any, *default: Any) -> Any:
        super().pop(call, None)
        return super().pop(call, *default)

    def popitem(self) -> Any:
        self.clear()
        return super().popitem()


def test_a_call_may_be_answered_while_it_is_forgotten() -> None:
    pytest.importorskip("rclpy", reason="no ROS 2 here; see test_contract_presence")
    from jacaros.robots.ros.drivers.ros2.actions import Ros2GoalWire

    wire = Ros2GoalWire.__new__(Ros2GoalWire)
    wire._calls = _Answering({"first": None, "second": None})
    wire._forget_calls()
    assert not wire._calls
