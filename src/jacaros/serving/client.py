"""A client of a running system over HTTP, which needs the standard library only."""

import json
import ssl
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException, HTTPResponse, HTTPSConnection
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, urlencode, urlsplit

from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.serving.running import RunningService

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

PATIENCE = 10.0
"""Seconds for the response to a request that does not wait for anything."""
WAIT = 60
"""Seconds that the server waits at most for the end of a goal or an explanation."""
SILENCE = 40.0
"""Seconds of silence after which an event stream counts as dead; the server sends something every 15 s."""

Json = dict[str, Any]


class ServiceError(JacarosError):
    """The system has refused a request, which has no effect.

    Attributes:
        code: what is wrong, such as ``not_offered``; see `docs/how-to/give_goals_over_http.md`.
        message: the same in words.
        reasons: terms that say why, as text.
        document: the whole problem document.
    """

    def __init__(self, document: Mapping[str, Any]) -> None:
        self.document = document
        self.code, self.message = str(document.get("code", "")), str(document.get("detail", ""))
        self.reasons = tuple(map(str, document.get("reasons", ())))
        super().__init__(self.message)


class Unreachable(JacarosError):
    """The system does not answer: it has ended, or the network is down."""


@dataclass(frozen=True)
class Offered:
    """Something that an agent offers.

    Attributes:
        agent: name of the agent.
        kind: ``goal``, ``belief``, ``question``, ``tell`` or ``event``.
        name: its name.
        form: its name with its arguments, for people.
        doc: what it means.
        choices: the possible values of each argument; empty for any.
    """

    agent: str
    kind: str
    name: str
    form: str
    doc: str
    choices: tuple[tuple[str, ...], ...]


