"""Programs import the virtual rclpy under the name ``rclpy``, and read the virtual clock as the system's time."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from virtual_rclpy.messages import MessagePackages, is_message_package
from virtual_rclpy.system_time import virtual_system_time

SUBMODULES = ("action", "callback_groups", "client", "executors", "node", "parameter", "qos", "task", "time")
ALSO = {"action.client": "action", "publisher": "node", "subscription": "node"}
"""Modules of rclpy whose classes are elsewhere here."""

STAND_INS = str(Path(__file__).parents[1] / "stand_ins")


@contextmanager
def installed() -> Iterator[None]:
    """Let ``import rclpy``, ``import tf2_ros``, message packages and the system's time be the virtual ones."""
    virtual: Any = import_module("virtual_rclpy")
    names: dict[str, Any] = {
        "rclpy": virtual,
        **{f"rclpy.{name}": import_module(f"virtual_rclpy.{name}") for name in SUBMODULES},
        **{f"rclpy.{name}": import_module(f"virtual_rclpy.{place}") for name, place in ALSO.items()},
    }
    hidden = {
        name: sys.modules.pop(name)
        for name in list(sys.modules)
        if name.split(".")[0] in ("rclpy", "tf2_ros") or is_message_package(name)
    }
    before = set(sys.modules)
    finder = MessagePackages()
    sys.modules.update(names)
    sys.meta_path.insert(0, finder)
    sys.path.insert(0, STAND_INS)
    spinning = (virtual.spin, names["rclpy.executors"].SingleThreadedExecutor.spin)
    try:
        with (
            _own_logging(),
            virtual_system_time(lambda target: getattr(target, "__func__", target) in spinning),
        ):
            yield
    finally:
        sys.path.remove(STAND_INS)
        sys.meta_path.remove(finder)
        finder.close()
        for name in (*names, "tf2_ros"):
            sys.modules.pop(name, None)
        _forget_libraries(set(sys.modules) - before)
        sys.modules.update(hidden)


@contextmanager
def _own_logging() -> Iterator[None]:
    """Undo what a program or its libraries configure for the logging of the process."""
    root = logging.getLogger()
    level, handlers = root.level, list(root.handlers)
    try:
        yield
    finally:
        root.setLevel(level)
        root.handlers[:] = handlers


def _forget_libraries(imported: set[str]) -> None:
    """Forget packages that import the virtual rclpy, such as yasmin_ros: they keep nodes of this run."""
    users = {
        name.split(".")[0]
        for name in imported
        if any(
            str(getattr(value, "__module__", "")).startswith("virtual_rclpy")
            for value in vars(sys.modules[name]).values()
        )
    }
    for name in imported:
        if name.split(".")[0] in users:
            del sys.modules[name]
