"""The way of an editor to a run in another process, which answers it itself."""

import threading
from typing import TYPE_CHECKING

from jacaros.editors.dap.wire import Message, Wire, text_of
from jacaros.serving.client import Client

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

PATH = "/dap"
"""Where a run serves debugging sessions."""


def relay(wire: Wire, client: Client, request: Message) -> None:
    """Attach to a run, and pass messages on as they are until the editor leaves or the run ends.

    Args:
        wire: the editor.
        client: an operator of the run.
        request: the request `attach`.

    Raises:
        ServiceError: the run does not admit the session.
        Unreachable: it does not answer.
    """
    with client.socket(PATH) as socket:
        socket.send(text_of(request))
        threading.Thread(target=_pass_on, args=(wire, socket), name="jacaros dap input", daemon=True).start()
        for text in socket:
            wire.send_text(str(text))


def _pass_on(wire: Wire, socket: "ClientConnection") -> None:
    """Pass on what the editor sends, until it closes its input."""
    try:
        while (message := wire.read()) is not None:
            socket.send(text_of(message))
    finally:
        socket.close()
