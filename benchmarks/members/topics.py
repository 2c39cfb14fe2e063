"""ROS 2 alone: messages on topics there and back, services, and messages as fast as it can.

topics.py DOMAIN NAME [PARTNER]
"""

import itertools
import os
import sys
import threading
import time
from typing import Any

import rclpy
from orders import Orders
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

PAYLOAD = "x" * 120
DEPTH = 100


def answering(node: Any, name: str) -> None:
    """Send back what arrives, answer calls, and publish on request."""
    back = node.create_publisher(String, f"back_{name}", DEPTH)
    ticks = node.create_publisher(String, f"ticks_{name}", DEPTH)

    def publish(message: String) -> None:
        end = time.perf_counter() + float(message.data)
        while time.perf_counter() < end:
            for _ in range(20):
                ticks.publish(String(data=PAYLOAD))
        ticks.publish(String(data=""))

    node.create_subscription(String, f"there_{name}", back.publish, DEPTH)
    node.create_subscription(String, f"begin_{name}", publish, DEPTH)
    node.create_service(Trigger, f"ask_{name}", lambda request, response: response)


class Asking:
    """Measures at the side that asks.

    Args:
        node: its node.
        executor: executes its callbacks.
        partner: the answering process.
    """

    def __init__(self, node: Any, executor: SingleThreadedExecutor, partner: str) -> None:
        self._node, self._executor = node, executor
        self._there = node.create_publisher(String, f"there_{partner}", DEPTH)
        self._begin = node.create_publisher(String, f"begin_{partner}", DEPTH)
        self._client = node.create_client(Trigger, f"ask_{partner}")
        self._back = self._ended = False
        self._seen: list[float] = []
        node.create_subscription(String, f"back_{partner}", self._on_back, DEPTH)
        node.create_subscription(String, f"ticks_{partner}", self._on_tick, DEPTH)

    def _on_back(self, message: String) -> None:
        self._back = True

    def _on_tick(self, message: String) -> None:
        if message.data:
            self._seen.append(time.perf_counter())
        else:
            self._ended = True

    def connect(self) -> None:
        """Wait until the other process is found."""
        self._client.wait_for_service(20)
        for publisher in (self._there, self._begin):
            while not publisher.get_subscription_count():
                self._executor.spin_once(timeout_sec=0.05)
        self._back = False
        while not self._back:  # the way back is found a little later
            self._there.publish(String(data=PAYLOAD))
            self._executor.spin_once(timeout_sec=0.1)

    def messages(self, count: float) -> list[float]:
        """Measure messages there and back."""
        times = []
        for _ in range(int(count)):
            self._back = False
            began = time.perf_counter()
            self._there.publish(String(data=PAYLOAD))
            while not self._back:
                self._executor.spin_once(timeout_sec=1)
            times.append((time.perf_counter() - began) * 1e6)
        return times

    def operations(self, count: float) -> list[float]:
        """Measure calls of a service."""
        times = []
        for _ in range(int(count)):
            began = time.perf_counter()
            answer = self._client.call_async(Trigger.Request())
            while not answer.done():
                self._executor.spin_once(timeout_sec=1)
            times.append((time.perf_counter() - began) * 1e6)
        return times

    def updates(self, seconds: float) -> list[float]:
        """Measure the time between arrivals."""
        self._seen, self._ended = [], False
        self._begin.publish(String(data=str(seconds)))
        end = time.perf_counter() + seconds + 2  # the last one may be lost
        while not self._ended and time.perf_counter() < end:
            self._executor.spin_once(timeout_sec=0.5)
        seen = self._seen
        return [(later - earlier) * 1e6 for earlier, later in itertools.pairwise(seen)]


def main(name: str, partner: str) -> None:
    """Run one process until its input ends."""
    rclpy.init()
    node = rclpy.create_node(f"bench_{name}")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    orders = Orders()
    if partner:
        asking = Asking(node, executor, partner)
        asking.connect()
        orders.ready()
        while order := orders.next():
            what, amount = order
            orders.answer(getattr(asking, what)(amount))
        return
    answering(node, name)
    orders.ready()
    threading.Thread(target=lambda: (orders.next(), executor.shutdown(0)), daemon=True).start()
    try:
        executor.spin()
    except ExternalShutdownException:
        return


if __name__ == "__main__":
    os.environ |= {"ROS_DOMAIN_ID": sys.argv[1], "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    main(sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "")
