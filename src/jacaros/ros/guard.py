"""The guard process, which stops the robot when its agents no longer can.

It receives the heartbeat of one process of agents (`jacaros.ros.heartbeat`) and joins the same ROS graph under a name
of its own. It opens publishers and clients for everything the agents drive before they are needed, because discovery
takes longer than a robot may keep driving.
"""

import asyncio
import json
import math
import signal
import socket
import sys
import uuid
from collections.abc import Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.ros.backend import Backend, Client, Publisher
from jacaros.ros.errors import RosError, ServiceError
from jacaros.ros.guarded import Named
from jacaros.ros.guarding import Watch
from jacaros.ros.heartbeat import NO_GUARD, line

PERIOD = 0.05
"""Seconds between two zero velocities while the robot is being stopped."""
CANCELLING = 0.25
"""Seconds between two requests to cancel all goals, and the maximum wait for an answer."""
CANCELLED = 2.0
"""Seconds during which goals are cancelled: one may be on its way. Later ones are not the agents'."""
CONNECTING = 15.0
"""Seconds that a guard for one run waits for its agents."""
GOODBYE = 5.0
"""Seconds that the agents have to end after guard and agents received a signal."""
ENDING = 1.0
"""Seconds for which a guard stops the robot even after a signal to end."""
STAMPED = "geometry_msgs/msg/TwistStamped"


