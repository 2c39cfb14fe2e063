"""Messages to an editor: events, and responses to its requests."""

from collections.abc import Callable, Mapping
from itertools import count
from typing import Any

Arguments = Mapping[str, Any]
Body = Mapping[str, Any] | None
Send = Callable[[Mapping[str, Any]], None]


class Channel:
    """Numbers the messages to an editor.

    Args:
        send: sends a message; any thread may call it.
    """

    def __init__(self, send: Send) -> None:
        self._send, self._numbers = send, count(1)

    def event(self, name: str, **body: Any) -> None:
        """Send an event."""
        self._send({"seq": next(self._numbers), "type": "event", "event": name, "body": body})

    def output(self, text: str, category: str) -> None:
        """Show a text in the editor's console; the *category* is ``stdout``, ``stderr`` or ``console``."""
        self.event("output", category=category, output=text)

    def respond(self, request: Arguments, body: Body = None) -> None:
        """Answer a request."""
        self._respond(request, True, {} if body is None else {"body": body})

    def refuse(self, request: Arguments, message: str) -> None:
        """Answer a request that failed."""
        error = {"id": 1, "format": message.replace("{", "(").replace("}", ")"), "showUser": True}
        self._respond(request, False, {"message": message, "body": {"error": error}})

    def _respond(self, request: Arguments, success: bool, more: Arguments) -> None:
        about = {"request_seq": request.get("seq", 0), "command": request.get("command", "")}
        self._send({"seq": next(self._numbers), "type": "response", "success": success, **about, **more})
