"""Exceptions of an artifact's code: which are its author's, and how they are put into words."""

import signal
import traceback
from types import CodeType
from typing import Any

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGALRM")


def is_interruption(error: BaseException) -> bool:
    """True for what a signal handler raised in the middle of an artifact's code; all else is the code's own.

    An artifact that raises ``SystemExit`` or ``KeyboardInterrupt`` by itself ends its operation, not the process.
    """
    if isinstance(error, Exception):
        return False
    handlers = [signal.getsignal(getattr(signal, name)) for name in _SIGNALS if hasattr(signal, name)]
    # The handler of Python itself is no Python code, so no trace shows it.
    if isinstance(error, KeyboardInterrupt) and handlers[0] is signal.default_int_handler:
        return True
    codes = {_code(handler) for handler in handlers} - {None}
    return any(frame.f_code in codes for frame, _ in traceback.walk_tb(error.__traceback__))


def _code(handler: Any) -> CodeType | None:
    handler = getattr(handler, "func", handler)
    code = getattr(getattr(handler, "__func__", handler), "__code__", None)
    return code if isinstance(code, CodeType) else None


def text_of(error: object) -> str:
    """What *error* says of itself, also when its ``__str__`` is broken."""
    try:
        return str(error)
    except Exception as broken:
        return f"(its text cannot be had: {type(broken).__name__})"


def told(error: BaseException) -> str:
    """An exception in words: its class, and what it says."""
    said = text_of(error)
    return f"{type(error).__name__}: {said}" if said else type(error).__name__
