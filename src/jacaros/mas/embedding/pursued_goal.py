"""A goal that Python code has given to an agent."""

from jacaros.bdi.rules import goals
from jacaros.bdi.rules.watched import WatchedGoal
from jacaros.terms.text import text
from jacaros.terms.values import Term


class PursuedGoal:
    """A goal that somebody outside has given."""

    def __init__(self, written: str, watched: WatchedGoal) -> None:
        self._written, self._watched = written, watched

    @property
    def achieved(self) -> bool:
        """Whether it was achieved."""
        return self._watched.achieved

    @property
    def failed(self) -> bool:
        """Whether it failed, and no plan took care of that."""
        return self._watched.failed

    @property
    def state(self) -> str:
        """``achieved``, ``failed``, ``dropped``, ``suspended``, ``waiting``, or ``running``."""
        if self._watched.ended:
            return "achieved" if self.achieved else "failed"
        intentions = self._watched.intentions()
        return str(goals.describe(intentions[-1])[0]) if intentions else "dropped"

    @property
    def reasons(self) -> list[Term]:
        """The terms that tell why it failed."""
        reason = self._watched.reason
        return list(reason.terms) if reason is not None else []

    def __str__(self) -> str:
        why = f": {', '.join(map(text, self.reasons))}" if self.reasons else ""
        return f"!{self._written} ({self.state}{why})"
