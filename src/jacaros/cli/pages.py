"""Serve a page, print its address, and open it in the browser."""

import os
import sys
import threading
import webbrowser
from collections.abc import Callable

from jacaros.cli.outputs import LOOPBACK, Outputs
from jacaros.inspector.live.run_view import RunView
from jacaros.mas.console import Console
from jacaros.mas.system import System


def serve_pages(mas: System, outputs: Outputs, console: Console) -> RunView:
    """Serve the live page of a started run, print its address, and open it if there is a display.

    Raises:
        UsageError: the page cannot be served at the address.
    """
    view = RunView(mas, outputs.view_address, outputs.view_port, outputs.view_token)
    log_address(view.address, outputs.view_address, console.log)
    view.awaited = open_page(view.address) is not None
    return view


def log_address(page: str, address: str, log: Callable[[str, str], object]) -> None:
    """Log the address of a page; warn if other machines can reach it.

    Args:
        page: URL of the page.
        address: IP address or name that the page is served at.
        log: takes a line and its level.
    """
    log(f"view: {page}", "info")
    if address not in (LOOPBACK, "localhost", "::1"):
        log(
            f"warning: every machine that reaches {address} and knows the token can see everything in this run, including "
            "the programs, and can command its agents and robots; the connection is not encrypted",
            "warning",
        )


def open_page(page: str) -> threading.Thread | None:
    """Open a page in the user's browser in a thread; return the thread, or None without a display."""
    if not has_display():
        return None
    opening = threading.Thread(target=webbrowser.open, args=(page,), name="jacaros browser", daemon=True)
    opening.start()
    return opening


def has_display() -> bool:
    """Return whether a user can see a browser: standard error is a terminal, on a machine with a display."""
    if sys.stderr is None or not sys.stderr.isatty():
        return False
    if sys.platform.startswith("linux"):
        return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return "SSH_CONNECTION" not in os.environ