class Client:
    """A client of a running system. Each request has a connection of its own, so any thread may ask.

    Args:
        url: where the system serves, such as ``http://127.0.0.1:8000``.
        token: the caller's token.
        certificate: file with the certificate of the system; empty for those that this computer trusts.

    Raises:
        UsageError: the URL is invalid.
    """

    def __init__(self, url: str, token: str, certificate: str = "") -> None:
        place = urlsplit(url if "://" in url else f"http://{url}")
        try:
            self._port = place.port
        except ValueError:
            self._port = -1
        if place.scheme not in ("http", "https") or not place.hostname or self._port == -1:
            raise UsageError(f"error: invalid URL: `{url}`\n  = help: expected such as http://127.0.0.1:8000")
        self._host, self._path = place.hostname, place.path.rstrip("/")
        self.url, self._token = place.geturl(), token
        self._tls = _tls(certificate) if place.scheme == "https" else None

    @classmethod
    def of(cls, service: RunningService) -> "Client":
        """Return a client of a system of this user."""
        return cls(service.url, service.token, service.certificate)

    # ---- what is offered

    def agents(self) -> list[str]:
        """Return the names of the agents that offer something."""
        return [each["name"] for each in self._ask("GET", "/agents")["agents"]]

    def offers(self) -> list[Offered]:
        """Return what all agents offer."""
        found = []
        for agent in self.agents():
            for entries in self._ask("GET", _below(agent)).values():
                if isinstance(entries, list):
                    found += [_offered(agent, each) for each in entries]
        return found

    # ---- requests in the language

    def achieve(self, agent: str, goal: str) -> Json:
        """Give an agent a goal, such as ``deliver("p1", kitchen)``. Return its data, which may say that it is refused.

        Raises:
            ServiceError: the goal is not offered, or its arguments are wrong.
        """
        try:
            return self._ask("POST", _below(agent, "goals"), {"text": goal})
        except ServiceError as error:
            if error.code != "refused":
                raise
            return self.goal(str(error.document["goal"]).rpartition("/")[2])

    def ask(self, agent: str, question: str) -> list[Json]:
        """Ask an agent a question, such as ``battery(Level)``. Return the variables of each answer."""
        return list(self._ask("POST", _below(agent, "questions"), {"text": question})["answers"])

    def tell(self, agent: str, belief: str, untell: bool = False) -> None:
        """Tell an agent a belief, or take it back."""
        self._ask("DELETE" if untell else "POST", _below(agent, "beliefs"), {"text": belief})

    # ---- goals, beliefs and explanations

    def goal(self, id: str) -> Json:
        """Return the data of a goal."""
        return self._ask("GET", f"/goals/{quote(id, '')}")

    def goals(self, limit: int = 20) -> list[Json]:
        """Return the newest goals, the newest last."""
        return list(self._ask("GET", f"/goals?limit={limit}")["goals"])

    def cancel(self, id: str) -> Json:
        """Cancel a goal. Return its data."""
        return self._ask("DELETE", f"/goals/{quote(id, '')}")

    def beliefs(self, agent: str, name: str) -> list[Json]:
        """Return the beliefs that an agent offers under a name."""
        return list(self._ask("GET", _below(agent, "beliefs", name))["beliefs"])

    def why(self, question: str) -> str:
        """Return an explanation as text."""
        path = f"/why?{urlencode({'question': question})}"
        return str(self._ask("GET", path, seconds=WAIT + PATIENCE)["text"])

    # ---- questions of agents to a person

    def questions(self) -> list[Json]:
        """Return the open questions of agents to a person."""
        return list(self._ask("GET", "/questions")["questions"])

    def answer(self, id: str, given: str | int) -> None:
        """Answer a question with a text, or with the number of an option."""
        body = {"text" if isinstance(given, str) else "option": given}
        self._ask("POST", f"/questions/{quote(id, '')}", body)

    # ---- events

    @contextmanager
    def events(self, beliefs: Sequence[str] = ()) -> Iterator[Iterator[Json]]:
        """Open a stream of events: goals, announced events, and beliefs such as ``bob.battery``.

        Events from now on are in the stream, even before the first one is read. It ends when the system ends, and when
        you read it too slowly.
        """
        query = f"?{urlencode({'beliefs': ','.join(beliefs)})}" if beliefs else ""
        with closing(self._connection(SILENCE)) as connection:
            yield _events(self._response(connection, "GET", f"/events{query}", None))

    def follow(self, begin: Callable[[], Json]) -> Iterator[Json]:
        """Give or cancel a goal by *begin*, and yield its data at each change until it has ended.

        The first data are those of a pending goal: what has happened to it meanwhile follows.
        """
        found: Json = {}
        while found.get("ended") is None:
            with self.events() as events:
                if found:
                    yield (found := self.goal(found["id"]))
                elif (found := begin())["ended"] is None:
                    yield {**found, "state": "pending", "progress": None, "note": ""}
                else:
                    yield found
                for event in events if found["ended"] is None else ():
                    if event["event"] == "goal" and event["id"] == found["id"]:
                        yield (found := event)
                        if found["ended"] is not None:
                            break

    # ---- WebSockets

    @contextmanager
    def socket(self, path: str) -> "Iterator[ClientConnection]":
        """Open a WebSocket. Its messages end when the system ends.

        Raises:
            ServiceError: the system has refused it.
            Unreachable: it does not answer.
        """
        from websockets.exceptions import InvalidStatus, WebSocketException  # here: few clients need it
        from websockets.sync.client import connect

        url = f"ws{self.url.removeprefix('http')}{path}"
        headers = {"Authorization": f"Bearer {self._token}"}
        with self._network():
            try:
                opened = connect(url, additional_headers=headers, ssl=self._tls, max_size=None)
            except InvalidStatus as refused:
                raise ServiceError(json.loads(refused.response.body or b"{}")) from None
            except WebSocketException as error:
                raise ValueError(str(error)) from None
        with opened:
            yield opened

    # ---- HTTP

    def _ask(self, method: str, path: str, body: Json | None = None, seconds: float = PATIENCE) -> Json:
        with closing(self._connection(seconds)) as connection, self._network():
            text = self._response(connection, method, path, body).read()
            return dict(json.loads(text)) if text else {}

    def _response(
        self, connection: HTTPConnection, method: str, path: str, body: Json | None
    ) -> HTTPResponse:
        """Send a request. Return the response.

        Raises:
            ServiceError: the system has refused it.
            Unreachable: it does not answer.
        """
        headers = {"Authorization": f"Bearer {self._token}", "Connection": "close"}
        data = None if body is None else json.dumps(body).encode()
        if data is not None:
            headers["Content-Type"] = "application/json"
        with self._network():
            connection.request(method, self._path + path, data, headers)
            response = connection.getresponse()
            if response.status >= 400:
                raise ServiceError(_problem(response))
            return response

    @contextmanager
    def _network(self) -> Iterator[None]:
        try:
            yield
        except (OSError, HTTPException, ValueError) as error:
            told = f"error: no answer from {self.url}: {error or type(error).__name__}"
            raise Unreachable(f"{told}\n  = help: start it: jacaros run FILE --serve PORT") from None

    def _connection(self, seconds: float) -> HTTPConnection:
        if self._tls is None:
            return HTTPConnection(self._host, self._port, timeout=seconds)
        return HTTPSConnection(self._host, self._port, timeout=seconds, context=self._tls)


def _below(agent: str, *names: str) -> str:
    """Return a path below an agent."""
    return "/".join(["/agents", *(quote(each, "") for each in (agent, *names))])


def _tls(certificate: str) -> ssl.SSLContext:
    if not certificate:
        return ssl.create_default_context()
    # Exactly this certificate is trusted, whatever names it has.
    context = ssl.create_default_context(cafile=certificate)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    return context


def _problem(response: HTTPResponse) -> Json:
    try:
        found = json.loads(response.read())
    except ValueError:
        found = None
    told = f"{response.status} {response.reason}"
    return found if isinstance(found, dict) and "detail" in found else {"code": "", "detail": told}


def _events(response: HTTPResponse) -> Iterator[Json]:
    """Yield the events of a stream until it ends."""
    with suppress(OSError, HTTPException):  # the next request shows what is wrong
        for line in response:
            if line.startswith(b"data: "):
                yield json.loads(line[6:])


def _offered(agent: str, entry: Json) -> Offered:
    properties = entry["arguments"].get("properties", {})
    choices = tuple(tuple(map(str, each.get("enum", ()))) for each in properties.values())
    return Offered(agent, entry["what"], entry["name"], entry["form"], entry["doc"], choices)
