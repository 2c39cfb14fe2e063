"""actionlib's protocol on the client's side, without topics and without a loop: what a client makes of a server's words."""

from typing import Any

from jacaros.robots.ros.action import GoalOutcome, GoalStatus
from jacaros.robots.ros.errors import ServiceError
from jacaros.robots.ros.protocols.actionlib import ENOUGH_NEWS, OVERTAKEN, GoalState, SentGoal, SentGoals


class Client:
    """Notes what `SentGoals` tells and asks; takes the place of an `ActionClient`."""

    name = "act"

    def __init__(self) -> None:
        self.told: list[tuple[Any, ...]] = []
        self.goals = SentGoals(
            self,  # type: ignore[arg-type]
            lambda: "no result",
            lambda message: self.told.append(("send again", message)),
            lambda goal_id: self.told.append(("send cancel", goal_id)),
        )

    def sends(self, goal_id: str, now: float = 0.0) -> None:
        self.goals[goal_id] = SentGoal(f"message of {goal_id}", now)

    def hears(self, now: float = 0.0, times: int = 1, **states: GoalState) -> list[tuple[Any, ...]]:
        """Receive the server's list of goals N times; return what it reported."""
        self.told.clear()
        for _ in range(times):
            self.goals.take_status([(name, state, "") for name, state in states.items()], now)
        return list(self.told)

    def accepted(self, goal_id: str) -> None:
        self.told.append(("accepted", goal_id))

    def ended(self, goal_id: str, outcome: GoalOutcome) -> None:
        self.told.append(("ended", goal_id, outcome.status, outcome.result, outcome.text))
        del self.goals[goal_id]

    def fail(self, goal_id: str, problem: ServiceError) -> None:
        self.told.append(("lost", goal_id, str(problem)))
        del self.goals[goal_id]

    def cancel_answered(self, goal_id: str, agreed: bool) -> None:
        self.told.append(("cancel answered", goal_id, agreed))

    def wants(self, goal_id: str) -> bool:
        return True


def test_a_goal_is_accepted_once_and_ends_with_its_result() -> None:
    client = Client()
    client.sends("a")
    assert client.hears(a=GoalState.PENDING) == []
    assert client.hears(a=GoalState.ACTIVE, times=3) == [("accepted", "a")]
    client.goals.take_result("a", GoalState.SUCCEEDED, "result", "there")
    assert client.told[-1] == ("ended", "a", GoalStatus.SUCCEEDED, "result", "there")
    assert client.hears(a=GoalState.SUCCEEDED) == [], "no caller waits for it"


def test_a_result_that_was_lost_is_not_awaited_for_ever() -> None:
    client = Client()
    client.sends("a")
    assert client.hears(a=GoalState.ABORTED, times=ENOUGH_NEWS - 1) == [("accepted", "a")]
    assert client.hears(a=GoalState.ABORTED) == [("ended", "a", GoalStatus.ABORTED, "no result", "")]


def test_a_goal_that_never_arrived_is_sent_again_but_not_immediately() -> None:
    client = Client()
    client.sends("a")
    assert client.hears(0.9, times=2 * ENOUGH_NEWS) == [], "it may be on its way"
    assert client.hears(1.1) == [("send again", "message of a")]
    assert client.hears(1.2, times=ENOUGH_NEWS) == [], "so may the second"


def test_a_replaced_goal_is_not_sent_again() -> None:
    client = Client()
    client.sends("a")
    client.sends("b")
    assert client.hears(1.0, b=GoalState.ACTIVE) == [("accepted", "b")]
    told = client.hears(2.0, times=ENOUGH_NEWS, b=GoalState.ACTIVE)
    assert told == [("send cancel", "a"), ("ended", "a", GoalStatus.CANCELED, "no result", OVERTAKEN)]


def test_a_server_that_was_started_again_does_not_know_the_goal() -> None:
    client = Client()
    client.sends("a")
    client.hears(a=GoalState.ACTIVE)
    lost = "the server of action act was restarted and does not know goal a"
    assert client.hears(5.0, times=ENOUGH_NEWS) == [("lost", "a", lost)]


def test_a_request_for_cancelling_is_refused_by_silence() -> None:
    client = Client()
    client.sends("a")
    client.hears(a=GoalState.ACTIVE)
    client.goals.ask_to_cancel("a", 1.0)
    assert client.told[-1] == ("send cancel", "a")
    assert client.hears(1.9, times=ENOUGH_NEWS, a=GoalState.ACTIVE) == []
    assert client.hears(2.1, a=GoalState.ACTIVE) == [("cancel answered", "a", False)]
    client.goals.ask_to_cancel("a", 3.0)
    assert client.hears(3.1, a=GoalState.PREEMPTING) == [("cancel answered", "a", True)]


def test_goals_without_an_answer_are_lost_with_their_server() -> None:
    client = Client()
    client.sends("a")
    client.sends("b")
    client.hears(a=GoalState.ACTIVE)
    client.told.clear()
    client.goals.lose_unanswered()
    assert client.told == [("lost", "b", "the server of action act went away before it accepted goal b")]
