"""Goals that come as actions of ROS."""

import asyncio
from collections.abc import Callable

from jacaros.robots.ros.action import Abort, ServerGoal
from jacaros.robots.ros.errors import MessageMismatch
from jacaros.serving.callers import RequestError
from jacaros.serving.goals import ACHIEVED, PENDING, WAITING, RequestedGoal
from jacaros.serving.ros.forms import MISMATCH, Fields, GoalForm
from jacaros.serving.service import Session

REPEATING = 1.0
"""Seconds after which unchanged feedback is sent again."""
LEFT_AFTER = 3.0
"""Seconds without any client of an action after which its goals are cancelled whose offers say ``when_left(cancel)``."""


class Pursuit:
    """A goal of the graph while the agent pursues it.

    Args:
        served: the goal of the graph.
        goal: the goal of the agent.
        form: writes the feedback.
        abandoned: returns whether the action has no client left.
        warn: logs a warning.
    """

    def __init__(
        self,
        served: ServerGoal,
        goal: RequestedGoal,
        form: GoalForm,
        abandoned: Callable[[], bool],
        warn: Callable[[str], None],
    ) -> None:
        self._served, self.goal, self._form, self._abandoned = served, goal, form, abandoned
        self._warn, self._misfit = warn, False
        self._last: Fields | None = None
        self._sent_at = 0.0
        self._left_at: float | None = None

    def left(self, now: float) -> bool:
        """Return whether the goal must be cancelled, because no client has been left for a while.

        The graph does not tell whose goal it is, so a goal continues while any client of its action lives.
        """
        if self.goal.offer.when_left != "cancel" or not self._abandoned():
            self._left_at = None
            return False
        self._left_at = now if self._left_at is None else self._left_at
        return now - self._left_at >= LEFT_AFTER

    def report(self, now: float) -> None:
        """Send feedback if it differs from the last one, or that one is old: clients ignore what comes too early."""
        goal = self.goal
        doing = "" if goal.over or goal.state in (PENDING, WAITING) else goal.doing()
        if not doing or self._misfit:
            return
        try:
            fields = self._form.feedback(doing, goal.progress, goal.note)
            if fields != self._last or now - self._sent_at >= REPEATING:
                self._last, self._sent_at = fields, now
                self._served.feedback(fields)
        except (MessageMismatch, *MISMATCH) as error:
            self._misfit = True
            self._warn(f"the feedback of !{goal.written} does not fit {self._form.type_name}: {error}")


class Pursuits:
    """The goals of the graph that agents pursue now.

    Args:
        now: returns the time.
        warn: logs a warning.
    """

    def __init__(self, now: Callable[[], float], warn: Callable[[str], None]) -> None:
        self._now, self._warn = now, warn
        self._known: dict[str, Pursuit] = {}

    def __len__(self) -> int:
        return len(self._known)

    def look(self, most: int) -> None:
        """Send feedback of at most this number of goals. Those that are not looked at have their turn next.

        Goals whose clients have left are cancelled if their offers say so.
        """
        now = self._now()
        for goal_id in list(self._known)[:most]:
            found = self._known[goal_id] = self._known.pop(goal_id)
            found.report(now)
            if found.left(now):
                found.goal.cancel()

    async def pursue(
        self, served: ServerGoal, session: Session, form: GoalForm, abandoned: Callable[[], bool]
    ) -> Fields | None:
        """Let the agent pursue a goal of the graph. Return the fields of the result.

        Raises:
            Abort: the goal was not achieved, or the request had no effect.
        """
        try:
            goal = form.give(session, served.request)
        except RequestError as error:
            raise Abort(error.message, form.refusal(error)) from None
        self._known[goal.id] = pursuit = Pursuit(served, goal, form, abandoned, self._warn)
        goal.watcher = lambda: pursuit.report(self._now())
        try:
            await _ended(served, goal, session)
        finally:
            self._known.pop(goal.id, None)
        return _outcome(served, goal, form)


async def _ended(served: ServerGoal, goal: RequestedGoal, session: Session) -> None:
    """Wait for the end of a goal. A request to cancel drops its intention, and waits for the clean-up."""
    try:
        await goal.wait()
    except asyncio.CancelledError:
        if not served.cancel_requested:  # the door is closed: the offer says what happens to the goal
            raise
        session.cancel(goal.id)
        await goal.wait()


def _outcome(served: ServerGoal, goal: RequestedGoal, form: GoalForm) -> Fields | None:
    try:
        fields = form.result(goal)
    except MISMATCH as error:
        raise Abort(f"the result does not fit the type of the action: {error}") from None
    if goal.state == ACHIEVED or served.cancel_requested:
        return fields
    raise Abort(goal.message or goal.state, fields)
