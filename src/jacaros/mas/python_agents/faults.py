"""Exceptions of Python agents, as they are logged."""

import sysconfig
from pathlib import Path

from jacaros.artifacts.kernel.faults import error_text

_OURS = str(Path(__file__).parents[2])
_STANDARD = sysconfig.get_path("stdlib")


def fault_lines(error: BaseException) -> list[str]:
    """Return the exception, the line of the user's code that raised it, and the lines that led there."""
    if isinstance(error.__cause__, SystemExit):
        error = error.__cause__
    places = _places(error)
    lines = [f"error: the agent was ended by {error_text(error)}{place_of_fault(error)}"]
    lines += [f"  called from {place}" for place in reversed(places[:-1])]
    for each in error.exceptions if isinstance(error, BaseExceptionGroup) else ():
        lines.append(f"  {error_text(each)}{place_of_fault(each)}")
    return lines


def place_of_fault(error: BaseException) -> str:
    """Return the innermost line of the user's code in the traceback, in brackets; empty without one."""
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
