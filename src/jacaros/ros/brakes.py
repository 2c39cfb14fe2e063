"""The brakes of a guard: publishers and clients for everything that agents drive.

They are opened before they are needed, because discovery takes longer than a robot may keep driving.
"""

import asyncio
import uuid
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any

from jacaros.ros.backend import Backend
from jacaros.ros.errors import RosError, ServiceError
from jacaros.ros.guarded import Named, velocity
from jacaros.ros.node import Publisher
from jacaros.ros.services import Client

CANCELLING = 0.25
"""Seconds between two requests to cancel all goals, and the maximum wait for an answer."""


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
            now = 0.0 if self.simulated_time else self._backend.clock.now()
            publisher.publish(velocity(publisher, kind, now))

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
