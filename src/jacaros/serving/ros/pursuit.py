"""Goals that come as actions of ROS."""

import asyncio

from jacaros.robots.ros.action import Abort, ServerGoal
from jacaros.robots.ros.errors import MessageMismatch
from jacaros.serving.callers import RequestError
from jacaros.serving.goals import ACHIEVED, PENDING, WAITING, RequestedGoal
from jacaros.serving.ros.forms import MISMATCH, Fields, GoalForm
from jacaros.serving.service import Session


class Pursuit:
    """A goal of the graph while the agent pursues it.

    Args:
        served: the goal of the graph.
        goal: the goal of the agent.
        form: writes the feedback.
    """

    def __init__(self, served: ServerGoal, goal: RequestedGoal, form: GoalForm) -> None:
        self._served, self.goal, self._form = served, goal, form
        self._last: Fields | None = None

    def report(self) -> None:
        """Send feedback if it differs from the last one."""
        goal = self.goal
        doing = "" if goal.over or goal.state in (PENDING, WAITING) else goal.doing()
        if not doing:
            return
        fields = self._form.feedback(doing, goal.progress, goal.note)
        if fields != self._last:
            self._last = fields
            self._served.feedback(fields)


class Pursuits:
    """The goals of the graph that agents pursue now, by the id that the agent's goal has."""

    def __init__(self) -> None:
        self._known: dict[str, Pursuit] = {}

    def __len__(self) -> int:
        return len(self._known)

    def changed(self, goal_id: str) -> None:
        """Send feedback of a goal that has changed."""
        found = self._known.get(goal_id)
        if found is not None:
            found.report()

    def look(self, most: int) -> None:
        """Send feedback of at most this number of goals. Those that are not looked at have their turn next."""
        for goal_id in list(self._known)[:most]:
            found = self._known[goal_id] = self._known.pop(goal_id)
            found.report()

    async def pursue(self, served: ServerGoal, session: Session, form: GoalForm) -> Fields | None:
        """Let the agent pursue a goal of the graph. Return the fields of the result.

        Raises:
            Abort: the goal was not achieved, or the request had no effect.
        """
        try:
            goal = form.give(session, served.request)
        except RequestError as error:
            raise Abort(error.message, form.refusal(error)) from None
        self._known[goal.id] = Pursuit(served, goal, form)
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
    except (MessageMismatch, *MISMATCH) as error:
        raise Abort(f"the result does not fit the type of the action: {error}") from None
    if goal.state == ACHIEVED or served.cancel_requested:
        return fields
    raise Abort(goal.message or goal.state, fields)
