"""How sessions of Python code count for the idleness of a run."""

from jacaros.artifacts.presence.presence import Account
from jacaros.mas.idleness import Activity, Idleness


class SessionAccount(Account):
    """Counts the running operations of sessions. Waits of Python code do not concern the agents.

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
