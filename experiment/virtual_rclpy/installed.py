"""Programs import the virtual rclpy under the name ``rclpy``, and read the virtual clock as the system's time."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from virtual_rclpy.messages import MessagePackages, is_message_package
from virtual_rclpy.system_time import virtual_system_time

SUBMODULES = ("action", "executors", "node", "qos", "task", "time")
STAND_INS = str(Path(__file__).parents[1] / "stand_ins")


@contextmanager
def installed() -> Iterator[None]:
    """Let ``import rclpy``, ``import tf2_ros``, message packages and the system's time be the virtual ones."""
    virtual: Any = import_module("virtual_rclpy")
    names: dict[str, Any] = {
        "rclpy": virtual,
        **{f"rclpy.{name}": import_module(f"virtual_rclpy.{name}") for name in SUBMODULES},
    }
    hidden = {
        name: sys.modules.pop(name)
        for name in list(sys.modules)
        if name.split(".")[0] in ("rclpy", "tf2_ros") or is_message_package(name)
    }
    finder = MessagePackages()
    sys.modules.update(names)
    sys.meta_path.insert(0, finder)
    sys.path.insert(0, STAND_INS)
    spinning = (virtual.spin, names["rclpy.executors"].SingleThreadedExecutor.spin)
    try:
        with virtual_system_time(lambda target: getattr(target, "__func__", target) in spinning):
            yield
    finally:
        sys.path.remove(STAND_INS)
        sys.meta_path.remove(finder)
        finder.close()
        for name in (*names, "tf2_ros"):
            sys.modules.pop(name, None)
        sys.modules.update(hidden)
