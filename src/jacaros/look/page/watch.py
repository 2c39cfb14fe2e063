"""Samples a running world many times per second of the run's clock, for a recorder and views."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from jacaros.look.page.scene import EmbeddedScene, RobotView
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.mas.history.history import History
from jacaros.runtime.mas.system import System

if TYPE_CHECKING:
    from jacaros.look.page.graph_scene import GraphScene

PERIOD, LIVE_PERIOD = 0.3, 0.05
"""Seconds between two frames of a recording, and of a run in real time shown on a live page.

Readers interpolate: a TurtleBot at full speed in its tightest curve is then off by 11 mm."""
REST = 1.0
"""Seconds between two frames of robots at rest, in a world that reports motion."""


class Watcher(Protocol):
    """Receives the records of a run: a `jacaros.look.page.recorder.Recorder` or a view."""

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Receive the world, before everything else, and again when more of it is known."""

    def frame(self, t: float, robots: list[RobotView]) -> None:
        """Receive the robots at a time, *t* seconds after the start of the run."""

    def text(self, t: float, agent: str, text: str) -> None:
        """Receive a line of an agent's output."""

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Receive an event."""


class Watch:
    """Feeds watchers with frames of a world, output of agents, and the history of the run.

    It only reads: a run is the same with and without it.

    Args:
        clock: clock of the run; ``t`` counts from the start of the history, or from now without one.
        watchers: receive the records.
        scene: the world to look at, None without a world; it is closed at the end.
        history: history whose records are forwarded; None for none.
        period: seconds between two frames.
    """

    def __init__(
        self,
        clock: Clock,
        watchers: list[Watcher],
        scene: "EmbeddedScene | GraphScene | None" = None,
        history: History | None = None,
        period: float = PERIOD,
    ) -> None:
        self.clock, self.watchers = clock, watchers
        self.beginning = history.beginning if history is not None else clock.now()
        self._scene, self._period = scene, period
        self._drawing: Mapping[str, Any] | None = None
        self._timer: Timer | None = None
        self._looked = float("-inf")
        self._history = history
        self._stop_listening: list[Callable[[], None]] = []

    def start(self) -> None:
        """Start sampling."""
        self._drawing = self._scene.drawing() if self._scene is not None else None
        self._show_world(self._drawing or {})
        for happening in self._history.all() if self._history is not None else ():
            self.event(*happening)
        self._look()
        if self._history is not None:
            for watcher in self.watchers:
                self._stop_listening.append(self._history.listen(watcher.event))
            self._history.start()

    def _show_world(self, drawing: Mapping[str, Any]) -> None:
        for watcher in self.watchers:
            watcher.world(drawing)

    def _look(self) -> None:
        # As fast as possible, a timer costs as much as the rest of a frame.
        follows = not self.clock.speed and self._scene is not None and self._scene.follow(self._look_if_due)
        self._timer = self.clock.call_later(REST if follows else self._period, self._look)
        self._look_if_due()

    def _look_if_due(self) -> None:
        """Sample if the last sample is a period ago: the world calls this ten times per second while robots move."""
        if self.clock.elapsed - self._looked > 0.9 * self._period:
            self.look()

    def look(self) -> None:
        """Sample the robots now, between two frames."""
        self._looked = self.clock.elapsed
        robots: list[RobotView] = []
        if self._scene is not None:
            drawing = self._scene.drawing()
            if drawing is not self._drawing and drawing is not None:
                self._drawing = drawing
                self._show_world(drawing)
            robots = self._scene.robots()
        t = self.t()
        for watcher in self.watchers:
            watcher.frame(t, robots)

    def t(self) -> float:
        """Seconds since the start of the run."""
        return self.clock.now() - self.beginning

    def text(self, agent: str, text: str) -> None:
        """Forward a line of an agent's output."""
        for watcher in self.watchers:
            watcher.text(self.t(), agent, text)

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Forward an event, such as ``goal``."""
        for watcher in self.watchers:
            watcher.event(t, kind, data)

    def stop(self) -> None:
        """Sample a last time, and stop; the owner of the watchers closes them."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self.look()
            if self._scene is not None:
                self._scene.close()
        if self._stop_listening and self._history is not None:
            self._history.stop()
            while self._stop_listening:
                self._stop_listening.pop()()


def watch_of(mas: System, watchers: list[Watcher], live: bool = False) -> Watch:
    """Create the watch of a started system; its embedded world may be created later.

    Args:
        mas: the system.
        watchers: receive the records.
        live: whether a live page is among the watchers.
    """
    period = LIVE_PERIOD if live and mas.clock.speed else PERIOD
    return Watch(mas.clock, watchers, _scene_of(mas), mas.history(), period)


def _scene_of(mas: System) -> "EmbeddedScene | GraphScene":
    backend = mas.ros.joined
    if mas.ros.world is not None or backend is None or backend.name == "memory":
        return EmbeddedScene(lambda: mas.ros.world)
    from jacaros.look.page.graph_scene import GraphScene  # here: only for runs on a real graph

    return GraphScene(backend, mas.clock, mas.deployment.name)
