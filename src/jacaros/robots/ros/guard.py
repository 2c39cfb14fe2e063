"""The guard process, which stops the robot when its agents no longer can.

It receives the heartbeat of one process of agents (`jacaros.robots.ros.heartbeat`), on the same computer or over the graph,
and joins the same ROS graph under a name of its own.
"""

import asyncio
import json
import math
import secrets
import signal
import socket
import sys
import uuid
from collections.abc import Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import RosError, ServiceError
from jacaros.robots.ros.guarded import GuardedName, velocity
from jacaros.robots.ros.heartbeat import NEWEST, NO_GUARD, TEXT, line, topics_of
from jacaros.robots.ros.node import Publisher, Sample
from jacaros.robots.ros.services import Client
from jacaros.runtime.errors import UsageError

LEAVING = 5.0
"""Seconds without a heartbeat that agents may take to end."""


class HeartbeatMonitor:
    """Decides from heartbeats whether the robot must be stopped: a state machine without input, output or clock.

    idle      no agents, nothing to stop
    watching  heartbeats arrive
    tripped   they ceased: the robot is stopped until the agents return and release it

    Times are seconds of one monotonic clock.

    Args:
        timeout: seconds without a heartbeat after which the guard trips.
        on_trip: called with the reason when the guard trips.
        on_release: called when the agents may drive again.

    Attributes:
        agents: whether agents are connected.
        armed: whether they drive anything; otherwise there is nothing to stop.
        driving: whether the robot may be moving when heartbeats cease. Only agents on other computers report this:
            one that loses its network while its robot stands must not disturb other drivers of the robot.
        tripped: why the robot is being stopped; empty if it is not.
    """

    def __init__(
        self, timeout: float, on_trip: Callable[[str], None], on_release: Callable[[], None]
    ) -> None:
        self.agents = self.armed = False
        self.driving = True
        self.tripped = ""
        self._timeout = timeout
        self._on_trip, self._on_release = on_trip, on_release
        self._patience = timeout
        self._heard = 0.0

    def connect(self, now: float, timeout: float | None = None) -> None:
        """Note that agents have connected. A tripped guard stays tripped until they release it.

        Args:
            now: the time.
            timeout: seconds without a heartbeat, instead of those of the watch.
        """
        self.agents = self.driving = True
        self._patience = self._timeout if timeout is None else timeout
        self._heard = now

    def beat(self, now: float) -> None:
        """Note a heartbeat, or any other message of the agents."""
        self._heard = now

    def permit(self) -> None:
        """Release the robot: the agents are back and have interrupted their motions."""
        if self.tripped:
            self.tripped = ""
            self._on_release()

    def expect_end(self) -> None:
        """Note that the agents are shutting down and stop their robot themselves: heartbeats may be late."""
        self._patience = LEAVING

    def leave(self) -> None:
        """Note that the agents have ended normally and stopped their robot themselves."""
        self.agents = False
        self.permit()

    def lose(self) -> None:
        """Note that the connection broke without a goodbye: the agents' process has died."""
        self.agents = False
        self._trip("the agents' process died")

    def look(self, now: float) -> float:
        """Trip if heartbeats ceased. Return the seconds until the next check, at most the time-out."""
        if not self.agents or self.tripped or (self.driving and not self.armed):
            return self._timeout
        silence = now - self._heard
        if silence < self._patience:
            return self._patience - silence
        if self.driving:
            self._trip(f"no heartbeat from the agents for {silence:.2f} s")
        else:
            self.leave()
        return self._timeout

    def _trip(self, why: str) -> None:
        if self.armed and not self.tripped:
            self.tripped = why
            self._on_trip(why)


CANCELLING = 0.25
"""Seconds between two requests to cancel all goals, and the maximum wait for an answer."""


