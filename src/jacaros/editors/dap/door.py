"""Debugging sessions over a WebSocket of the HTTP door, which has checked token, host and origin."""

from contextlib import suppress
from typing import TYPE_CHECKING

from jacaros.editors.dap.channel import Channel
from jacaros.editors.dap.relay import PATH
from jacaros.editors.dap.session import Session, Settings
from jacaros.editors.dap.wire import Message
from jacaros.runtime.mas.system import System
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Crossing
from jacaros.serving.http.sockets import Conversation, Gone, operator_socket

if TYPE_CHECKING:
    from jacaros.serving.http.app import Mounted


class DebugDoor:
    """Serves debugging sessions to operators; the first message of each is `attach`. It belongs to the loop of the door.

    Args:
        system: the run; already served.
        crossing: the way to it.
    """

    def __init__(self, system: System, crossing: Crossing) -> None:
        self._system, self._crossing = system, crossing

    async def __aenter__(self) -> "Mounted":
        return operator_socket(PATH, self._talk, "debug")

    async def __aexit__(self, *_: object) -> None:
        """Do nothing: the server ends its connections."""

    async def _talk(self, editor: Conversation) -> None:
        """Serve one session until the editor leaves, or the run ends."""
        session: Session | None = None
        with suppress(Gone, RequestError):
            try:
                request = await editor.receive()
                session = await self._crossing.call(self._begin, Channel(editor.send), request)
                while True:
                    await self._crossing.call(session.take, await editor.receive())
            finally:
                if session is not None:
                    self._crossing.post(lambda: session.leave(end_run=False))

    def _begin(self, channel: Channel, request: Message) -> Session:
        session = Session(self._system, channel, Settings.of(request.get("arguments") or {}, launched=False))
        channel.respond(request)
        session.begin()
        return session
