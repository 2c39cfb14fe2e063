"""Open a backend by its name."""

from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.ros.backend import Backend
from jacaros.ros.errors import BackendUnavailable
from jacaros.ros.middleware import Middleware, middleware
from jacaros.ros.node import NodeSettings
from jacaros.runtime.clock import Clock


def open_backend(kind: str, clock: Clock, node_name: str, namespace: str = "", **options: Any) -> Backend:
    """Make a node of a backend; ``await backend.start()`` joins it to its graph.

    Args:
        kind: ``memory``, ``ros1``, ``ros2``, ``rosbridge``, or a class of your own, see `jacaros.ros.middleware`.
        clock: the run's clock; the virtual clock works with ``memory`` only.
        node_name: plain name of the node.
        namespace: prefix of relative names.
        options: ``remap``, ``log``, ``parameters``, ``orphans``, ``interface_paths`` (see `NodeSettings`); for
            ``memory`` also ``graph``, a `jacaros.ros.drivers.memory.graph.MemoryGraph` to share; for ``ros2`` also
            ``domain_id``; for ``rosbridge`` also ``url``, the server's address.

    Raises:
        UsageError: unknown kind or option, or the virtual clock with a real ROS graph.
        BackendUnavailable: the client library is not installed.
        NameInvalid: the node's name or a namespace breaks the rules of ROS.
    """
    chosen = middleware(kind)
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
    made = _backend_class(kind, chosen)
    unknown = set(options) - set(signature(made).parameters)
    if unknown:
        raise UsageError(f"the {kind} backend has no option {', '.join(sorted(unknown))}")
    settings = NodeSettings(clock, node_name, namespace, interface_paths=folders, **common)
    backend: Backend = made(settings, **options)
    return backend


def _backend_class(kind: str, chosen: Middleware) -> Any:
    # Imported by name and only now: the client libraries are large, and most systems have one or none.
    try:
        if chosen.library:
            import_module(
                chosen.library
            )  # first, so that the error is about the library itself, not a part of it
        module, _, name = chosen.backend.partition(":")
        return getattr(import_module(module), name)
    except ImportError as problem:
        if chosen.library and not (problem.name or "").startswith("jacaros"):
            raise BackendUnavailable(
                f"error: --ros {kind} needs the package {chosen.library} ({problem})\n  = help: {chosen.install}"
            ) from problem
        if chosen.backend != kind:
            raise
        raise BackendUnavailable(
            f"the backend {kind} cannot be imported: {problem}. If it is in this folder, set PYTHONPATH=."
        ) from problem
    except AttributeError as problem:
        raise UsageError(f"unknown ROS backend {kind!r}: {problem}") from problem
