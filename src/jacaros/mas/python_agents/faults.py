"""Exceptions of agents written in Python, as people are told of them."""

import sysconfig
from pathlib import Path

_OURS = str(Path(__file__).parents[2])
_STANDARD = sysconfig.get_path("stdlib")


def fault_lines(error: BaseException) -> list[str]:
    """What to tell: the exception, the line of the user's code that it was raised in, and the lines that led there."""
    if isinstance(error.__cause__, SystemExit):
        error = error.__cause__
    places = _places(error)
    lines = [f"error: the agent has ended: {said(error)}{place_of_fault(error)}"]
    lines += [f"  called from {place}" for place in reversed(places[:-1])]
    for each in error.exceptions if isinstance(error, BaseExceptionGroup) else ():
        lines.append(f"  {said(each)}{place_of_fault(each)}")
    return lines


def said(error: BaseException) -> str:
    """An exception in words."""
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def place_of_fault(error: BaseException) -> str:
    """The innermost line of the user's code that an exception came through, in brackets; empty without one."""
    places = _places(error)
    return f" ({places[-1]})" if places else ""


def _places(error: BaseException) -> list[str]:
    found = []
    trace = error.__traceback__
    while trace is not None:
        code = trace.tb_frame.f_code
        if not code.co_filename.startswith((_OURS, _STANDARD, "<")):
            found.append(f"{code.co_filename}:{trace.tb_lineno}, in {code.co_name}")
        trace = trace.tb_next
    return found
