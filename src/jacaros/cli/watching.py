"""Recording, replay page and terminal view of a run."""

from functools import partial
from pathlib import Path
from types import TracebackType

from jacaros.bdi.agent import Agent
from jacaros.bdi.meta_events import observe_goals
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.replay import write_replay
from jacaros.inspector.terminal_view import TerminalView
from jacaros.inspector.watch import Watch, Watcher
from jacaros.mas.console import Console
from jacaros.mas.mas import Mas

_STATES = {
    "executing": "pursued",
    **{state: state for state in ("suspended", "resumed", "achieved", "failed", "dropped")},
}
"""States of goals that watchers hear of, in their words."""


class Watching:
    """The console of a run that is watched; passes everything on, to the watchers too.

    Args:
        console: where the lines go.
        record: file for the recording, or None.
        replay: file for the page, or None.
        view: show the world in the terminal.
    """

    def __init__(self, console: Console, record: Path | None, replay: Path | None, view: bool) -> None:
        self._console = console
        self._replay = replay
        self._recorder = Recorder(record, keep=replay is not None) if record or replay else None
        self._wants_view = view
        self._view: TerminalView | None = None
        self._watch: Watch | None = None

    def begin(self, mas: Mas) -> None:
        """Begin to watch a run that has been made."""
        world = mas.ros.world
        drawing = world.description.drawing() if world is not None else {}
        watchers: list[Watcher] = []
        if self._recorder is not None:
            self._recorder.world(drawing)
            watchers.append(self._recorder)
        if self._wants_view:
            self._view = TerminalView(drawing)
            watchers.append(self._view)
        self._watch = Watch(mas.clock, watchers, world)
        self._watch.start()
        for host in mas.directory:
            if isinstance(host.mind, Agent):
                observe_goals(host.mind, partial(self._goal_changed, host.mind.name))

    def _goal_changed(self, agent: str, state: str, goal: str, number: int) -> None:
        """Tell the watchers what an agent pursues."""
        told = _STATES.get(state)
        if told is not None and goal.startswith("!") and self._watch is not None:
            self._watch.event("goal", {"agent": agent, "goal": goal, "state": told, "id": number})

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output; a view that draws on the terminal shows it itself."""
        if self._watch is not None:
            self._watch.text(agent, text)
        if self._view is None or not self._view.takes_prints:
            self._console.print(agent, text)

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens."""
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
            if self._replay is not None and error is None:
                write_replay(self._recorder.recording, self._replay)
