"""The HTTP server of a run, in a thread of its own."""

import asyncio
import os
import socket
import ssl
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import AbstractAsyncContextManager, AsyncExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from traceback import format_exception

import uvicorn
from starlette.types import ASGIApp

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import is_worth_a_line
from jacaros.runtime.mas.system import System
from jacaros.serving import running
from jacaros.serving.access import LOOPBACK, Hosts, listening_socket
from jacaros.serving.crossing import Crossing, DoorThread
from jacaros.serving.http.app import Mounted, Resources
from jacaros.serving.http.clients import Client, Encoder
from jacaros.serving.http.guard import LARGEST, Guard
from jacaros.serving.http.protocol import (
    LARGEST_HEADER,
    MOST_CONNECTIONS,
    LimitedConnection,
    LimitedWebSocket,
)
from jacaros.serving.remote import RemoteCallers
from jacaros.serving.running import RunningService
from jacaros.serving.service import service_of
from jacaros.serving.tokens import Tokens

GOODBYE = 1
"""Seconds for the last responses and events when the run ends."""
KEEP_ALIVE = 30
"""Seconds that a connection stays open between two requests."""
MOST_DEFECTS = 100
"""Maximum number of different defects that are logged."""
MountedApp = Callable[[Crossing], AbstractAsyncContextManager[Mounted]]
"""Makes a further application, or route, of the same server on its loop. Its requests have passed the `Guard`."""


@dataclass(frozen=True)
class Address:
    """Where to serve.

    Attributes:
        host: address of this machine.
        port: port; 0 for a free one.
        certificate, key: files for TLS, or None.
    """

    host: str = LOOPBACK
    port: int = 0
    certificate: Path | None = None
    key: Path | None = None


class HttpDoor:
    """Serves a run over HTTP until it ends.

    Args:
        system: the run; already started.
        address: where to serve.
        tokens: who may call. None: only who has the random `token`.
        mounts: further applications and routes by path.

    Attributes:
        url: where it serves.
        token: a random token of an operator.

    Raises:
        UsageError: the address or the certificate cannot be used.
    """

    def __init__(
        self,
        system: System,
        address: Address,
        tokens: Tokens | None = None,
        mounts: Mapping[str, MountedApp] | None = None,
    ) -> None:
        self._system, self._address, self._mounts = system, address, mounts or {}
        self._tokens = tokens or Tokens({})
        self.token = self._tokens.new("operator")
        self._service = service_of(system)
        self._defects: Counter[str] = Counter()
        help = "choose another address: --serve [ADDRESS:]PORT"
        _check_certificate(address)
        self._socket = listening_socket("HTTP", address.host, address.port, help, MOST_CONNECTIONS)
        self.url = _url(self._socket, address.certificate is not None)
        certificate = "" if address.certificate is None else str(address.certificate.resolve())
        service = RunningService(system.deployment.name, os.getpid(), self.url, self.token, certificate)
        self._file = running.write(service)
        self._thread = DoorThread("jacaros http", self._serve, self._failed)
        system.close_last(self.close)

    async def close(self) -> None:
        """Send the last responses and events, and disconnect all clients."""
        await self._thread.close()
        self._socket.close()
        if self._file is not None:
            running.remove(self._file)
            self._file = None

    def _failed(self, error: Exception) -> None:
        """Log a defect, on its 1st, 10th, 100th, … occurrence."""
        told = f"{type(error).__name__}: {error}"
        if len(self._defects) < MOST_DEFECTS or told in self._defects:
            self._defects[told] += 1
        if (count := self._defects[told]) and is_worth_a_line(count):
            times = f" ({count} times)" if count > 1 else ""
            text = f"internal error: HTTP server: {told}{times}; please file an issue"
            trace = "\n" + "".join(format_exception(error)).rstrip() if count == 1 else ""
            self._system.console.log(text + trace, "error")

    async def _serve(self, crossing: Crossing) -> None:
        encoder = Encoder()
        clients = RemoteCallers(lambda caller: Client(caller, crossing, self._service, encoder))
        async with AsyncExitStack() as stack:
            mounts = {
                path: await stack.enter_async_context(make(crossing)) for path, make in self._mounts.items()
            }
            app = Resources(clients, self._system.deployment.name).app(mounts)
            guard = Guard(app, Hosts(self._address.host), self._tokens, self._failed)
            server = uvicorn.Server(self._config(guard))
            serving = asyncio.create_task(server.serve([self._socket]))
            looking = asyncio.create_task(clients.look())
            try:
                await asyncio.shield(serving)
            except asyncio.CancelledError:
                for client in clients:
                    client.end_streams()
                server.should_exit = True
                await serving
            finally:
                looking.cancel()

    def _config(self, app: ASGIApp) -> uvicorn.Config:
        return uvicorn.Config(
            app,
            http=partial(LimitedConnection, idle={}),  # type: ignore[arg-type]  # any factory will do
            ws=LimitedWebSocket,
            ws_max_size=LARGEST,
            lifespan="off",
            log_config=None,
            log_level="critical",
            access_log=False,
            proxy_headers=False,
            server_header=False,
            timeout_keep_alive=KEEP_ALIVE,
            timeout_graceful_shutdown=GOODBYE,
            ssl_certfile=self._address.certificate,
            ssl_keyfile=self._address.key,
            h11_max_incomplete_event_size=LARGEST_HEADER,
        )


def _check_certificate(address: Address) -> None:
    if address.certificate is None:
        return
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(address.certificate, address.key)
    except OSError as error:  # ssl.SSLError is one
        raise UsageError(
            f"error: cannot use the certificate {address.certificate} with the key {address.key}: "
            f"{error.strerror or error}\n  = help: both must be PEM files, and belong together"
        ) from None


def _url(listening: socket.socket, tls: bool) -> str:
    host, port = listening.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = socket.gethostname()
    return f"http{'s' * tls}://{f'[{host}]' if ':' in host else host}:{port}"
