"""Whether a server is alive that the graph still lists: after a crash or in a dead spot that takes DDS 10 to 20 seconds."""

import time
from collections.abc import Callable

SILENCE = 1.0
"""Seconds without a sign after which the server is asked for one, and for an answer to that."""
GETTING_GOING = 0.3
"""Seconds that a goal is under way before it is tried whether the server answers meanwhile."""


class SignsOfLife:
    """Watches over the server of an action while a goal is under way.

    Not every living server answers: one whose code blocks its only thread does not, until the goal is over.  So silence
    counts only where a probe was answered in the middle of a goal, and not any more once it was misread.

    Args:
        probe: asks the server for a sign; `probe_answered` tells of it.
        tell: is told that the server seems to be gone (False) and that it is not (True).
    """

    def __init__(self, probe: Callable[[], None], tell: Callable[[bool], None]) -> None:
        self._probe = probe
        self._tell = tell
        self._heard = 0.0
        self._goal_began = 0.0
        self._probed: float | None = None
        self._answered: float | None = None
        self._answers = False
        self._misleading = False
        self._suspected = False

    def heard(self) -> None:
        """Something came from the server."""
        self._heard = time.monotonic()
        if self._suspected:
            self._suspected = False
            self._misleading = True
            self._tell(True)

    def probe_answered(self) -> None:
        """The server has answered a probe."""
        if self._probed is not None and self._probed >= self._goal_began + GETTING_GOING:
            self._answered = time.monotonic()
        self._probed = None

    def goal_begins(self) -> None:
        """The server has accepted a goal."""
        self._goal_began = time.monotonic()
        self._probed = self._answered = None

    def stranger(self) -> None:
        """Another server is there: what was learnt about the former does not count."""
        self._answers = self._misleading = self._suspected = False
        self._probed = self._answered = None

    def rest(self) -> None:
        """No goal is under way."""
        self._probed = self._answered = None
        self._suspected = False

    def check(self, now: float, under_way: bool) -> None:
        """Look whether the server is silent for too long; *under_way*: it is carrying out a goal."""
        if not under_way or self._misleading:
            return
        if self._answered is not None and now > self._answered + GETTING_GOING:
            # The goal goes on after the answer, so the answer did not have to wait for its end.
            self._answers = True
        if not self._answers:
            if self._probed is None and self._answered is None and now > self._goal_began + GETTING_GOING:
                self._ask(now)
        elif now > self._heard + SILENCE:
            if self._probed is None:
                self._ask(now)
            elif now > self._probed + SILENCE:
                if not self._suspected:
                    self._suspected = True
                    self._tell(False)
                self._ask(now)

    def _ask(self, now: float) -> None:
        self._probed = now
        self._probe()
