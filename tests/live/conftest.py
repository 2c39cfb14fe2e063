"""The pages on which programs run, as `make live` builds them, on a web server of this machine."""

from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from os import PathLike
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

BUILT = Path(__file__).resolve().parents[2] / "build" / "live"


class _Handler(SimpleHTTPRequestHandler):
    """Serves files as any web server does, and logs nothing."""

    def guess_type(self, path: str | PathLike[str]) -> str:
        """Return the media type of a file; old versions of Python do not know all of them."""
        return {".mjs": "text/javascript", ".wasm": "application/wasm"}.get(
            Path(path).suffix
        ) or super().guess_type(path)

    def log_message(self, format: str, *args: Any) -> None:
        pass


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of the built pages."""
    assert (BUILT / "live.html").exists(), "run `make live` first"
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Handler, directory=str(BUILT)))
    Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()
