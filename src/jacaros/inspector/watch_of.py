"""The watch of a run, on the embedded world or on a real graph."""

from jacaros.inspector.scene import EmbeddedScene, Scene
from jacaros.inspector.watch import LIVE_PERIOD, PERIOD, Watch, Watcher
from jacaros.mas.system import System


def watch_of(mas: System, watchers: list[Watcher], live: bool = False) -> Watch:
    """Create the watch of a started system; its embedded world may be created later.

    Args:
        mas: the system.
        watchers: receive the records.
        live: whether a live page is among the watchers.
    """
    period = LIVE_PERIOD if live and not mas.clock.virtual else PERIOD
    return Watch(mas.clock, watchers, _scene_of(mas), mas.history(), period)


def _scene_of(mas: System) -> Scene:
    backend = mas.ros.joined
    if mas.ros.world is not None or backend is None or backend.name == "memory":
        return EmbeddedScene(lambda: mas.ros.world)
    from jacaros.inspector.graph_scene import GraphScene  # here: only for runs on a real graph

    return GraphScene(backend, mas.clock, mas.deployment.name)
