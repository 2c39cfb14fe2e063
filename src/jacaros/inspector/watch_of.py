"""The watch of a run: over the embedded world, or over what a real graph tells."""

from jacaros.inspector.scene import EmbeddedScene, Scene
from jacaros.inspector.watch import Watch, Watcher
from jacaros.mas.system import System
from jacaros.sim import World


def watch_of(mas: System, watchers: list[Watcher], world: World | None = None) -> Watch:
    """Make the watch of a system that has been started; *world* is its embedded world, if it has one."""
    return Watch(mas.clock, watchers, _scene_of(mas, world), mas.history())


def _scene_of(mas: System, world: World | None) -> Scene | None:
    if world is not None:
        return EmbeddedScene(world)
    backend = mas.ros.joined
    if backend is None or backend.name == "memory":
        return None
    from jacaros.inspector.graph_scene import GraphScene  # here: only for runs on a real graph

    return GraphScene(backend, mas.clock, mas.deployment.name)
