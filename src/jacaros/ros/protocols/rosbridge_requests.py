"""Service calls through the bridge: numbered requests, their answers, and what the bridge itself is asked (rosapi)."""

import itertools
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from jacaros.clock import Clock
from jacaros.ros.errors import CallFailed, ServiceError, ServiceUnavailable

T = TypeVar("T")

_ABSENT = ("does not exist", "unavailable", "absent from")
"""What servers say of a service that nobody offers."""

Done = Callable[[dict[str, Any] | None, ServiceError | None], None]
"""Takes the fields of a response, or why there is none."""

LOOK_AGAIN, LOOK_STEADILY = 0.25, 1.0
"""Seconds after which what was seen of the graph is asked for again, when somebody wants to know: while there is nothing to
be seen, and when there is."""
PATIENCE = 3.0
"""Seconds for one answer of rosapi."""
ATTEMPTS, PAUSE = 6, 0.5
"""How often rosapi is asked whose graph it is, and seconds between: it may start after the server."""
FIRST_SIGN_OF_2 = "/msg/"
"""What the names of types have on ROS 2 alone."""
UNANSWERED = 10.0
"""Seconds after which a question that nobody answers is asked again."""


class Requests:
    """Calls under way.

    Args:
        send: hands an operation to the link; False when it is lost.
        ask: sends one and blocks until the answer is there, as `Link.ask` does.
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
        """How often the connection was lost: what was answered before the last time may not be so any more."""

    def begin(self, service: str, arguments: Any, done: Done, timeout: float | None = None) -> str:
        """Call *service*; *done* is called once, possibly immediately.

        Args:
            service: absolute name.
            arguments: fields of the request as JSON values.
            done: takes the answer.
            timeout: seconds after which a newer server may give the call up.

        Returns:
            the number under which the call can be given up.
        """
        operation = self._operation(service, arguments)
        number: str = operation["id"]
        self._pending[number] = (service, done)
        if timeout is not None:
            operation["timeout"] = timeout
        if not self._send(operation):
            self._end(
                number, None, CallFailed(f"service {service}: there is no connection to the rosbridge server")
            )
        return number

    def forget(self, number: str) -> None:
        """Give a call up: nobody wants its answer any more."""
        self._pending.pop(number, None)

    def answered(self, message: dict[str, Any]) -> None:
        """Take an answer of the server."""
        number, values = message.get("id"), message.get("values")
        if not isinstance(number, str):
            return
        if message.get("result", True):
            self._end(number, values if isinstance(values, dict) else {}, None)
        else:
            self._end(number, None, _failure(message.get("service", ""), values))

    def fail_all(self) -> None:
        """End all calls: the connection is lost, and answers with it."""
        self.interruptions += 1
        for number, (service, _) in list(self._pending.items()):
            text = f"service {service}: the connection to the rosbridge server was lost during the call"
            self._end(number, None, CallFailed(text))

    def _end(self, number: str, values: dict[str, Any] | None, problem: ServiceError | None) -> None:
        _, done = self._pending.pop(number, ("", None))
        if done is not None:
            done(values, problem)

    def call_blocking(self, service: str, arguments: Any, seconds: float) -> dict[str, Any] | None:
        """Call *service* and block until the answer is there, in any thread; None when it is a failure.

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
    """Translate the server's words; it has no other way to tell."""
    words = str(text)
    if any(sign in words for sign in _ABSENT):
        return ServiceUnavailable(f"nobody offers service {service}: {words}")
    return CallFailed(f"service {service}: {words}")


class Polled(Generic[T]):
    """Something of the graph that rosapi can tell, as it was seen a short time ago.

    Nothing is asked while nobody wants to know: reading the value asks again, and gives what is known.  What was seen over
    a connection that was lost is forgotten: the server may be another, and others too have to tell it again what they have.

    Args:
        requests: to ask with.
        service: of rosapi, such as ``/rosapi/subscribers``.
        arguments: of its request.
        read: takes the fields of the response.
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
        """What was seen last; asks again when that is some time ago."""
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
        except (KeyError, TypeError):  # another server's idea of rosapi
            self._value = self._unknown


@dataclass(frozen=True, slots=True)
class Greeting:
    """What was found out.

    Attributes:
        ros_version: 1 or 2.
        packs: the server can write CBOR; of ROS 2, the first ones lost messages over it.
        told: rosapi has answered; else ROS 2 is assumed.
    """

    ros_version: int
    packs: bool
    told: bool = True


async def greet(
    ask: Callable[[str, dict[str, Any], float], Awaitable[Any]], clock: Clock, is_up: Callable[[], bool]
) -> Greeting | None:
    """Ask rosapi; None when the connection is lost meanwhile.

    Args:
        ask: calls a service of rosapi, with a time-out.
        clock: measures the pauses.
        is_up: tells whether there is a connection.
    """
    for _ in range(ATTEMPTS):
        try:
            answer = await ask("get_ros_version", {}, PATIENCE)
            return Greeting(int(answer["version"]), packs=True)
        except (ServiceError, KeyError, TypeError, ValueError):
            pass  # ROS 1 does not have it, nor ROS 2 in its first years
        try:
            types = (await ask("topics", {}, PATIENCE))["types"]
            version = 2 if any(FIRST_SIGN_OF_2 in kind for kind in types) else 1
            return Greeting(version, packs=version == 1)
        except (ServiceError, KeyError, TypeError):
            await clock.sleep(PAUSE)
        if not is_up():
            return None
    return Greeting(2, packs=False, told=False)
