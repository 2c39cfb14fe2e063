"""Recording, replay page, ground truth and views of a run."""

import sys
import threading
import webbrowser
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.agents.language.offers import OBSERVER, OPERATOR, USER
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.watch import Watch, Watcher, watch_of
from jacaros.robots.world.process import GroundTruthFile
from jacaros.runtime.cli.outputs import LOOPBACK, RequestedOutputs, has_display
from jacaros.runtime.cli.usage import usage_error
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.system import System

if TYPE_CHECKING:
    from jacaros.look.page.live.run_view import RunView
    from jacaros.look.page.terminal_view import TerminalView


class Watching(ExitStack):
    """A console that also passes output to recordings and views, and completes these when the context ends.

    Args:
        console: takes the output. The view is drawn on the current standard error output.
        outputs: recordings and views to make of the run.

    Attributes:
        incomplete: whether the replay page could not be written.
    """

    def __init__(self, console: RunConsole, outputs: RequestedOutputs) -> None:
        super().__init__()
        self._console, self._outputs = console, outputs
        self._recorder: Recorder | None = None
        if outputs.record or outputs.replay:
            limit = outputs.record_limit * 1_000_000
            self._recorder = Recorder(outputs.record, outputs.replay is not None, self._warn, limit)
            self.callback(self._recorder.close)
        self._view: TerminalView | None = None
        self._terminal = sys.stderr
        self._watch: Watch | None = None
        self.incomplete = False

    def begin(self, mas: System) -> None:
        """Begin to watch a run that has been created.

        Raises:
            UsageError: the ground truth is requested, but the run has no embedded world.
        """
        if self._outputs.ground_truth is not None:
            self.enter_context(self._ground_truth(self._outputs.ground_truth, mas))
        watchers: list[Watcher] = []
        if self._recorder is not None:
            watchers.append(self._recorder)
            if self._outputs.replay is not None:
                self.callback(self._write_replay, self._recorder, self._outputs.replay)
        if self._outputs.view == "terminal":
            from jacaros.look.page.terminal_view import TerminalView  # here: it imports rich

            self._view = TerminalView(stream=self._terminal)
            watchers.append(self._view)
            self.callback(self._view.close)
        page = self._serve(mas) if self._outputs.view == "page" else None
        if page is not None:
            watchers.append(page.watcher)
        self._watch = watch_of(mas, watchers, live=page is not None)
        self.callback(self._watch.stop)
        self._watch.start()
        if page is not None:
            page.begin(self._watch)

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output, unless the view shows it."""
        if self._watch is not None:
            self._watch.text(agent, text)
        if self._view is None or not self._view.takes_prints:
            self._console.print(agent, text)

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        self._console.log(text, level)

    def _serve(self, mas: System) -> "RunView":
        """Serve the live page of a started run, log its address, and open it if there is a display.

        Raises:
            UsageError: the page cannot be served at the address.
        """
        from jacaros.look.page.live.run_view import RunView  # here: it imports a server

        outputs = self._outputs
        place = (outputs.view_address, outputs.view_port, outputs.view_token)
        view = RunView(mas, *place, outputs.view_role, outputs.view_in_frame)
        log_address(view.address, outputs.view_address, self.log, _MAY[outputs.view_role])
        view.awaited = not outputs.view_in_frame and open_page(view.address) is not None
        return view

    def _ground_truth(self, path: Path, mas: System) -> GroundTruthFile:
        world = mas.ros.world
        if world is None:
            raise usage_error(
                "--ground-truth needs a world embedded in this run",
                "give --ground-truth to the `jacaros sim` that runs the world",
            )
        return GroundTruthFile(path, world, mas.clock.now() - world.time, self._warn)

    def _write_replay(self, recorder: Recorder, path: Path) -> None:
        from jacaros.look.page.page import write_replay  # here: few runs write a page

        recorder.close()
        try:
            write_replay(recorder.recording, path)
        except OSError as error:
            self.log(f"error: cannot write `{path}`: {error.strerror}", "error")
            self.incomplete = True

    def _warn(self, text: str) -> None:
        self.log(f"warning: {text}", "warning")


_MAY = {
    OBSERVER: "",
    USER: ", and can give its agents the goals that they offer",
    OPERATOR: ", and can command its agents and robots",
}
"""What a page may do besides looking, by its role."""


def log_address(page: str, address: str, log: Callable[[str, str], object], may: str = "") -> None:
    """Log the address of a page; warn if other machines can reach it.

    Args:
        page: URL of the page.
        address: IP address or name that the page is served at.
        log: takes a line and its level.
        may: what the page may do besides looking.
    """
    log(f"view: {page}", "info")
    if address not in (LOOPBACK, "localhost", "::1"):
        log(
            f"warning: every machine that reaches {address} and knows the token can see everything in this run, including "
            f"the programs{may}; the connection is not encrypted",
            "warning",
        )


def open_page(page: str) -> threading.Thread | None:
    """Open a page in the user's browser in a thread; return the thread, or None without a display."""
    if not has_display():
        return None
    opening = threading.Thread(target=webbrowser.open, args=(page,), name="jacaros browser", daemon=True)
    opening.start()
    return opening
