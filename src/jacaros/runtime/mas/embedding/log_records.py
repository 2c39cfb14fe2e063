"""The log of an embedded system as records of the standard logger ``jacaros``."""

import logging
import re

_LOGGER = logging.getLogger("jacaros")
_LINE = re.compile(
    r"(?P<prefix>\[(?P<agent>\S+)\] )?(?:(?:debug|info|warning|error): )?(?P<text>.*)", re.DOTALL
)


def logging_configured() -> bool:
    """Return whether the logger ``jacaros`` has a level, or it or the root has a handler.

    Otherwise Python would drop what is below ``WARNING``, and print the rest without its level.
    """
    return _LOGGER.hasHandlers() or _LOGGER.level != logging.NOTSET


def log_record(line: str, level: str) -> None:
    """Log a line of a run: ``[bob] warning: goal lost`` becomes a warning ``[bob] goal lost`` with ``agent="bob"``.

    The name stays in the message, as most formatters do not show attributes. ``agent`` is empty for lines of the
    system, and ``ros`` for those about the connection to the graph.
    """
    found = _LINE.fullmatch(line)
    assert found is not None, "every line fits"
    message = (found["prefix"] or "") + found["text"]
    _LOGGER.log(getattr(logging, level.upper()), "%s", message, extra={"agent": found["agent"] or ""})