class Brakes:
    """Publishers and clients that stop everything the agents drive.

    They are opened before they are needed, because discovery takes longer than a robot may keep driving.

    Args:
        backend: the guard's node.
        log: called with one line.
    """

    def __init__(self, backend: Backend, log: Callable[[str], None]) -> None:
        self.simulated_time = False
        self._backend, self._log = backend, log
        self._topics: dict[GuardedName, Publisher] = {}
        self._clients: dict[GuardedName, Client] = {}
        """Of ROS 2's services that cancel goals."""
        self._cancels: dict[GuardedName, Publisher] = {}
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

    def cover(self, topics: list[GuardedName], actions: list[GuardedName]) -> None:
        """Open what is named, and close the rest."""
        _keep(self._topics, topics, self._open_topic, self._log)
        if self._backend.ros_version == 1:
            _keep(self._cancels, actions, self._open_cancel, self._log)
        else:
            _keep(self._clients, actions, self._open_client, self._log)

    def stop(self) -> None:
        """Send zero velocity to every topic."""
        for (_, kind), publisher in self._topics.items():
            now = 0.0 if self.simulated_time else self._backend.clock.now()
            publisher.publish(velocity(publisher, kind, now))

    def cancel(self) -> None:
        """Ask every action server to cancel all its goals, without waiting for the answers."""
        # In both protocols an empty id and no stamp mean all goals.
        for publisher in self._cancels.values():
            publisher.publish(publisher.message())
        for client in self._clients.values():
            self._begin(_call(client, {}))

    def _open_topic(self, item: GuardedName) -> Publisher:
        return self._backend.publisher(*item)

    def _open_cancel(self, item: GuardedName) -> Publisher:
        return self._backend.publisher(f"{item[0]}/cancel", "actionlib_msgs/msg/GoalID")

    def _open_client(self, item: GuardedName) -> Client:
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
    made: dict[GuardedName, Any],
    wanted: list[GuardedName],
    make: Callable[[GuardedName], Any],
    log: Callable[[str], None],
) -> None:
    for item in [item for item in made if item not in wanted]:
        made.pop(item).close()
    for item in wanted:
        if item not in made:
            try:
                made[item] = make(item)
            except RosError as problem:
                log(f"warning: {item[0]} cannot be stopped: {problem}")


PERIOD = 0.05
"""Seconds between two zero velocities while the robot is being stopped."""
CANCELLED = 2.0
"""Seconds during which goals are cancelled: one may be on its way. Later ones are not the agents'."""
CONNECTING = 15.0
"""Seconds that a guard for one run waits for its agents."""
GOODBYE = 5.0
"""Seconds that the agents have to end after guard and agents received a signal."""
ENDING = 1.0
"""Seconds for which a guard stops the robot even after a signal to end."""
TIMEOUT = 0.3
"""Seconds without a heartbeat from the same computer after which the guard stops the robot."""
NETWORK_TIMEOUT = 0.5
"""The same over the graph: Wi-Fi often delays messages by 0.3 s."""


