"""Debugging sessions over a WebSocket of the HTTP door, which has checked token, host and origin."""

import asyncio
from contextlib import suppress
from typing import Any

from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from jacaros.agents.language.offers import OPERATOR
from jacaros.editors.dap.relay import PATH
from jacaros.editors.dap.session import Channel, Session, Settings
from jacaros.editors.dap.wire import Message
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Crossing, Lagging, Outbox
from jacaros.serving.http.guard import caller_of
from jacaros.serving.http.problems import of_error


class DebugDoor(WebSocketRoute):
    """Serves debugging sessions to operators; the first message of each is `attach`. It belongs to the loop of the door.

    Args:
        system: the run; already served.
        crossing: the way to it.
    """

    def __init__(self, system: System, crossing: Crossing) -> None:
        super().__init__(PATH, self.serve)
        self._system, self._crossing = system, crossing

    async def __aenter__(self) -> "DebugDoor":
        return self

    async def __aexit__(self, *_: object) -> None:
        """Do nothing: the server ends its connections."""

    async def serve(self, socket: WebSocket) -> None:
        """Serve one session until the editor leaves, or the run ends."""
        if not caller_of(socket).has((OPERATOR,)):
            refused = RequestError("not_permitted", "only operators may debug")
            await socket.send_denial_response(of_error(refused))
            return
        await socket.accept()
        messages: Outbox[Message] = Outbox(asyncio.get_running_loop())
        writing = asyncio.create_task(_write(socket, messages))
        session: Session | None = None
        try:
            request: Any = await socket.receive_json()
            session = await self._crossing.call(self._begin, Channel(messages.put), request)
            while True:
                await self._crossing.call(session.take, await socket.receive_json())
        except (WebSocketDisconnect, RequestError, RuntimeError, ValueError):
            pass  # the editor, or the run, has gone
        finally:
            writing.cancel()
            if session is not None:
                with suppress(RequestError):
                    self._crossing.post(lambda: session.leave(end_run=False))

    def _begin(self, channel: Channel, request: Message) -> Session:
        session = Session(self._system, channel, Settings.of(request.get("arguments") or {}, launched=False))
        channel.respond(request)
        session.begin()
        return session


async def _write(socket: WebSocket, messages: Outbox[Message]) -> None:
    """Send messages until the task is cancelled; an editor that does not read is disconnected."""
    with suppress(WebSocketDisconnect, RuntimeError):
        try:
            while True:
                for each in await messages.take():
                    await socket.send_json(each)
        except Lagging:
            await socket.close(1008)
