"""Contract: actions."""

from typing import Any

import pytest
from losses import LOST

from jacaros.robots.ros.errors import (
    CallFailed,
    CallTimedOut,
    GoalRejected,
    MessageMismatch,
    ServerLost,
    ServerUnavailable,
    ServiceError,
    UnknownInterface,
)

Pair = tuple[Any, Any]
pytestmark = pytest.mark.needs("actions")

SLOW = {"target": 500, "period": 0.1}
"""A goal that lasts longer than any test."""


def serving(graph: Any, pair: Pair, name: str, behaviour: str = "count", **policy: Any) -> Pair:
    """Let the right peer offer an action, and wait until the left one knows."""
    left, right = pair
    assert right.serve_action(name, behaviour, **policy) == name
    graph.wait_until(lambda: left.action_ready(name), "the action is found")
    return left, right


def under_way(graph, client, name, key=None):
    """Send a goal that lasts, and wait until its code runs."""
    client.send_goal(key or name, name, SLOW, timeout=60)
    graph.wait_until(lambda: client.feedback(key or name), "the goal is under way")


def test_a_goal_gives_feedback_and_a_result(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    goal_id = left.send_goal(topic, topic, {"target": 3, "period": 0.05}, timeout=60)
    assert goal_id
    assert left.outcome(topic, timeout=60) == {
        "status": "succeeded",
        "result": {"last": 3, "message": "counted"},
        "text": "counted",
    }
    graph.wait_until(lambda: len(left.feedback(topic)) == 3, "all feedback arrives")
    assert left.feedback(topic) == [1, 2, 3]
    assert right.deeds(topic) == [["begin", 3], ["end", 3, False]]
    told = [line for peer in (left, right) for line in peer.log() if f"topic {topic}/" in line]
    assert told == [], "the topics of an action carry what they should"


def test_the_outcome_is_known_to_all_who_wait_and_who_ask_later(graph, pair, topic):
    left, _ = serving(graph, pair, topic)
    left.send_goal(topic, topic, {"target": 2, "period": 0.1}, timeout=60)
    for waiter in ("a", "b"):
        left.begin_outcome(topic, timeout=60, waiter=waiter)
    ends = [left.end_outcome(topic + waiter) for waiter in ("a", "b")]
    ends.append(left.outcome(topic))
    assert [end["result"]["last"] for end in ends] == [2, 2, 2]


def test_no_result_means_the_defaults(graph, pair, topic):
    left, _ = serving(graph, pair, topic, "nothing")
    left.send_goal(topic, topic, None, timeout=60)
    end = left.outcome(topic, timeout=60)
    assert end == {"status": "succeeded", "result": {"last": 0, "message": ""}, "text": ""}


def test_each_node_serves_the_other_and_itself(graph, left, right, topic):
    serving(graph, (left, right), topic + "/right")
    serving(graph, (right, left), topic + "/left")
    for client, name in ((left, "/right"), (right, "/left"), (left, "/left")):
        key = topic + name
        graph.wait_until(lambda c=client, n=key: c.action_ready(n), "the action is found")
        client.send_goal(key, key, {"target": 1, "period": 0.01}, timeout=60)
        assert client.outcome(key, timeout=60)["result"]["last"] == 1


def test_several_goals_run_concurrently(graph, pair, topic):
    left, right = serving(graph, pair, topic, "count_together")
    for target in (4, 3, 2):
        left.send_goal(f"{topic}{target}", topic, {"target": target, "period": 0.1}, timeout=60)
    for target in (2, 3, 4):
        assert left.outcome(f"{topic}{target}", timeout=60)["result"]["last"] == target
        graph.wait_until(lambda t=target: len(left.feedback(f"{topic}{t}")) == t, "all feedback arrives")
        assert left.feedback(f"{topic}{target}") == list(range(1, target + 1))
    assert [deed[0] for deed in right.deeds(topic)] == ["begin"] * 3 + ["end"] * 3


def test_two_clients_get_what_is_theirs(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    graph.wait_until(lambda: right.action_ready(topic), "the action is found by its own node")
    left.send_goal(topic, topic, {"target": 3, "period": 0.1}, timeout=60)
    right.send_goal(topic, topic, {"target": 2, "period": 0.1}, timeout=60)
    assert right.outcome(topic, timeout=60)["result"]["last"] == 2
    assert left.outcome(topic, timeout=60)["result"]["last"] == 3
    graph.wait_until(lambda: len(left.feedback(topic)) == 3, "all feedback arrives")
    graph.wait_until(lambda: len(right.feedback(topic)) == 2, "all feedback arrives")
    assert (left.feedback(topic), right.feedback(topic)) == ([1, 2, 3], [1, 2])


def test_a_goal_can_be_cancelled(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    under_way(graph, left, topic)
    assert left.cancel_goal(topic, timeout=60) is True
    end = left.outcome(topic, timeout=60)
    assert (end["status"], end["result"]["last"]) == ("canceled", 0)
    graph.wait_until(lambda: len(right.deeds(topic)) == 2, "the code has ended")
    assert right.deeds(topic) == [["begin", 500], ["end", 500, True]]
    assert left.cancel_goal(topic, timeout=60) is False  # it is over


def test_a_cancelled_goal_may_have_a_result(graph, pair, topic):
    left, _ = serving(graph, pair, topic, "count_and_tell_where")
    left.send_goal(topic, topic, SLOW, timeout=60)
    graph.wait_until(lambda: len(left.feedback(topic)) >= 2, "the goal is under way")
    assert left.cancel_goal(topic, timeout=60) is True
    end = left.outcome(topic, timeout=60)
    assert (end["status"], end["result"]["message"]) == ("canceled", "stopped")
    assert end["result"]["last"] >= 2


@pytest.mark.needs("refusing goals")
def test_a_server_may_refuse_to_cancel(graph, pair, topic):
    left, _ = serving(graph, pair, topic, may_cancel=False)
    left.send_goal(topic, topic, {"target": 8, "period": 0.1}, timeout=60)
    graph.wait_until(lambda: left.feedback(topic), "the goal is under way")
    assert left.cancel_goal(topic, timeout=60) is False
    assert left.outcome(topic, timeout=60)["status"] == "succeeded"


def test_a_newer_goal_takes_over_where_goals_preempt(graph, pair, topic):
    left, right = serving(graph, pair, topic, "count_and_tell_where", preempt=True)
    under_way(graph, left, topic, topic + "old")
    left.send_goal(topic + "new", topic, {"target": 1, "period": 0.05}, timeout=60)
    old, new = left.outcome(topic + "old", timeout=60), left.outcome(topic + "new", timeout=60)
    assert (old["status"], old["result"]["message"]) == ("aborted", "stopped")
    assert (new["status"], new["result"]["last"]) == ("succeeded", 1)
    # The code of the new one begins when that of the old one has ended: two never drive one robot.
    assert right.deeds(topic) == [["begin", 500], ["end", 500, False], ["begin", 1], ["end", 1, False]]


def test_a_goal_is_sent_when_the_cancelled_one_before_it_has_ended(graph, pair, topic):
    left, right = serving(graph, pair, topic, "stop_slowly")
    under_way(graph, left, topic, topic + "old")
    assert left.cancel_goal(topic + "old", timeout=60) is True
    left.send_goal(topic + "new", topic, {"target": 1, "period": 0.05}, timeout=60)
    assert left.outcome(topic + "old", timeout=60)["status"] == "canceled"
    assert left.outcome(topic + "new", timeout=60)["status"] == "succeeded"
    assert right.deeds(topic) == [["begin", 500], ["end", 500, True], ["begin", 1], ["end", 1, False]]


def test_goals_that_wait_for_their_server_arrive_in_their_order(graph, left, right, topic):
    targets = [1, 2, 3, 4, 5]
    for target in targets:
        left.begin_send(f"{topic}{target}", topic, {"target": target, "period": 0.01}, timeout=LOST)
    right.serve_action(topic, "count")
    for target in targets:
        left.end_send(f"{topic}{target}")
        assert left.outcome(f"{topic}{target}", timeout=60)["result"]["last"] == target
    assert [deed[1] for deed in right.deeds(topic) if deed[0] == "begin"] == targets


def test_a_preempted_goal_says_why(graph, pair, topic):
    left, _ = serving(graph, pair, topic, preempt=True)
    under_way(graph, left, topic, topic + "old")
    left.send_goal(topic + "new", topic, {"target": 1}, timeout=60)
    old = left.outcome(topic + "old", timeout=60)
    assert (old["status"], old["text"]) == ("aborted", "preempted by a newer goal")
    assert left.outcome(topic + "new", timeout=60)["status"] == "succeeded"


@pytest.mark.needs("refusing goals")
def test_a_goal_can_be_rejected(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    with pytest.raises(GoalRejected, match=topic):
        left.send_goal(topic, topic, {"target": -1}, timeout=60)
    assert right.deeds(topic) == []


def test_aborting_sends_a_text_and_a_result(graph, pair, topic):
    left, _ = serving(graph, pair, topic, "give_up")
    left.send_goal(topic, topic, {"target": 3}, timeout=60)
    assert left.outcome(topic, timeout=60) == {
        "status": "aborted",
        "result": {"last": 1, "message": "cannot count so far"},
        "text": "cannot count so far",
    }


def test_aborting_needs_no_result(graph, pair, topic):
    left, _ = serving(graph, pair, topic, "give_up_without_a_result")
    left.send_goal(topic, topic, {"target": 3}, timeout=60)
    end = left.outcome(topic, timeout=60)
    assert (end["status"], end["text"], end["result"]["last"]) == ("aborted", "cannot count", 0)


@pytest.mark.parametrize(
    ("behaviour", "said"),
    [
        ("fail", "no numbers today"),
        ("answer_wrongly", "no field 'total'"),
        ("tell_wrongly", "no field 'currant'"),
    ],
)
def test_code_that_fails_aborts_its_goal(graph, pair, topic, behaviour, said):
    topic = f"{topic}/{behaviour}"
    left, right = serving(graph, pair, topic, behaviour)
    left.send_goal(topic, topic, {"target": 1}, timeout=60)
    end = left.outcome(topic, timeout=60)
    assert end["status"] == "aborted"
    assert said in end["text"]
    assert any(said in line for line in right.log())
    # and the server lives on
    left.send_goal(topic + "again", topic, {"target": 1}, timeout=60)
    assert left.outcome(topic + "again", timeout=60)["status"] == "aborted"


def test_waiting_for_the_outcome_can_time_out_without_harm(graph, pair, topic):
    left, _ = serving(graph, pair, topic)
    left.send_goal(topic, topic, SLOW, timeout=60)
    with pytest.raises(CallTimedOut, match=r"still active after 0\.3 s"):
        left.outcome(topic, timeout=0.3)
    assert left.cancel_goal(topic, timeout=60) is True
    assert left.outcome(topic, timeout=60)["status"] == "canceled"


def test_a_missing_server_is_unavailable_after_the_time_out(graph, left, topic):
    assert left.action_ready(topic) is False
    with pytest.raises(ServerUnavailable, match=rf"{topic}.*within 0\.3 s"):
        left.send_goal(topic, topic, {"target": 1}, timeout=0.3)
    assert f"waiting for the action {topic} (jacaros_interfaces/action/Count)" in left.log()


def test_a_server_that_comes_late_gets_the_goal(graph, left, right, topic):
    left.begin_send(topic, topic, {"target": 2, "period": 0.01}, timeout=60)
    graph.pass_time(0.2)
    right.serve_action(topic)
    assert left.end_send(topic)
    assert left.outcome(topic, timeout=60)["result"]["last"] == 2


def test_sending_can_be_cancelled_while_waiting_for_the_server(graph, left, right, topic):
    left.begin_send(topic, topic, SLOW)
    graph.pass_time(0.1)
    assert left.give_up_send(topic) is True
    right.serve_action(topic)
    graph.wait_until(lambda: left.action_ready(topic), "the action is found")
    left.send_goal(topic + "other", topic, {"target": 1}, timeout=60)
    left.outcome(topic + "other", timeout=60)
    assert [deed[:2] for deed in right.deeds(topic)] == [["begin", 1], ["end", 1]]


def test_giving_up_a_goal_that_was_just_sent_cancels_it(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    left.begin_send(topic, topic, SLOW)
    if not left.give_up_send(topic):  # it was accepted before that, as it happens
        assert left.cancel_goal(topic, timeout=60) is True
    left.send_goal(topic + "other", topic, {"target": 1}, timeout=60)
    left.outcome(topic + "other", timeout=60)

    def none_is_under_way() -> bool:
        deeds = right.deeds(topic)
        return [d[1] for d in deeds if d[0] == "begin"].count(500) == [
            d[1] for d in deeds if d[0] == "end"
        ].count(500)

    graph.wait_until(none_is_under_way, "the abandoned goal is not active")


def test_closing_the_server_aborts_what_is_under_way(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    under_way(graph, left, topic)
    right.unserve_action(topic)
    end = left.outcome(topic, timeout=60)
    assert (end["status"], end["text"]) == ("aborted", "the server was closed")
    graph.wait_until(lambda: ["end", 500, False] in right.deeds(topic), "the code has ended")
    graph.wait_until(lambda: not left.action_ready(topic), "the client notices")
    with pytest.raises(ServerUnavailable):
        left.send_goal(topic, topic, SLOW, timeout=0.3)


def test_closing_the_client_cancels_its_goals(graph, pair, topic):
    left, right = serving(graph, pair, topic)
    under_way(graph, left, topic)
    left.begin_outcome(topic)
    left.close_action_client(topic)
    with pytest.raises(CallFailed, match="closed"):
        left.end_outcome(topic)
    graph.wait_until(lambda: ["end", 500, True] in right.deeds(topic), "the goal is cancelled")


@pytest.mark.needs("dying servers")
def test_a_server_that_dies_is_lost(graph, left, topic):
    mortal = graph.peer("mortal_server")
    serving(graph, (left, mortal), topic)
    under_way(graph, left, topic)
    left.begin_outcome(topic)
    graph.kill(mortal)
    graph.wait_until(lambda: left.outcome_known(topic), "the loss is noticed", LOST)
    with pytest.raises(ServerLost, match=topic):
        left.end_outcome(topic)
    with pytest.raises(ServerLost):
        left.outcome(topic)
    with pytest.raises(ServerLost):
        left.cancel_goal(topic, timeout=5)
    # With a new server the same client continues.
    second = graph.peer("second_server")
    serving(graph, (left, second), topic)
    left.send_goal(topic + "again", topic, {"target": 1}, timeout=60)
    assert left.outcome(topic + "again", timeout=60)["status"] == "succeeded"


def test_a_client_that_dies_does_the_server_no_harm(graph, left, right, topic):
    mortal = graph.peer("mortal_client")
    serving(graph, (mortal, right), topic)
    mortal.send_goal(topic, topic, {"target": 5, "period": 0.1}, timeout=60)
    graph.wait_until(lambda: mortal.feedback(topic), "the goal is under way")
    graph.kill(mortal)
    graph.wait_until(lambda: left.action_ready(topic), "the action is found")
    left.send_goal(topic, topic, {"target": 1}, timeout=60)
    assert left.outcome(topic, timeout=60)["status"] == "succeeded"


def test_names_are_resolved(graph, right):
    robot = graph.peer("counting_brain", namespace="counting_robot")
    assert robot.serve_action("count") == "/counting_robot/count"
    graph.wait_until(lambda: right.action_ready("/counting_robot/count"), "the action is found")
    right.send_goal("names", "/counting_robot/count", {"target": 1}, timeout=60)
    assert right.outcome("names", timeout=60)["status"] == "succeeded"


def test_goals_are_checked_before_they_are_sent(graph, left, topic):
    assert left.goal_message(topic, target=7) == {"target": 7, "period": 0.0}
    with pytest.raises(MessageMismatch, match="no field 'goal'"):
        left.send_goal(topic, topic, {"goal": 7}, timeout=1)
    with pytest.raises(MessageMismatch, match="target is int32"):
        left.send_goal(topic, topic, {"target": 1.5}, timeout=1)


def test_an_unknown_action_type_is_refused(graph, left, right, topic):
    with pytest.raises(UnknownInterface, match="no_actions/action/Nothing"):
        right.serve_action(topic, type_name="no_actions/action/Nothing")
    with pytest.raises(UnknownInterface, match="no_actions/action/Nothing"):
        left.action_ready(topic, "no_actions/action/Nothing")


def test_a_server_of_another_type_is_not_used(graph, left, right, topic):
    right.serve_action(topic, "nothing", "nav2_msgs/action/NavigateToPose")
    graph.pass_time(0.5)
    with pytest.raises(ServiceError, match=topic):
        left.send_goal(topic, topic, {"target": 1}, timeout=1)
    assert right.deeds(topic) == []
