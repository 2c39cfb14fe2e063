"""The resources: agents, goals, beliefs, questions, events, explanations and artifacts."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import suppress
from math import isfinite, nan
from typing import Any, TypeVar
from urllib.parse import quote

from starlette.requests import HTTPConnection, Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import BaseRoute, Route, Router, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket, WebSocketDisconnect

from jacaros.serving.arguments import reasons_of
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Lagging, Reply
from jacaros.serving.goals import REFUSED_STATE, RequestedGoal
from jacaros.serving.http.clients import Client, Stream, encoded
from jacaros.serving.http.endpoint import Answer, Endpoint, unknown
from jacaros.serving.http.guard import arguments_of, caller_of
from jacaros.serving.http.openapi import described, document
from jacaros.serving.http.problems import HEADERS, of_error, problem
from jacaros.serving.remote import RemoteCallers
from jacaros.serving.service import Session

SOON = 0.25
"""Seconds that the response to a new goal waits for the agent to accept or refuse it. A response that waits longer looks
from then on whether its client has left.
"""
LONGEST_WAIT = 60.0
"""Maximum seconds of ``Prefer: wait=N``."""
SHOWN, MOST_SHOWN = 100, 1_000
"""Default and maximum number of goals in a list."""
MOST_WATCHED = 50
"""Maximum number of beliefs that one event stream watches."""
HEARTBEAT = 15.0
"""Seconds of silence after which an event stream sends a comment, to notice dead clients."""
WRITES = 1_000
"""Maximum number of writes per second to all event streams together: with many streams, more events share a write."""

Mounted = ASGIApp | BaseRoute
"""A further application for requests, or a route of another kind, such as for WebSockets."""


class Resources:
    """The endpoints.

    Args:
        clients: who calls.
        title: name of the run.
    """

    def __init__(self, clients: RemoteCallers[Client], title: str) -> None:
        self._clients, self._title = clients, title
        self._streams = 0

    def app(self, mounts: Mapping[str, Mounted]) -> ASGIApp:
        """Return the application, with further ones at their paths, and further routes."""
        agent, goal = "/agents/{agent}", "/goals/{id}"
        belief, question = f"{agent}/beliefs", f"{agent}/questions"
        routes: list[BaseRoute] = [
            self._route(f"{agent}/goals/{{name:path}}", POST=self.achieve),
            self._route(goal, GET=self.goal, DELETE=self.cancel),
            self._route("/goals", GET=self.goals),
            self._route(f"{belief}/{{name:path}}", GET=self.beliefs, POST=self.tell, DELETE=self.tell),
            self._route(f"{question}/{{name:path}}", POST=self.ask),
            self._route(f"{agent}/goals", POST=self.achieve),
            self._route(belief, POST=self.tell, DELETE=self.tell),
            self._route(question, POST=self.ask),
            self._route("/events", GET=self.events),
            WebSocketRoute("/events", self.socket),
            self._route("/agents", GET=self.agents),
            self._route(agent, GET=self.agent),
            self._route("/openapi.json", GET=self.openapi),
            self._route("/why", GET=self.why),
            self._route("/artifacts", GET=self.artifacts),
            self._route("/questions", GET=self.questions),
            self._route("/questions/{id}", POST=self.answer),
            *(_route(path, each) for path, each in mounts.items()),
        ]
        return Router(routes, default=unknown)

    def _route(self, path: str, **methods: Callable[[Request, Client], Awaitable[Response]]) -> Route:
        def answering(method: Callable[[Request, Client], Awaitable[Response]]) -> Answer:
            return lambda request: method(request, self._client(request))

        return Route(path, Endpoint(**{name: answering(method) for name, method in methods.items()}))

    def _client(self, connection: "HTTPConnection[Any]") -> Client:
        return self._clients.of(caller_of(connection))

    # ---- what is offered

    async def openapi(self, _: Request, client: Client) -> Response:
        """``GET /openapi.json``: this interface, for the caller."""

        def found(session: Session) -> dict[str, Any]:
            return document(self._title, {name: session.offers(name) for name in session.agents()})

        return _json(await client.do(found))

    async def agents(self, _: Request, client: Client) -> Response:
        """``GET /agents``."""
        names = await client.do(Session.agents)
        return _json({"agents": [{"name": each, "url": f"/agents/{quote(each, '')}"} for each in names]})

    async def agent(self, request: Request, client: Client) -> Response:
        """``GET /agents/A``: what it offers to the caller."""
        name = request.path_params["agent"]
        return _json(described(name, await client.do(lambda session: session.offers(name))))

    # ---- goals

    async def achieve(self, request: Request, client: Client) -> Response:
        """``POST /agents/A/goals/G``, or ``/agents/A/goals`` with a text: give it a goal.

        The response comes when the goal is accepted or refused.
        """
        agent, name, given = await _requested(request)
        goal, data = await _waited(request, client, lambda session: session.achieve(agent, name, given), SOON)
        place = f"/goals/{data['id']}"
        if data["state"] == REFUSED_STATE:
            return problem("refused", goal.message, reasons_of(goal.reasons), goal=place)
        return _json(data, 201, {"Location": place, **_applied(request)})

    async def goals(self, request: Request, client: Client) -> Response:
        """``GET /goals``: the newest goals of the caller, or of all callers for an operator."""
        limit = min(_number(request, "limit", SHOWN), MOST_SHOWN)
        agent = request.query_params.get("agent")

        def newest(session: Session) -> list[dict[str, Any]]:
            found = [each for each in session.goals() if agent in (None, each.agent)]
            return [each.data() for each in found[-limit:]]

        return _json({"goals": await client.do(newest)})

    async def goal(self, request: Request, client: Client) -> Response:
        """``GET /goals/ID``."""
        id = request.path_params["id"]
        _, data = await _waited(request, client, lambda session: session.goal(id))
        return _json(data, headers=_applied(request))

    async def cancel(self, request: Request, client: Client) -> Response:
        """``DELETE /goals/ID``: cancel it."""
        id = request.path_params["id"]
        _, data = await _waited(request, client, lambda session: session.cancel(id))
        return _json(data, 202 if data["ended"] is None else 200, _applied(request))

    # ---- beliefs and questions

    async def beliefs(self, request: Request, client: Client) -> Response:
        """``GET /agents/A/beliefs/B``."""
        agent, name = request.path_params["agent"], request.path_params["name"]
        return _json({"beliefs": await client.do(lambda session: session.beliefs(agent, name))})

    async def tell(self, request: Request, client: Client) -> Response:
        """``POST`` and ``DELETE /agents/A/beliefs/B``, or ``/agents/A/beliefs``: tell a belief, or take it back."""
        agent, name, given = await _requested(request)
        await client.do(lambda session: session.tell(agent, name, given, request.method == "DELETE"))
        return Response(status_code=204, headers=HEADERS)

    async def ask(self, request: Request, client: Client) -> Response:
        """``POST /agents/A/questions/Q``, or ``/agents/A/questions``: ask it."""
        agent, name, given = await _requested(request)
        return _json({"answers": await client.do(lambda session: session.ask(agent, name, given))})

    async def why(self, request: Request, client: Client) -> Response:
        """``GET /why?question=…&at=…``: explain the run."""
        question = request.query_params.get("question", "")
        at = _real(request, "at")
        asking = asyncio.create_task(client.wait(lambda session: session.why(question, at)))
        found = await _within(request, asking, LONGEST_WAIT)
        if found is None:
            raise RequestError("unanswerable", f"the explanation takes longer than {LONGEST_WAIT:g} s")
        return _json({**found.data(), "text": found.text()})

    # ---- artifacts, and questions to a person

    async def artifacts(self, _: Request, client: Client) -> Response:
        """``GET /artifacts``."""
        return _json({"artifacts": await client.do(Session.artifacts)})

    async def questions(self, _: Request, client: Client) -> Response:
        """``GET /questions``: open questions of agents to a person."""
        return _json({"questions": await client.do(Session.questions)})

    async def answer(self, request: Request, client: Client) -> Response:
        """``POST /questions/ID``: answer one, with ``{"text": …}`` or ``{"option": N}``."""
        match await arguments_of(request):
            case {"text": str(given)} | {"option": int(given)}:
                pass
            case _:
                raise RequestError("invalid_arguments", 'expected {"text": "…"} or {"option": N}')
        id = request.path_params["id"]
        await client.wait(lambda session: session.answer(id, given))
        return Response(status_code=204, headers=HEADERS)

    # ---- events

    async def events(self, request: Request, client: Client) -> Response:
        """``GET /events``: server-sent events."""
        stream, stop = await client.begin(_beliefs(request))

        async def lines() -> AsyncIterator[str]:
            try:
                yield ": connected\n\n"
                async for some in self._paced(stream):
                    yield "".join(f"data: {each}\n\n" for each in some) or ":\n\n"
            finally:
                await asyncio.shield(client.end(stream, stop))

        return StreamingResponse(lines(), headers=HEADERS, media_type="text/event-stream")

    async def socket(self, socket: WebSocket) -> None:
        """The same events over a WebSocket."""
        client = self._client(socket)
        try:
            stream, stop = await client.begin(_beliefs(socket))
        except RequestError as error:
            await socket.send_denial_response(of_error(error))
            return
        try:
            await socket.accept()
            reading = asyncio.create_task(_until_closed(socket, stream))
            async for some in self._paced(stream):
                for each in some:
                    await socket.send_text(each)
            reading.cancel()
            await socket.close(1001)
        except (WebSocketDisconnect, RuntimeError):
            pass  # the client has gone
        finally:
            await asyncio.shield(client.end(stream, stop))

    async def _paced(self, stream: Stream) -> AsyncIterator[list[str]]:
        """Yield the events of a stream, with a rest between writes."""
        self._streams += 1
        try:
            async for some in messages(stream):
                yield some
                await asyncio.sleep(self._streams / WRITES)
        finally:
            self._streams -= 1


def _route(path: str, mounted: Mounted) -> BaseRoute:
    """Return the route of an application: this path, and none below it."""
    return mounted if isinstance(mounted, BaseRoute) else Route(path, mounted)


async def _until_closed(socket: WebSocket, stream: Stream) -> None:
    """Ignore what the client sends, and end the stream when it closes the connection."""
    with suppress(WebSocketDisconnect, RuntimeError):
        while (await socket.receive())["type"] != "websocket.disconnect":
            pass
    stream.put(None)


async def messages(stream: Stream) -> AsyncIterator[list[str]]:
    """Yield the events of a stream until its end, and empty lists in times of silence."""
    while True:
        try:
            async with asyncio.timeout(HEARTBEAT):
                found = await stream.take()
        except TimeoutError:
            found = []
        except Lagging:
            found = [encoded({"event": "lagging"}), None]
        yield [each for each in found if each is not None]
        if None in found:
            return


async def _waited(
    request: Request, client: Client, find: Callable[[Session], RequestedGoal], usual: float = 0.0
) -> tuple[RequestedGoal, dict[str, Any]]:
    """Return a goal and its data when it has ended, or the time that the client waits for that is over.

    Args:
        find: finds or gives the goal.
        usual: seconds to wait for the decision about the goal, if the client does not wait.
    """
    wait = _wait(request)
    found: list[RequestedGoal] = []

    def now(session: Session) -> RequestedGoal:
        if not found:
            found.append(find(session))
        return found[0]

    def look(session: Session, reply: Reply[dict[str, Any]]) -> None:
        goal = now(session)
        if wait or usual:
            goal.then(lambda: reply.give(goal.data()), bool(wait))
        else:
            reply.give(goal.data())

    data = await _within(request, client.ask(look), wait or usual or LONGEST_WAIT)
    if data is None:  # a request that has not begun is withdrawn
        data = await client.do(lambda session: now(session).data())
    return found[0], data


T = TypeVar("T")


async def _within(request: Request, work: "asyncio.Future[T]", wait: float) -> T | None:
    """Return the result of *work*, or None if it takes longer than *wait*, or the client leaves. It is then cancelled."""
    leaving: asyncio.Task[None] | None = None
    try:
        await asyncio.wait((work,), timeout=min(wait, SOON))
        if not work.done() and wait > SOON:
            leaving = asyncio.create_task(_left(request))
            await asyncio.wait((work, leaving), timeout=wait - SOON, return_when=asyncio.FIRST_COMPLETED)
        return work.result() if work.done() else None
    finally:
        work.cancel()
        if leaving is not None:
            leaving.cancel()


async def _left(request: Request) -> None:
    """Wait until the client closes the connection."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