class Brakes:
    """Publishers and clients that stop everything the agents drive.

    Args:
        backend: the guard's node.
        log: called with one line.
    """

    def __init__(self, backend: Backend, log: Callable[[str], None]) -> None:
        self.simulated_time = False
        self._backend, self._log = backend, log
        self._topics: dict[Named, Publisher] = {}
        self._clients: dict[Named, Client] = {}
        """Of ROS 2's services that cancel goals."""
        self._cancels: dict[Named, Publisher] = {}
        """Of actionlib's topics that cancel goals."""
        self._asking: set[asyncio.Future[Any]] = set()
        self._acquainted: set[str] = set()
        """Names of actions whose server has answered a request to cancel."""

    @property
    def found(self) -> dict[str, int]:
        """The number of receivers of each topic and action. Where it is 0, nothing can be stopped yet."""
        publishers = (*self._topics.items(), *self._cancels.items())
        counts = {name: publisher.subscription_count for (name, _), publisher in publishers}
        return counts | {name: int(name in self._acquainted) for name, _ in self._clients}

    @property
    def described(self) -> str:
        """Text that lists what is stopped."""
        goals = [f"cancels all goals of {name}" for name, _ in (*self._clients, *self._cancels)]
        return ", ".join([*goals, *(f"sends zero velocity to {name}" for name, _ in self._topics)])

    def cover(self, topics: list[Named], actions: list[Named]) -> None:
        """Open what is named, and close the rest."""
        _keep(self._topics, topics, self._open_topic, self._log)
        if self._backend.ros_version == 1:
            _keep(self._cancels, actions, self._open_cancel, self._log)
        else:
            _keep(self._clients, actions, self._open_client, self._log)

    def stop(self) -> None:
        """Send zero velocity to every topic."""
        for (_, kind), publisher in self._topics.items():
            message = publisher.message()
            if kind == STAMPED and not self.simulated_time:
                # A zero stamp means "now"; some bases require a real one.
                message = publisher.message(header={"stamp": self._backend.clock.now()})
            publisher.publish(message)

    def cancel(self) -> None:
        """Ask every action server to cancel all its goals, without waiting for the answers."""
        # In both protocols an empty id and no stamp mean all goals.
        for publisher in self._cancels.values():
            publisher.publish(publisher.message())
        for client in self._clients.values():
            self._begin(_call(client, {}))

    def _open_topic(self, item: Named) -> Publisher:
        return self._backend.publisher(*item)

    def _open_cancel(self, item: Named) -> Publisher:
        return self._backend.publisher(f"{item[0]}/cancel", "actionlib_msgs/msg/GoalID")

    def _open_client(self, item: Named) -> Client:
        client = self._backend.client(f"{item[0]}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        self._acquainted.discard(item[0])
        self._begin(self._get_acquainted(item[0], client))
        return client

    async def _get_acquainted(self, action: str, client: Client) -> None:
        """Cancel a goal that does not exist: the first call to a server is slower than later ones."""
        nothing = {"goal_info": {"goal_id": {"uuid": list(uuid.uuid4().bytes)}}}
        with suppress(RosError):
            await client.call(nothing, None)
            self._acquainted.add(action)

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.ensure_future(work)
        self._asking.add(task)
        task.add_done_callback(self._asking.discard)


async def _call(client: Client, request: dict[str, Any]) -> None:
    with suppress(ServiceError):
        await client.call(request, CANCELLING)


def _keep(
    made: dict[Named, Any], wanted: list[Named], make: Callable[[Named], Any], log: Callable[[str], None]
) -> None:
    for item in [item for item in made if item not in wanted]:
        made.pop(item).close()
    for item in wanted:
        if item not in made:
            try:
                made[item] = make(item)
            except RosError as problem:
                log(f"warning: {item[0]} cannot be stopped: {problem}")


class Guard:
    """Receives the heartbeat of one process of agents after another.

    Args:
        backend: the guard's node.
        path: path of the socket.
        timeout: seconds without a heartbeat after which it stops the robot.
        once: end when the agents have ended normally, or if none connect.
        log: called with one line.
        orphaned: called when agents have died, after that was logged.
    """

    def __init__(
        self,
        backend: Backend,
        path: Path,
        timeout: float,
        once: bool,
        log: Callable[[str], None],
        orphaned: Callable[[], None] = lambda: None,
    ) -> None:
        self._backend, self._path, self._once, self._log = backend, path, once, log
        self._orphaned = orphaned
        self._watch = Watch(timeout, self._trip, self._release)
        self._brakes = Brakes(backend, log)
        self._writer: asyncio.StreamWriter | None = None
        self._node = "the agents"
        self._tripped_at = self._cancelled_at = -math.inf
        self._trips = 0
        self._reported: dict[str, int] = {}
        self._ending = False
        self._wake = asyncio.Event()
        self._wanted: tuple[list[Named], list[Named]] = ([], [])

    async def run(self) -> None:
        """Run until SIGINT or SIGTERM, or with *once* until the agents have ended.

        Raises:
            UsageError: another guard uses the same path, or the system has no Unix sockets.
        """
        if sys.platform == "win32":
            raise UsageError(NO_GUARD)
        loop = asyncio.get_running_loop()
        listening = _listening(self._path)
        try:
            await self._backend.start()
            # Set afterwards: the backend's own handlers would refuse the messages that still stop the robot.
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                loop.add_signal_handler(number, self._end)
            server = await asyncio.start_unix_server(self._serve, sock=listening)
            await self._guard(loop)
            server.close()
            await self._disconnect()
            await self._backend.close()
        finally:
            listening.close()
            self._path.unlink(missing_ok=True)

    async def _disconnect(self) -> None:
        writer, self._writer = self._writer, None
        if writer is not None:
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()

    async def _guard(self, loop: asyncio.AbstractEventLoop) -> None:
        deadline = loop.time() + CONNECTING if self._once else math.inf
        while True:
            now = loop.time()
            rest = min(self._watch.look(now), PERIOD if self._watch.tripped else 1.0)
            if self._watch.tripped:
                self._brake(now)
            if self._ending and not self._watch.agents and now - self._tripped_at >= ENDING:
                return
            if self._watch.agents:
                deadline = math.inf
            if now > deadline:
                return
            self._wake.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), rest)

    def _brake(self, now: float) -> None:
        self._brakes.stop()
        if now - self._tripped_at < CANCELLED and now - self._cancelled_at >= CANCELLING:
            self._cancelled_at = now
            self._brakes.cancel()

    def _end(self) -> None:
        """Handle a signal: end, but not before the agents, which have probably received it, too."""
        self._ending = True
        asyncio.get_running_loop().call_later(GOODBYE, self._watch.leave)
        self._wake.set()

    def _trip(self, why: str) -> None:
        now = asyncio.get_running_loop().time()
        self._tripped_at, self._cancelled_at = now, -math.inf
        self._trips += 1
        self._brake(now)
        self._report()
        self._log(f"warning: {self._node}: {why}; the guard {self._brakes.described} until they return")

    def _release(self) -> None:
        self._cover()
        self._log(f"{self._node}: the guard has released the robot")

    # ---- the heartbeat

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._watch.agents and not self._watch.tripped:
            writer.close()  # two processes with one name: the first keeps its guard
            return
        if self._writer is not None:
            self._writer.close()  # that of a frozen process
        self._writer = writer
        self._watch.connect(asyncio.get_running_loop().time())
        with suppress(OSError, ValueError):
            while text := await reader.readline():
                if self._writer is writer:
                    self._take(json.loads(text))
        writer.close()
        if self._writer is writer:
            self._writer = None
            if self._watch.agents:
                self._watch.lose()
                self._orphaned()
        self._wake.set()

    def _take(self, message: dict[str, Any]) -> None:
        self._watch.beat(asyncio.get_running_loop().time())
        if "topics" in message:
            self._node = message["node"]
            self._brakes.simulated_time = message["simulated_time"]
            self._wanted = (_pairs(message["topics"]), _pairs(message["actions"]))
            if not self._watch.tripped:
                self._cover()
            self._report()
        elif self._brakes.found != self._reported:
            self._report()
        if message.get("leaving"):
            self._watch.expect_end()
        if message.get("permit") == self._trips:
            self._watch.permit()
        if message.get("goodbye"):
            self._wanted = ([], [])
            self._watch.leave()
            self._cover()
            self._ending = self._ending or self._once

    def _cover(self) -> None:
        self._watch.armed = any(self._wanted)
        self._brakes.cover(*self._wanted)

    def _report(self) -> None:
        self._reported = self._brakes.found
        if self._writer is not None:
            self._writer.write(line(found=self._reported, tripped=self._watch.tripped, trip=self._trips))


def _pairs(written: list[list[str]]) -> list[Named]:
    return [(name, kind) for name, kind in written]


def _listening(path: Path) -> socket.socket:
    """Listen at *path*, in place of a dead guard."""
    if sys.platform == "win32":
        raise UsageError(NO_GUARD)
    made = socket.socket(socket.AF_UNIX)
    try:
        made.connect(str(path))
    except OSError:
        path.unlink(missing_ok=True)
    else:
        made.close()
        raise UsageError("another guard of these agents is already running")
    made.close()
    made = socket.socket(socket.AF_UNIX)
    made.bind(str(path))
    return made
