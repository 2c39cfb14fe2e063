"""Programs import the virtual rclpy under the name ``rclpy``."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from virtual_rclpy.messages import MessagePackages, is_message_package

SUBMODULES = ("action", "executors", "node", "qos", "task", "time")
STAND_INS = str(Path(__file__).parents[1] / "stand_ins")


@contextmanager
def installed() -> Iterator[None]:
    """Let ``import rclpy``, ``import tf2_ros`` and imports of message packages find the virtual ones in this context."""
    virtual = import_module("virtual_rclpy")
    names = {
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
    try:
        yield
    finally:
        sys.path.remove(STAND_INS)
        sys.meta_path.remove(finder)
        finder.close()
        for name in (*names, "tf2_ros"):
            sys.modules.pop(name, None)
        sys.modules.update(hidden)
