"""Service calls through the bridge: numbered requests, their answers, and requests to the bridge itself (rosapi)."""

import itertools
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from jacaros.ros.errors import CallFailed, ServiceError, ServiceUnavailable
from jacaros.runtime.clock import Clock

T = TypeVar("T")

_ABSENT = ("does not exist", "unavailable", "absent from")
"""Parts of the server's error for a missing service."""

Done = Callable[[dict[str, Any] | None, ServiceError | None], None]
"""Takes the fields of a response, or the error."""

LOOK_AGAIN, LOOK_STEADILY = 0.25, 1.0
"""Seconds after which a polled value is requested again: while it is empty, and otherwise."""
PATIENCE = 3.0
"""Seconds for one answer of rosapi."""
ATTEMPTS, PAUSE = 6, 0.5
"""Number of requests for the version of ROS, and seconds between them: rosapi may start after the server."""
FIRST_SIGN_OF_2 = "/msg/"
"""Part of the names of types on ROS 2 only."""
UNANSWERED = 10.0
"""Seconds after which an unanswered request is repeated."""


class Requests:
    """Pending calls.

    Args:
        send: passes an operation to the link. Returns False if it is lost.
        ask: sends one and blocks until the answer arrives, as `Link.ask` does.
    """

    def __init__(
        self,
        send: Callable[[dict[str, Any]], bool],
        ask: Callable[[dict[str, Any], float], dict[str, Any] | None],
    ) -> None:
        self._send = send
        self._ask = ask
        self._numbers = itertools.count(1)
        self._pending: dict[str, tuple[str, Done]] = {}
        self.interruptions = 0
        """Number of lost connections: earlier answers may no longer be valid."""

    def begin(self, service: str, arguments: Any, done: Done, timeout: float | None = None) -> str:
        """Call *service*; *done* is called once, possibly immediately.

        Args:
            service: absolute name.
            arguments: fields of the request as JSON values.
            done: called with the answer.
            timeout: seconds after which a newer server may drop the call.

        Returns:
            The number with which the call can be dropped.
        """
        operation = self._operation(service, arguments)
        number: str = operation["id"]
        self._pending[number] = (service, done)
        if timeout is not None:
            operation["timeout"] = timeout
        if not self._send(operation):
            self._end(number, None, CallFailed(f"service {service}: no connection to the rosbridge server"))
        return number

    def forget(self, number: str) -> None:
        """Drop a call: its answer is no longer needed."""
        self._pending.pop(number, None)

    def answered(self, message: dict[str, Any]) -> None:
        """Handle an answer of the server."""
        number, values = message.get("id"), message.get("values")
        if not isinstance(number, str):
            return
        if message.get("result", True):
            self._end(number, values if isinstance(values, dict) else {}, None)
        else:
            self._end(number, None, _failure(message.get("service", ""), values))

    def fail_all(self) -> None:
        """Fail all calls: the connection is lost, and their answers with it."""
        self.interruptions += 1
        for number, (service, _) in list(self._pending.items()):
            text = f"service {service}: the connection to the rosbridge server was lost during the call"
            self._end(number, None, CallFailed(text))

    def _end(self, number: str, values: dict[str, Any] | None, problem: ServiceError | None) -> None:
        _, done = self._pending.pop(number, ("", None))
        if done is not None:
            done(values, problem)

    def call_blocking(self, service: str, arguments: Any, seconds: float) -> dict[str, Any] | None:
        """Call *service* and block until the answer arrives, in any thread; None if it is a failure.

        Raises:
            TimeoutError: there is no answer within *seconds*.
        """
        answer = self._ask(self._operation(service, arguments), seconds)
        if answer is None or not answer.get("result", True):
            return None
        values = answer.get("values")
        return values if isinstance(values, dict) else {}

    def _operation(self, service: str, arguments: Any) -> dict[str, Any]:
        number = f"call_service:{service}:{next(self._numbers)}"
        return {"op": "call_service", "id": number, "service": service, "args": arguments}


def _failure(service: str, text: object) -> ServiceError:
    """Classify an error of the server, which consists of text only."""
    words = str(text)
    if any(sign in words for sign in _ABSENT):
        return ServiceUnavailable(f"no node offers service {service}: {words}")
    return CallFailed(f"service {service}: {words}")


class Polled(Generic[T]):
    """A value of the graph that rosapi reports, polled on demand.

    Nothing is requested unless the value is read: reading it returns the last known value and requests a new one if
    necessary. Values of a lost connection are forgotten: the server may be another one, and other nodes must register
    with it again.

    Args:
        requests: sends the requests.
        service: service of rosapi, such as ``/rosapi/subscribers``.
        arguments: fields of its request.
        read: reads the fields of the response.
        unknown: the value before the first answer, and after a failure.
    """

    def __init__(
        self,
        requests: Requests,
        service: str,
        arguments: dict[str, Any],
        read: Callable[[dict[str, Any]], T],
        unknown: T,
    ) -> None:
        self._requests = requests
        self._service = service
        self._arguments = arguments
        self._read = read
        self._unknown = unknown
        self._value = unknown
        self._asked = -LOOK_AGAIN
        self._interruptions = requests.interruptions
        self.asking = False

    @property
    def value(self) -> T:
        """The last known value; requests a new one if it is old."""
        now = time.monotonic()
        if self._interruptions != self._requests.interruptions:
            self._interruptions = self._requests.interruptions
            self._value, self._asked, self.asking = self._unknown, -LOOK_AGAIN, False
        # A server that may not serve rosapi to us does not answer at all.
        pause = UNANSWERED if self.asking else LOOK_STEADILY if self._value else LOOK_AGAIN
        if now - self._asked >= pause:
            self._asked, self.asking = now, True
            self._requests.begin(self._service, self._arguments, self._seen)
        return self._value

    def _seen(self, values: dict[str, Any] | None, _: ServiceError | None) -> None:
        self.asking = False
        try:
            self._value = self._unknown if values is None else self._read(values)
        except (KeyError, TypeError):  # another version of rosapi
            self._value = self._unknown


@dataclass(frozen=True, slots=True)
class Greeting:
    """The properties of a server.

    Attributes:
        ros_version: 1 or 2.
        packs: whether the server can send CBOR; early servers of ROS 2 lost messages with it.
        told: whether rosapi has answered; otherwise ROS 2 is assumed.
    """

    ros_version: int
    packs: bool
    told: bool = True


async def greet(
    ask: Callable[[str, dict[str, Any], float], Awaitable[Any]], clock: Clock, is_up: Callable[[], bool]
) -> Greeting | None:
    """Ask rosapi for the version of ROS; None if the connection is lost meanwhile.

    Args:
        ask: calls a service of rosapi, with a time-out.
        clock: measures the pauses.
        is_up: returns whether there is a connection.
    """
    for _ in range(ATTEMPTS):
        try:
            answer = await ask("get_ros_version", {}, PATIENCE)
            return Greeting(int(answer["version"]), packs=True)
        except (ServiceError, KeyError, TypeError, ValueError):
            pass  # neither ROS 1 nor early ROS 2 has this service
        try:
            types = (await ask("topics", {}, PATIENCE))["types"]
            version = 2 if any(FIRST_SIGN_OF_2 in kind for kind in types) else 1
            return Greeting(version, packs=version == 1)
        except (ServiceError, KeyError, TypeError):
            await clock.sleep(PAUSE)
        if not is_up():
            return None
    return Greeting(2, packs=False, told=False)
