"""Action clients of ROS 1 graphs: actionlib's protocol as a `GoalWire`."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from jacaros.clock import Timer
from jacaros.ros.action import GoalStatus, Outcome
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.action_serving import text_of
from jacaros.ros.actionlib_states import (
    CANCELLING,
    COMMANDS,
    ENDS,
    ENOUGH_NEWS,
    ID_TYPE,
    NEWS,
    STATUS,
    STATUS_PERIOD,
    STATUS_TYPE,
    UNDER_WAY,
    ActionTopicsNode,
    State,
    part_type,
)
from jacaros.ros.backend import Sample
from jacaros.ros.errors import ServerLost
from jacaros.ros.names import result_type

LOOKING = 0.02
"""Seconds between two looks for a server that is awaited."""
QUIET = 4
"""So many `STATUS_PERIOD` without a word of the server, and it is called away; `SERVER_LOST_AFTER` begins then."""
SENT_AGAIN_AFTER = 1.0
"""Seconds in which a server that runs mentions a goal that it was sent; one that does not has not got it.  Between the two
topics being connected and the first message, a goal can get lost: rospy's publishers, and a bridge's, know a subscriber
before it hears them.  A server that has got it after all ignores the second, for it has the same id."""
OVERTAKEN = "it was lost on its way to the server, which has accepted a newer goal"
REFUSED_AFTER = 1.0
"""Seconds in which a request for cancelling must show in the goal's state: actionlib's servers do not say no."""

_numbers = itertools.count(1)


@dataclass(slots=True)
class _Goal:
    """What is known of a goal under way.

    Attributes:
        message: what was sent.
        sent: when it was, for the last time.
        heard_of: the server has mentioned it.
        accepted: by the server.
        overtaken: the server has accepted a newer one, and had not heard of this one.
        missing: messages about the server's goals, one after the other, in which it was not mentioned.
        ended: such messages that called it ended, while its result has not come.
        cancelling: when cancelling was asked for, until it is answered.
        unmoved: such messages since then that called it active.
    """

    message: Any
    sent: float
    heard_of: bool = False
    accepted: bool = False
    overtaken: bool = False
    missing: int = 0
    ended: int = 0
    cancelling: float | None = None
    unmoved: int = 0


class ActionlibWire:
    """The five topics of one action, as its client uses them.

    Args:
        node: the backend.
        sender: the client.
    """

    def __init__(self, node: ActionTopicsNode, sender: GoalSender) -> None:
        self._node = node
        self._sender = sender
        name, kind = sender.name, sender.type_name
        self._result_type = result_type(kind)
        self._goals: dict[str, _Goal] = {}
        self._complete = self._heard = self._present = self._closed = False
        self._quiet = 0
        self._timer: Timer | None = None
        self._goal = node.publisher(f"{name}/goal", part_type(kind, "ActionGoal"), COMMANDS)
        self._cancel = node.publisher(f"{name}/cancel", ID_TYPE, COMMANDS)
        self._status = node.subscription(f"{name}/status", STATUS_TYPE, self._take_status, STATUS)
        self._feedback = node.subscription(
            f"{name}/feedback", part_type(kind, "ActionFeedback"), self._take_feedback, NEWS
        )
        self._result = node.subscription(
            f"{name}/result", part_type(kind, "ActionResult"), self._take_result, NEWS
        )
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    @property
    def offered(self) -> bool:
        """Whether a server is there, with all five topics connected.  Asking for it makes the wire look out."""
        self._look()
        return self._present

    def new_id(self) -> str:
        """Make up the id of a new goal."""
        return self._node.orphans.named_id(next(_numbers), self._node.clock.now())

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message."""
        now = self._node.clock.now()
        message = self._goal.message(header={"stamp": now}, goal_id={"stamp": now, "id": goal_id}, goal=goal)
        self._goals[goal_id] = _Goal(message, self._node.clock.elapsed)
        self._goal.publish(message)
        self._look()

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal."""
        goal = self._goals.get(goal_id)
        if goal is not None and goal.cancelling is None:
            goal.cancelling, goal.unmoved = self._node.clock.elapsed, 0
        self._cancel.publish(self._cancel.message(id=goal_id))

    def adopt_goal(self, goal_id: str) -> None:
        """Follow a goal of an earlier run."""
        self._goals[goal_id] = _Goal(None, self._node.clock.elapsed, heard_of=True, accepted=True)

    def forget_goal(self, goal_id: str) -> None:
        """The goal is over for this client."""
        self._goals.pop(goal_id, None)

    def close(self) -> None:
        """Leave the five topics."""
        self._closed = True
        self._forget_hook()
        if self._timer is not None:
            self._timer.cancel()
        for end in (self._goal, self._cancel, self._status, self._feedback, self._result):
            end.close()

    def _cancel_all(self) -> None:
        """An exit hook: a process that ends leaves no robot driving to its goal."""
        for goal_id in list(self._goals):
            self._cancel.publish(self._cancel.message(id=goal_id))

    # Whether the server is there: connections tell no changes, so they are looked at while somebody cares.

    def _look(self) -> None:
        if self._closed:
            return
        publishers = self._status.publisher_count
        complete = (
            publishers > 0
            and self._feedback.publisher_count > 0
            and self._result.publisher_count > 0
            and self._goal.subscription_count > 0
            and self._cancel.subscription_count > 0
        )
        if complete and not self._complete:
            self._lose_unanswered()
            # A publisher is seen a moment before it knows us, and what it says meanwhile is lost, be it a result.
            self._heard = False
        if publishers == 0:
            self._heard = False
        self._complete = complete
        self._set_present(complete and self._heard)
        if self._timer is None and (self._sender.busy or not self._present):
            delay = STATUS_PERIOD if self._present else LOOKING
            self._timer = self._node.clock.call_later(delay, self._tick)

    def _tick(self) -> None:
        self._timer = None
        self._quiet += 1
        if self._present and self._quiet >= QUIET:
            self._heard = False
        if self._sender.busy:
            self._look()

    def _note_server(self) -> None:
        """A message of the server has come."""
        self._quiet = 0
        self._heard = True
        if not self._present:
            self._look()

    def _set_present(self, present: bool) -> None:
        if present != self._present:
            self._present = present
            self._quiet = 0
            self._sender.server_present(present)

    def _lose_unanswered(self) -> None:
        """A server is there after none was: it has never heard of the goals that were not accepted."""
        for goal_id, goal in list(self._goals.items()):
            if not goal.accepted:
                self._lose(goal_id, "went away before it accepted")

    def _lose(self, goal_id: str, how: str) -> None:
        self._sender.fail(
            goal_id, ServerLost(f"the server of action {self._sender.name} {how} goal {goal_id}")
        )

    # What the server says:

    def _take_status(self, sample: Sample) -> None:
        self._note_server()
        if self._present:  # else a request for cancelling would be lost
            listed = sample.message.status_list
            self._sender.goals_under_way(
                each.goal_id.id for each in listed if State(each.status) in UNDER_WAY
            )
        if not self._goals:
            return
        told = {
            status.goal_id.id: status
            for status in sample.message.status_list
            if status.goal_id.id in self._goals
        }
        for goal_id, goal in list(self._goals.items()):
            status = told.get(goal_id)
            if status is not None:
                goal.missing = 0
                goal.heard_of = True
                self._advance(goal_id, goal, status)
                continue
            goal.missing += 1
            if goal.missing < ENOUGH_NEWS:
                continue
            if goal.accepted:
                self._lose(goal_id, "has been started again and does not know")
            elif not goal.heard_of:
                self._see_lost(goal_id, goal)

    def _see_lost(self, goal_id: str, goal: _Goal) -> None:
        """A goal seems to be lost on its way: send it again, unless a newer one has taken its place."""
        now = self._node.clock.elapsed
        if now - goal.sent < SENT_AGAIN_AFTER or not self._sender.wants(goal_id):
            return
        # A server that pursues one goal at a time would leave the newer one for the older, or begin it after that.
        if goal.overtaken:
            self.cancel_goal(goal_id)
            result = self._node.factory.make(self._result_type)
            self._sender.ended(goal_id, Outcome(GoalStatus.CANCELED, result, OVERTAKEN))
        elif not any(newer.heard_of for newer in self._newer_than(goal)):
            goal.sent, goal.missing = now, 0
            self._goal.publish(goal.message)

    def _newer_than(self, goal: _Goal) -> Iterator[_Goal]:
        return itertools.islice(
            itertools.dropwhile(lambda each: each is not goal, self._goals.values()), 1, None
        )

    def _advance(self, goal_id: str, goal: _Goal, status: Any) -> None:
        state = State(status.status)
        if state is State.REJECTED:
            self._sender.rejected(goal_id, status.text)
            return
        if state not in (State.PENDING, State.RECALLING):
            self._accept(goal_id, goal)
        if goal.cancelling is not None:
            self._see_cancelling(goal_id, goal, state)
        if state in ENDS:
            goal.ended += 1
            if goal.ended >= ENOUGH_NEWS:  # the result was lost: there is none to wait for
                result = self._node.factory.make(self._result_type)
                self._sender.ended(goal_id, Outcome(ENDS[state], result, status.text))

    def _accept(self, goal_id: str, goal: _Goal) -> None:
        if not goal.accepted:
            goal.accepted = True
            for older in itertools.takewhile(lambda each: each is not goal, self._goals.values()):
                older.overtaken = not older.heard_of and not older.accepted
            self._sender.accepted(goal_id)

    def _see_cancelling(self, goal_id: str, goal: _Goal, state: State) -> None:
        assert goal.cancelling is not None
        if state in CANCELLING:
            goal.cancelling = None
            self._sender.cancel_answered(goal_id, True)
        elif state is State.ACTIVE:
            goal.unmoved += 1
            if goal.unmoved >= ENOUGH_NEWS and self._node.clock.elapsed - goal.cancelling >= REFUSED_AFTER:
                goal.cancelling = None
                self._sender.cancel_answered(goal_id, False)

    def _take_feedback(self, sample: Sample) -> None:
        self._note_server()
        message = sample.message
        goal_id = message.status.goal_id.id
        goal = self._goals.get(goal_id)
        if goal is not None:
            self._accept(goal_id, goal)
            self._sender.feedback(goal_id, message.feedback)

    def _take_result(self, sample: Sample) -> None:
        self._note_server()
        message = sample.message
        goal_id, state = message.status.goal_id.id, State(message.status.status)
        goal = self._goals.get(goal_id)
        if goal is None:
            return
        text = message.status.text or text_of(message.result)
        if state is State.REJECTED:
            self._sender.rejected(goal_id, text)
        elif state in ENDS:
            self._accept(goal_id, goal)
            self._sender.ended(goal_id, Outcome(ENDS[state], message.result, text))
