"""The heartbeat of the agents' process over the graph, for a guard on the robot's computer.

Both directions use a topic of ``std_msgs/msg/String`` below the agents' node: ``/patrol/heartbeat``, and ``/patrol/guard``
for the answers. Each message is a JSON object with the whole state, because any of them may be lost:

    {"run": ID, "driving": B, "permits": {GUARD: TRIP, ...}, "goodbye": B, and the first fields of `jacaros.ros.heartbeat`}
    {"guard": NAME, and the fields of a guard's answer there}

``driving`` is whether the robot may be moving: its last velocity was not zero, or a goal is running. It is sent before the
first such command.
"""

import asyncio
import json
import secrets
from collections.abc import Callable

from jacaros.ros.backend import Backend
from jacaros.ros.guarded import guarded_by
from jacaros.ros.heartbeat import description
from jacaros.ros.node import Sample
from jacaros.ros.qos import QoS

PERIOD = 0.1
"""Seconds between two heartbeats."""
ANSWERING = 2.0
"""Seconds to wait at the start for the answer of a node that listens to the heartbeat."""
LOST = 3.0
"""Seconds without an answer after which a guard is reported as lost."""
TEXT = "std_msgs/msg/String"
NEWEST = QoS(depth=1)
"""An old heartbeat is worthless: it is replaced by a newer one, and not repeated."""


def topics_of(node: str) -> tuple[str, str]:
    """Return the topics of the heartbeat of *node* and of the guards' answers."""
    return f"{node}/heartbeat", f"{node}/guard"


class GraphHeartbeat:
    """Publishes the heartbeat of this process until the node ends, and obeys the guards that answer.

    It uses real time, as `jacaros.ros.heartbeat.Heartbeat` does.

    Args:
        backend: the node of the agents; it has joined the graph.
        simulated_time: whether messages use the time of a simulator.
        log: called with one line when a guard appears or disappears.
    """

    def __init__(self, backend: Backend, simulated_time: bool, log: Callable[[str], None]) -> None:
        self._simulated_time, self._log = simulated_time, log
        self._guarded = guarded_by(backend)
        self._id = secrets.token_hex(8)
        self._permits: dict[str, str] = {}
        self._heard: dict[str, float] = {}
        heartbeat, answer = topics_of(backend.node_name)
        self._publisher = backend.publisher(heartbeat, TEXT, NEWEST)
        backend.subscription(answer, TEXT, self._hear, NEWEST)
        self._guarded.on_drive = self._publish
        self._beat()

    async def wait_for_answer(self) -> None:
        """Wait until a guard has answered, if a node listens to the heartbeat, for at most `ANSWERING` seconds."""
        for _ in range(round(ANSWERING / PERIOD)):
            if self._heard or not self._publisher.subscription_count:
                return
            await asyncio.sleep(PERIOD)

    def goodbye(self) -> None:
        """Report that the process ends and stops its robot itself; on any thread."""
        self._publish(goodbye=True)

    def close(self) -> None:
        """Stop the heartbeat. The topics end with the node."""
        self._timer.cancel()
        self._guarded.on_drive = lambda: None

    def _beat(self) -> None:
        loop = asyncio.get_running_loop()
        self._timer = loop.call_later(PERIOD, self._beat)
        self._publish()
        for guard in [guard for guard, heard in self._heard.items() if loop.time() - heard > LOST]:
            del self._heard[guard], self._guarded.found[guard]
            self._log(f"warning: the guard {guard} no longer answers; it may be unable to stop the robot")

    def _publish(self, goodbye: bool = False) -> None:
        state = description(self._guarded, self._simulated_time)
        state |= {
            "run": self._id,
            "driving": self._guarded.driving,
            "permits": self._permits,
            "goodbye": goodbye,
        }
        self._publisher.publish({"data": json.dumps(state)})

    def _hear(self, sample: Sample) -> None:
        """Take the answer of a guard."""
        try:
            message = json.loads(sample.message.data)
            guard, trip = message["guard"], message["trip"]
        except (ValueError, KeyError, TypeError):
            return  # another program uses the topic
        if guard not in self._heard:
            self._log(f"the guard {guard} watches over the graph")
        self._heard[guard] = asyncio.get_running_loop().time()
        self._guarded.found[guard] = message["found"]
        if message["tripped"] and self._permits.get(guard) != trip:
            self._guarded.interrupt()
            self._permits[guard] = trip
            self._publish()