def _json(data: Mapping[str, Any], status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    return Response(f"{encoded(data)}\n", status, {**HEADERS, **(headers or {})}, "application/json")


async def _requested(request: Request) -> tuple[str, str, dict[str, Any] | None]:
    """Return the agent, name and arguments of a request; or its text ``{"text": …}`` in the language, and None."""
    given, path = await arguments_of(request), request.path_params
    match given:
        case _ if "name" in path:
            return path["agent"], path["name"], given
        case {"text": str(written), **others} if not others:
            return path["agent"], written, None
    raise RequestError("invalid_arguments", 'expected {"text": "…"}')


def _wait(request: Request) -> float:
    """Return the seconds of ``Prefer: wait=N``; 0 without it."""
    for each in request.headers.get("prefer", "").split(","):
        name, _, value = each.strip().partition("=")
        if name == "wait" and value.isdecimal():
            return min(float(value), LONGEST_WAIT)
    return 0.0


def _applied(request: Request) -> Mapping[str, str]:
    return {"Preference-Applied": f"wait={wait:g}"} if (wait := _wait(request)) else {}


def _number(request: Request, name: str, default: int) -> int:
    found = _real(request, name)
    return default if found is None else max(1, int(found))


def _real(request: Request, name: str) -> float | None:
    written = request.query_params.get(name)
    try:
        found = None if written is None else float(written)
    except ValueError:
        found = nan
    if found is not None and not isfinite(found):
        raise RequestError("invalid_arguments", f"`{name}` must be a number")
    return found


def _beliefs(connection: "HTTPConnection[Any]") -> list[tuple[str, str]]:
    """Return the agents and beliefs in ``?beliefs=robot.battery,robot.place``."""
    found = []
    for each in ",".join(connection.query_params.getlist("beliefs")).split(","):
        agent, dot, name = each.strip().rpartition(".")
        if each.strip() and not (dot and agent):
            raise RequestError("invalid_arguments", f"expected ?beliefs=AGENT.BELIEF, found `{each[:80]}`")
        found += [(agent, name)] if dot else []
    if len(found) > MOST_WATCHED:
        raise RequestError("too_large", f"one stream watches at most {MOST_WATCHED} beliefs")
    return found
