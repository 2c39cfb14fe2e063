"""How sessions of Python code count for the idleness of a run."""

from contextlib import AbstractContextManager, nullcontext

from jacaros.mas.idleness import Activity, Idleness


class SessionAccount:
    """Counts the running operations of sessions: the `jacaros.artifacts.presence.presence.Account` of a run.

    Args:
        activity: counts what the agents wait for.
        idleness: detects when the run is idle.
    """

    def __init__(self, activity: Activity, idleness: Idleness) -> None:
        self._activity, self._idleness = activity, idleness

    def begin(self) -> None:
        """An operation has begun."""
        self._activity.begin()

    def end(self) -> None:
        """An operation has ended."""
        self._activity.end()
        self._idleness.look()

    def waiting(self) -> AbstractContextManager[None]:
        """Do nothing: waits of Python code do not concern the agents."""
        return nullcontext()
