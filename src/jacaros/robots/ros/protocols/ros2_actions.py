"""ROS 2's actions, without input and output: their services and topics, and the liveness of a goal's server.

An action consists of three services and two topics below ``<name>/_action``, as defined in the design article
"Actions" (design.ros2.org) and ``action_msgs``.
"""

import time
import uuid
from collections.abc import Callable

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.qos import QoS

ACTION = "/_action/"
"""Part of the names of an action's topics and services."""
SEND_GOAL, GET_RESULT, CANCEL_GOAL = f"{ACTION}send_goal", f"{ACTION}get_result", f"{ACTION}cancel_goal"
FEEDBACK, STATUS = f"{ACTION}feedback", f"{ACTION}status"
FEEDBACK_QUALITY, STATUS_QUALITY = QoS(), QoS(durability="transient_local", depth=1)
"""ROS 2's profiles of these topics."""
RESULT_KEPT = 10.0
"""Seconds for which a server stores an ended goal, as rcl does."""

ENDS = {4: GoalStatus.SUCCEEDED, 5: GoalStatus.CANCELED, 6: GoalStatus.ABORTED}
"""Statuses in the port for the numbers of ``action_msgs/msg/GoalStatus`` of ended goals."""
NUMBERS = {ours: number for number, ours in ENDS.items()}
UNKNOWN, ACCEPTED, EXECUTING, CANCELING = 0, 1, 2, 3
UNDER_WAY = (ACCEPTED, EXECUTING, CANCELING)
"""The statuses of active goals."""


def new_goal_id() -> str:
    """Return the id of a new goal, as 32 hexadecimal digits."""
    return uuid.uuid4().hex


SILENCE = 1.0
"""Seconds of silence after which the server is probed, and then for the answer."""
GETTING_GOING = 0.3
"""Seconds from the beginning of a goal until the first probe, which tests whether the server answers during goals."""
LOOKED = 30.0
"""Seconds for which a silent server counts as alive after a liveness check has found it."""


class FailureDetector:
    """Monitors the server of an action while a goal is active.

    Not every living server answers: one whose code blocks its only thread is silent until the goal has ended. So
    silence counts only if a probe was answered in the middle of a goal, and no longer after a false suspicion. Where
    it does not count, and the server has never answered, a liveness check of the graph decides.

    Args:
        probe: sends a probe to the server; the answer is reported to `probe_answered`.
        report: called with False if the server is suspected to be gone, and with True if it is not.
        look: starts a liveness check of the graph; the result is reported to `looked`.
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
        """Note that a message of the server has arrived."""
        self._heard = time.monotonic()
        if self._suspected:
            self._suspected = False
            self._misleading = True
            self._report(True)

    def probe_answered(self) -> None:
        """Note that the server has answered a probe."""
        if self._probed is not None and self._probed >= self._goal_began + GETTING_GOING:
            self._answered = time.monotonic()
        self._probed = None

    def looked(self, found: bool) -> None:
        """Note whether the liveness check has found the server."""
        if found:
            if self._suspected:
                self.heard()
        elif self._look_began is not None and self._heard < self._look_began and not self._suspected:
            self._suspect()

    def goal_begins(self) -> None:
        """Note that the server has accepted a goal."""
        self._goal_began = time.monotonic()
        self._probed = self._answered = None

    def reset(self) -> None:
        """Forget what is known of the previous server: another one is there."""
        self._answers = self._misleading = self._suspected = False
        self._probed = self._answered = self._look_began = None

    def rest(self) -> None:
        """Stop monitoring: no goal is active."""
        self._probed = self._answered = self._look_began = self._waiting_since = None
        self._suspected = False

    def check(self, now: float, under_way: bool, waiting: bool = False) -> None:
        """Check whether the server has been silent for too long.

        Args:
            now: time of `time.monotonic`.
            under_way: whether it is executing a goal.
            waiting: whether it has neither accepted nor rejected a goal yet.
        """
        if not waiting:
            self._waiting_since = None
        elif self._waiting_since is None:
            self._waiting_since = now
        if under_way and not self._misleading:
            self._check_answers(now)
        since = self._waiting_since
        if under_way and (self._misleading or not self._answers):
            since = self._goal_began + GETTING_GOING
        if since is not None and now > max(self._heard, since) + SILENCE:
            self._check_again(now)

    def _check_answers(self, now: float) -> None:
        if self._answered is not None and now > self._answered + GETTING_GOING:
            # The goal continued after the answer, so the answer did not wait for its end.
            self._answers = True
        if not self._answers:
            if self._probed is None and self._answered is None and now > self._goal_began + GETTING_GOING:
                self._ask(now)
        elif now > self._heard + SILENCE:
            if self._probed is None:
                self._ask(now)
            elif now > self._probed + SILENCE:
                if not self._suspected:
                    self._suspect()
                    self._check_again(now)
                self._ask(now)

    def _suspect(self) -> None:
        self._suspected = True
        self._report(False)

    def _check_again(self, now: float) -> None:
        if self._look_began is None or now > self._look_began + LOOKED:
            self._look_began = now
            self._look()

    def _ask(self, now: float) -> None:
        self._probed = now
        self._probe()