class Guard:
    """Receives the heartbeat of one process of agents after another.

    Args:
        backend: the guard's node.
        agents: absolute name of the agents' node.
        path: path of the socket.
        timeout: seconds without a heartbeat after which it stops the robot; None: `TIMEOUT` and `NETWORK_TIMEOUT`.
        once: end when the agents have ended normally, or if none connect; agents on other computers are ignored.
        log: called with one line.
        orphaned: called when agents have died, after that was logged.
    """

    def __init__(
        self,
        backend: Backend,
        agents: str,
        path: Path,
        timeout: float | None,
        once: bool,
        log: Callable[[str], None],
        orphaned: Callable[[], None] = lambda: None,
    ) -> None:
        self._backend, self._agents, self._path, self._once, self._log = backend, agents, path, once, log
        self._orphaned = orphaned
        self._network_timeout = NETWORK_TIMEOUT if timeout is None else timeout
        self._watch = HeartbeatMonitor(TIMEOUT if timeout is None else timeout, self._trip, self._release)
        self._brakes = Brakes(backend, log)
        self._writer: asyncio.StreamWriter | None = None
        self._answer: Callable[[bytes], None] = lambda message: None
        self._run = ""
        """The run that is heard over the graph."""
        self._tripped_at = self._cancelled_at = -math.inf
        self._trip_id = ""
        self._reported: dict[str, int] = {}
        self._ending = False
        self._wake = asyncio.Event()
        self._wanted: tuple[list[GuardedName], list[GuardedName]] = ([], [])

    async def run(self) -> None:
        """Run until SIGINT or SIGTERM, or with *once* until the agents have ended.

        Raises:
            UsageError: another guard uses the same path, or the system has no Unix sockets.
        """
        if sys.platform == "win32":
            raise UsageError(NO_GUARD)
        loop = asyncio.get_running_loop()
        listening = _listening(self._path)
        made = self._path.stat().st_ino
        try:
            await self._backend.start()
            # Set afterwards: the backend's own handlers would refuse the messages that still stop the robot.
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                loop.add_signal_handler(number, self._end)
            server = await asyncio.start_unix_server(self._serve, sock=listening)
            if not self._once:
                self._listen()
            await self._guard(loop)
            server.close()
            await self._disconnect()
            await self._backend.close()
        finally:
            listening.close()
            with suppress(FileNotFoundError):
                if self._path.stat().st_ino == made:  # the next guard of these agents may have replaced it
                    self._path.unlink()

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
            self._forget_gone()
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
        self._trip_id = secrets.token_hex(4)
        self._brake(now)
        self._report()
        self._log(f"warning: {self._agents}: {why}; the guard {self._brakes.described} until they return")

    def _release(self) -> None:
        self._cover()
        self._log(f"{self._agents}: the guard has released the robot")

    def _forget_gone(self) -> None:
        if not (self._watch.agents or self._watch.tripped) and any(self._wanted):
            self._wanted = ([], [])
            self._cover()

    # ---- the heartbeat

    def _listen(self) -> None:
        """Listen to agents on other computers."""
        heartbeat, answer = topics_of(self._agents)
        publisher = self._backend.publisher(answer, TEXT, NEWEST)
        self._answer = lambda message: publisher.publish({"data": message.decode()})
        self._backend.subscription(heartbeat, TEXT, self._hear, NEWEST)

    def _hear(self, sample: Sample) -> None:
        """Take a heartbeat from the graph, unless the agents are on this computer and were heard already."""
        watch = self._watch
        try:
            message = json.loads(sample.message.data)
            run, driving, permits = message["run"], message["driving"], message["permits"]
        except (ValueError, KeyError, TypeError):
            return  # another program uses the topic
        if self._writer is not None or (run != self._run and watch.agents and not watch.tripped):
            return
        if not watch.agents:
            if self._ending:
                return  # a guard that is ending takes no agents, as at its socket
            watch.connect(asyncio.get_running_loop().time(), self._network_timeout)
        elif message["goodbye"] and watch.driving:
            self._brakes.stop()  # the zero velocity of the agents may have been lost
        self._run, watch.driving = run, driving
        self._take(message | {"permit": permits.get(self._backend.node_name)})

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        # Of two processes with one name, the first keeps its guard; one that is ending takes no others.
        if (self._writer is not None and not self._watch.tripped) or (
            self._ending and not self._watch.agents
        ):
            writer.close()
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
            self._brakes.simulated_time = message["simulated_time"]
            self._wanted = (_pairs(message["topics"]), _pairs(message["actions"]))
            if not self._watch.tripped:
                self._cover()
            self._report()
        elif self._brakes.found != self._reported:
            self._report()
        if message.get("leaving"):
            self._watch.expect_end()
        if message.get("permit") == self._trip_id:
            self._watch.permit()
        if message.get("goodbye"):
            self._watch.leave()
            self._forget_gone()
            self._ending = self._ending or self._once

    def _cover(self) -> None:
        self._watch.armed = any(self._wanted)
        self._brakes.cover(*self._wanted)

    def _report(self) -> None:
        self._reported = self._brakes.found
        state = line(
            guard=self._backend.node_name,
            found=self._reported,
            tripped=self._watch.tripped,
            trip=self._trip_id,
        )
        if self._writer is not None:
            self._writer.write(state)
        elif self._watch.agents:
            self._answer(state)


def _pairs(written: list[list[str]]) -> list[GuardedName]:
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
