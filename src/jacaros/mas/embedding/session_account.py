"""What sessions of Python code mean for whether a run is idle."""

from contextlib import AbstractContextManager, nullcontext

from jacaros.mas.idleness import Activity, Idleness


class SessionAccount:
    """Counts the operations of sessions as things that are under way: the `jacaros.env.session.account.Account` of a run.

    Args:
        activity: of the run.
        idleness: of the run.
    """

    def __init__(self, activity: Activity, idleness: Idleness) -> None:
        self._activity, self._idleness = activity, idleness

    def begin(self) -> None:
        """An operation is under way."""
        self._activity.begin()

    def end(self) -> None:
        """It has ended."""
        self._activity.end()
        self._idleness.look()

    def waiting(self) -> AbstractContextManager[None]:
        """Nothing: what Python code waits for is no business of the agents."""
        return nullcontext()
