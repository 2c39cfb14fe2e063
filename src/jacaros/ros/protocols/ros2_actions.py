"""ROS 2's actions, without input and output: what they are made of, and whether the server of a goal is still alive.

An action is three services and two topics below ``<name>/_action``, as the design article "Actions" says (design.ros2.org),
and ``action_msgs``.
"""

import time
import uuid
from collections.abc import Callable

from jacaros.ros.action import GoalStatus
from jacaros.ros.qos import QoS

ACTION = "/_action/"
"""Stands in the names of the topics and services that an action is made of."""
SEND_GOAL, GET_RESULT, CANCEL_GOAL = f"{ACTION}send_goal", f"{ACTION}get_result", f"{ACTION}cancel_goal"
FEEDBACK, STATUS = f"{ACTION}feedback", f"{ACTION}status"
FEEDBACK_QUALITY, STATUS_QUALITY = QoS(), QoS(durability="transient_local", depth=1)
"""ROS 2's profiles of these topics."""
RESULT_KEPT = 10.0
"""Seconds for which a server remembers a goal that is over, as rcl does."""

ENDS = {4: GoalStatus.SUCCEEDED, 5: GoalStatus.CANCELED, 6: GoalStatus.ABORTED}
"""What the numbers of ``action_msgs/msg/GoalStatus`` for goals that are over are called in the port."""
NUMBERS = {ours: number for number, ours in ENDS.items()}
UNKNOWN, ACCEPTED, EXECUTING, CANCELING = 0, 1, 2, 3
UNDER_WAY = (ACCEPTED, EXECUTING, CANCELING)
"""Those of goals that are not over."""


def new_goal_id() -> str:
    """Make up the id of a goal, as 32 hexadecimal digits."""
    return uuid.uuid4().hex


SILENCE = 1.0
"""Seconds without a sign after which the server is asked for one, and for an answer to that."""
GETTING_GOING = 0.3
"""Seconds that a goal is under way before it is tried whether the server answers meanwhile."""
LOOKED = 30.0
"""Seconds for which it is believed that a silent server is alive that was found in the graph with fresh eyes."""


class FailureDetector:
    """Watches over the server of an action while a goal is under way.

    Not every living server answers: one whose code blocks its only thread does not, until the goal is over.  So silence
    counts only where a probe was answered in the middle of a goal, and not any more once it was misread.  Where it does
    not count, and the server was never seen to answer yet, the graph is looked at with fresh eyes.

    Args:
        probe: asks the server for a sign; `probe_answered` tells of it.
        report: is told that the server seems to be gone (False) and that it is not (True).
        look: looks whether the server is in the graph that a newcomer finds; `looked` tells of it.
    """

    def __init__(
        self,
        probe: Callable[[], None],
        report: Callable[[bool], None],
        look: Callable[[], None] = lambda: None,
    ) -> None:
        self._probe = probe
        self._report = report
        self._look = look
        self._heard = 0.0
        self._goal_began = 0.0
        self._waiting_since: float | None = None
        self._look_began: float | None = None
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
            self._report(True)

    def probe_answered(self) -> None:
        """The server has answered a probe."""
        if self._probed is not None and self._probed >= self._goal_began + GETTING_GOING:
            self._answered = time.monotonic()
        self._probed = None

    def looked(self, found: bool) -> None:
        """The server was found by a newcomer, or not."""
        if found:
            if self._suspected:
                self.heard()
        elif self._look_began is not None and self._heard < self._look_began and not self._suspected:
            self._suspected = True
            self._report(False)

    def goal_begins(self) -> None:
        """The server has accepted a goal."""
        self._goal_began = time.monotonic()
        self._probed = self._answered = None

    def reset(self) -> None:
        """Another server is there: what was learnt about the former does not count."""
        self._answers = self._misleading = self._suspected = False
        self._probed = self._answered = self._look_began = None

    def rest(self) -> None:
        """No goal is under way."""
        self._probed = self._answered = self._look_began = self._waiting_since = None
        self._suspected = False

    def check(self, now: float, under_way: bool, waiting: bool = False) -> None:
        """Look whether the server is silent for too long.

        Args:
            now: as of `time.monotonic`.
            under_way: it is carrying out a goal.
            waiting: it has not said yet whether it accepts a goal.
        """
        if not waiting:
            self._waiting_since = None
        elif self._waiting_since is None:
            self._waiting_since = now
        if under_way and not self._misleading:
            self._check_answers(now)
        if under_way and (self._misleading or not self._answers):
            self._suspect(now, self._goal_began + GETTING_GOING)
        elif self._waiting_since is not None:
            self._suspect(now, self._waiting_since)

    def _check_answers(self, now: float) -> None:
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
                    self._report(False)
                    self._check_again(now)
                self._ask(now)

    def _suspect(self, now: float, since: float) -> None:
        if now > max(self._heard, since) + SILENCE:
            self._check_again(now)

    def _check_again(self, now: float) -> None:
        if self._look_began is None or now > self._look_began + LOOKED:
            self._look_began = now
            self._look()

    def _ask(self, now: float) -> None:
        self._probed = now
        self._probe()
