"""Recording, replay page, ground truth and terminal view of a run."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from jacaros.cli.outputs import Outputs
from jacaros.cli.usage import usage_error
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.recording import Recording
from jacaros.inspector.watch import Watch, Watcher, watch_of
from jacaros.mas.console import Console
from jacaros.mas.system import System
from jacaros.sim import World
from jacaros.sim.process import GroundTruthFile

if TYPE_CHECKING:
    from jacaros.inspector.live.run_view import RunView
    from jacaros.inspector.terminal_view import TerminalView


class Watching:
    """A console that also passes output to recordings and views.

    Args:
        console: takes the output. The view is drawn on the current standard error output.
        outputs: recordings and views to make of the run.

    Attributes:
        incomplete: whether the replay page could not be written.
    """

    def __init__(self, console: Console, outputs: Outputs) -> None:
        self._console = console
        self._outputs = outputs
        record, replay = outputs.record, outputs.replay
        self._recorder: Recorder | None = None
        if record or replay:
            self._recorder = Recorder(record, replay is not None, self._warn, outputs.record_limit)
        self._ground_truth: GroundTruthFile | None = None
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
            self._ground_truth = _ground_truth_file(
                self._outputs.ground_truth, mas.ros.world, mas, self._warn
            )
        watchers: list[Watcher] = []
        if self._recorder is not None:
            watchers.append(self._recorder)
        if self._outputs.view == "terminal":
            from jacaros.inspector.terminal_view import TerminalView  # here: it imports rich

            self._view = TerminalView(stream=self._terminal)
            watchers.append(self._view)
        pages = self._serve(mas) if self._outputs.view == "page" else None
        if pages is not None:
            watchers.append(pages.watcher)
        self._watch = watch_of(mas, watchers, live=pages is not None)
        self._watch.start()
        if pages is not None:
            pages.begin(self._watch)

    def _serve(self, mas: System) -> "RunView":
        from jacaros.cli.pages import serve_pages  # here: it imports a server

        return serve_pages(mas, self._outputs, self._console)

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output, unless the view shows it."""
        if self._watch is not None:
            self._watch.text(agent, text)
        if self._view is None or not self._view.takes_prints:
            self._console.print(agent, text)

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        self._console.log(text, level)

    def __enter__(self) -> "Watching":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._watch is not None:
            self._watch.stop()
        if self._view is not None:
            self._view.close()
        if self._recorder is not None:
            self._recorder.close()
            if self._outputs.replay is not None and self._watch is not None:
                self._write_replay(self._recorder.recording, self._outputs.replay)
        if self._ground_truth is not None:
            self._ground_truth.__exit__(kind, error, trace)

    def _write_replay(self, recording: Recording, path: Path) -> None:
        from jacaros.inspector.page import write_replay  # here: few runs write a page

        try:
            write_replay(recording, path)
        except OSError as error:
            self._console.log(f"error: cannot write `{path}`: {error.strerror}", "error")
            self.incomplete = True

    def _warn(self, text: str) -> None:
        self._console.log(f"warning: {text}", "warning")


def _ground_truth_file(
    path: Path, world: World | None, mas: System, warn: Callable[[str], None]
) -> GroundTruthFile:
    if world is None:
        raise usage_error(
            "--ground-truth needs a world embedded in this run",
            "give --ground-truth to the `jacaros sim` that runs the world",
        )
    return GroundTruthFile(path, world, mas.clock.now() - world.time, warn)
