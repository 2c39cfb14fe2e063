"""Records of goals."""

import pytest

from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import functor
from jacaros.runtime.mas.history.goals import GoalRecords


@pytest.fixture
def told():
    """The records, as ``id state goal``. Called with the reports of a mind."""
    lines = []
    news = GoalRecords(lambda goal: lines.append(f"{goal.id} {goal.agent} {goal.state} {goal.goal}"))

    def hear(*states, agent="bob", goal="!patrol", number=139_867):
        for state in states:
            news.take(agent, state, goal, number, 1)
        return lines

    return hear


def test_work_for_a_goal_is_recorded_once(told):
    assert told("executing", "executing", "executing", "achieved") == [
        "1 bob pursued !patrol",
        "1 bob achieved !patrol",
    ]


def test_a_goal_that_is_resumed_is_not_pursued_anew(told):
    told("executing", "suspended", "resumed", "executing", "failed")
    assert [line.split()[2] for line in told()] == ["pursued", "suspended", "resumed", "failed"]


def test_goals_are_counted_whatever_numbers_they_have_in_their_minds(told):
    told("executing")
    told("executing", agent="eve", number=1)
    told("achieved")
    told("executing")
    told("executing", goal="!charge", number=7)
    assert told()[-3:] == ["1 bob achieved !patrol", "3 bob pursued !patrol", "4 bob pursued !charge"]


def test_events_and_waits_are_not_recorded_as_goals(told):
    assert told("waiting") == []
    heard = []
    news = GoalRecords(heard.append)
    news("bob", "executing", (trigger("+", "", functor("bump", 0)),), 1, 1)
    assert heard == []
    news("bob", "executing", (trigger("+", "!", functor("bump", 0)),), 2, 1)
    assert [goal.goal for goal in heard] == ["!bump"]


def test_a_goal_whose_failure_was_handled_has_ended(told):
    told("executing", "failed", "executing", "executing", "recovered", "finished")
    assert [line.split()[2] for line in told()] == ["pursued", "failed", "pursued", "recovered"]


def test_the_end_of_a_goal_is_recorded_once(told):
    told("executing", "achieved", "finished")
    told("executing", "failed", "finished")
    told("executing", "dropped", "finished")
    assert [line.split()[2] for line in told()] == [
        *("pursued", "achieved"),
        *("pursued", "failed"),
        *("pursued", "dropped"),
    ]


def test_the_reason_of_a_failed_goal_is_recorded():
    told = []
    news = GoalRecords(told.append)
    news.take("bob", "executing", "!patrol", 1, 1)
    news.take("bob", "failed", "!patrol", 1, 1, "no way")
    assert ["why" in each.plain() for each in told] == [False, True]
    assert told[1].why == "no way"


def test_a_goal_ends_with_its_intention(told):
    told("executing", "finished", "failed", "finished", "dropped")
    assert [line.split()[2] for line in told()] == ["pursued", "dropped"]
