"""Hearing a topic with code that may fail: a fault in it is the artifact's, and the next message is heard all the same."""

from collections.abc import Callable

from jacaros.ros.backend import Sample

Complain = Callable[[str, BaseException], None]
"""Logs what went wrong, with the place in the code."""


class Listener:
    """Calls back for each message; what is raised is logged, and told again at 10, 100, 1000 … times.

    A sensor may send a thousand messages a second, so a mistake in the code that hears them must not fill the log.

    Args:
        topic: for the log.
        callback: takes a message.
        complain: logs a fault.
    """

    def __init__(self, topic: str, callback: Callable[[Sample], None], complain: Complain) -> None:
        self._topic, self._callback, self._complain = topic, callback, complain
        self._faults: dict[str, int] = {}

    def __call__(self, sample: Sample) -> None:
        """Take a message."""
        try:
            self._callback(sample)
        except Exception as error:
            self._fault(error)

    def _fault(self, error: Exception) -> None:
        kind = f"{type(error).__name__} {_line(error)}"
        times = self._faults[kind] = self._faults.get(kind, 0) + 1
        if times == 1:
            self._complain(f"the callback of topic {self._topic} failed:", error)
        elif str(times).strip("0") == "1":
            self._complain(f"the callback of topic {self._topic} has failed {times} times:", error)


def _line(error: Exception) -> int:
    """The line that raised *error*."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace.tb_lineno if trace is not None else 0
