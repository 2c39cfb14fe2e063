"""Pages on the command line: where they are, and opening them in the browser."""

import os
import sys
import threading
import webbrowser
from collections.abc import Callable

from jacaros.cli.outputs import LOOPBACK, Outputs
from jacaros.inspector.live.run_view import Place, RunView
from jacaros.mas.console import Console
from jacaros.mas.system import System


def serve_pages(mas: System, outputs: Outputs, console: Console) -> RunView:
    """Make the live page of a run that has been started, print its address, and open it if there is a display.

    Raises:
        UsageError: the address cannot be served.
    """
    place = Place(outputs.view_address, outputs.view_port, outputs.view_token)
    view = RunView(mas, place)
    tell_address(view.address, place.address, console.log)
    view.awaited = open_page(view.address) is not None
    return view


def tell_address(page: str, address: str, log: Callable[[str, str], object]) -> None:
    """Print where a page is, and what it lets others do."""
    log(f"view: {page}", "info")
    if address not in (LOOPBACK, "localhost", "::1"):
        log(
            f"warning: all machines that reach {address} and know the token can see everything in this run, the programs "
            "included, and can command its agents and robots; the connection is not encrypted",
            "warning",
        )


def open_page(page: str) -> threading.Thread | None:
    """Open a page in the user's browser without waiting for it; return the thread, None on a machine without a display."""
    if not has_display():
        return None
    opening = threading.Thread(target=webbrowser.open, args=(page,), name="jacaros browser", daemon=True)
    opening.start()
    return opening


def has_display() -> bool:
    """Return whether a browser can show something, and somebody sits there to look: standard error is a terminal."""
    if sys.stderr is None or not sys.stderr.isatty():
        return False
    if sys.platform.startswith("linux"):
        return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return "SSH_CONNECTION" not in os.environ
