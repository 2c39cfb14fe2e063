"""Opening a backend by its name."""

from importlib import import_module
from pathlib import Path
from typing import Any

from jacaros.clock import Clock
from jacaros.errors import UsageError
from jacaros.ros.backend import Backend
from jacaros.ros.errors import BackendUnavailable
from jacaros.ros.node import NodeSettings

_OPTIONS: dict[str, set[str]] = {
    "memory": {"graph"},
    "ros1": set(),
    "ros2": {"domain_id"},
    "rosbridge": {"url"},
}
_LIBRARIES = {"ros1": "rospy", "ros2": "rclpy", "rosbridge": "websockets"}
_CURES = {
    "ros1": (
        "On Debian 12 install python3-rospy and the message packages with apt-get and use a venv made by "
        "`/usr/bin/python3 -m venv --system-site-packages`; tools/install_ros1.sh does both. On a robot with "
        "its own ROS 1, source its setup file first"
    ),
    "ros2": (
        "On Linux x86-64 run `pip install 'jacaros[ros2]'`; tools/install_ros2.sh makes a complete venv. On "
        "a robot with its own ROS 2, source its setup file first"
    ),
    "rosbridge": "Run `pip install 'jacaros[rosbridge]'`",
}


def open_backend(kind: str, clock: Clock, node_name: str, namespace: str = "", **options: Any) -> Backend:
    """Make a node of a backend; ``await backend.start()`` joins it to its graph.

    Args:
        kind: ``memory``, ``ros1``, ``ros2`` or ``rosbridge``.
        clock: the run's clock; the virtual one goes with ``memory`` alone.
        node_name: plain name of the node.
        namespace: put before relative names.
        options: ``remap``, ``log``, ``parameters``, ``orphans``, ``interface_paths`` (see `NodeSettings`); for ``memory``
            also ``graph``, a `jacaros.ros.drivers.memory.graph.MemoryGraph` to share; for ``ros2`` also ``domain_id``; for
            ``rosbridge`` also ``url``, the server's address.

    Raises:
        UsageError: unknown kind or option, or the virtual clock with a real ROS graph.
        BackendUnavailable: the client library is not installed.
        NameInvalid: the node's name or a namespace breaks the rules of ROS.
    """
    if kind not in _OPTIONS:
        raise UsageError(f"there is no ROS backend {kind!r}; there are {', '.join(_OPTIONS)}")
    if clock.virtual and kind != "memory":
        raise UsageError(
            f"the virtual clock cannot run with a real ROS graph ({kind}): its nodes live in real time. "
            "Use the real clock (--clock real)"
        )
    options = {name: value for name, value in options.items() if value is not None}
    common = {
        name: options.pop(name) for name in ("remap", "log", "parameters", "orphans") if name in options
    }
    folders = tuple(Path(folder) for folder in options.pop("interface_paths", ()))
    unknown = set(options) - _OPTIONS[kind]
    if unknown:
        raise UsageError(f"the {kind} backend has no option {', '.join(sorted(unknown))}")
    settings = NodeSettings(clock, node_name, namespace, interface_paths=folders, **common)
    backend: Backend = _backend_class(kind)(settings, **options)
    return backend


def _backend_class(kind: str) -> Any:
    # Imported by name and only now: the client libraries are heavy, and most systems have one or none.
    library = _LIBRARIES.get(kind)
    try:
        if library is not None:
            import_module(library)  # first, so that it is what is told to be missing, and no part of it
        module = import_module(f"jacaros.ros.drivers.{kind}.backend")
    except ImportError as problem:
        if library is None or (problem.name or "").startswith("jacaros"):
            raise
        raise BackendUnavailable(
            f"the {kind} backend needs the Python library {library}, which cannot be imported ({problem}). "
            f"{_CURES[kind]}."
        ) from problem
    return module.BACKEND
