"""What we use of rclpy's inner side, which any release may change: nothing is missed that is not there.

`receiving` stands on the rest of it (groups, handles, guard conditions), and gives its work to rclpy's executor when
something there is another one.
"""

from importlib import import_module
from typing import Any


def _inner(name: str) -> Any:
    """Something of rclpy's extension module; None when it is there no more."""
    try:
        module = import_module("rclpy.impl.implementation_singleton")
        return getattr(module.rclpy_implementation, name, None)
    except (ImportError, AttributeError):
        return None


RCLError: type[Exception] = _inner("RCLError") or RuntimeError
"""What rclpy raises when rcl refuses something; a `RuntimeError` in all releases."""
InvalidHandle: type[Exception] = _inner("InvalidHandle") or RuntimeError
"""Raised by the handle of something that has been destroyed."""


def wait_set(subscriptions: int, guards: int, events: int, context: Any) -> Any:
    """Make a wait set of rcl.

    Args:
        subscriptions, guards, events: how many of each will be waited for.
        context: the handle of rclpy's context.

    Raises:
        NotImplementedError: rclpy has none.
    """
    made = _inner("WaitSet")
    if made is None:
        raise NotImplementedError("rclpy shows no wait sets")
    return made(subscriptions, guards, 0, 0, 0, events, context)
