"""Conversations with operators over WebSockets: JSON in both directions."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from typing import Any

from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from jacaros.agents.language.offers import OPERATOR
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Lagging, Outbox
from jacaros.serving.http.guard import caller_of
from jacaros.serving.http.problems import of_error


class Gone(Exception):
    """Raised when the other side of a conversation has left, or sends something that is not a JSON object."""


class Conversation:
    """An open WebSocket. It belongs to the loop of the door.

    Args:
        socket: the WebSocket.
    """

    def __init__(self, socket: WebSocket) -> None:
        self._socket = socket
        self._messages: Outbox[Mapping[str, Any]] = Outbox(asyncio.get_running_loop())
        self.send = self._messages.put
        """Sends a message soon; any thread may call it."""

    async def receive(self) -> Mapping[str, Any]:
        """Wait for a message.

        Raises:
            Gone: there will be none.
        """
        try:
            message = await self._socket.receive_json()
        except (WebSocketDisconnect, RuntimeError, ValueError, KeyError) as error:
            raise Gone from error
        if not isinstance(message, dict):
            raise Gone
        return message

    async def write(self) -> None:
        """Send messages until the task is cancelled; a client that does not read is disconnected."""
        with suppress(WebSocketDisconnect, RuntimeError):
            try:
                while True:
                    for each in await self._messages.take():
                        await self._socket.send_json(each)
            except Lagging:
                await self._socket.close(1008)


def operator_socket(path: str, talk: Callable[[Conversation], Awaitable[None]], may: str) -> WebSocketRoute:
    """Return the route of a WebSocket for operators.

    Args:
        path: its path.
        talk: leads a conversation to its end.
        may: what only operators may do, for the refusal of others, such as ``debug``.
    """

    async def serve(socket: WebSocket) -> None:
        if not caller_of(socket).has((OPERATOR,)):
            refused = RequestError("not_permitted", f"only operators may {may}")
            await socket.send_denial_response(of_error(refused))
            return
        await socket.accept()
        conversation = Conversation(socket)
        writing = asyncio.create_task(conversation.write())
        try:
            await talk(conversation)
        finally:
            writing.cancel()

    return WebSocketRoute(path, serve)
