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
    lines = told("executing", "executing", "executing", "achieved")
    assert lines == ["1 bob pursued !patrol", "1 bob achieved !patrol"]


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


@pytest.mark.parametrize(
    ("reported", "recorded"),
    [
        ("executing suspended resumed executing failed", "pursued suspended resumed failed"),
        ("executing failed executing executing recovered finished", "pursued failed pursued recovered"),
        ("executing achieved finished", "pursued achieved"),
        ("executing failed finished", "pursued failed"),
        ("executing dropped finished", "pursued dropped"),
        ("executing finished failed finished dropped", "pursued dropped"),
    ],
)
def test_the_end_of_a_goal_is_recorded_once(told, reported, recorded):
    told(*reported.split())
    assert [line.split()[2] for line in told()] == recorded.split()


def test_the_reason_of_a_failed_goal_is_recorded():
    told = []
    news = GoalRecords(told.append)
    news.take("bob", "executing", "!patrol", 1, 1)
    news.take("bob", "failed", "!patrol", 1, 1, "no way")
    assert ["why" in each.plain() for each in told] == [False, True]
    assert told[1].why == "no way"
