"""Operations over actions while their intention is suspended: they go on, or are cancelled."""

import pytest
from fake_actions import FakeServer
from navigator import Navigator, begun, failed, succeeded, suspended
from robot_lab import Lab, Run

from jacaros.artifacts import Structure
from jacaros.robots.kit.acting import ENDING
from jacaros.robots.ros.action import GoalStatus


async def test_going_on_while_suspended(lab: Lab) -> None:
    server, going = await suspended(lab, "go", Structure("timeout", (10,)))
    await lab.sleep(1)
    server.goals[0].end(x=3)
    await going.done
    assert server.events == [(0, "accepted 0"), (2, "succeeded 0")]


async def end_second(lab: Lab, server: FakeServer, going: Run, after: float = 3) -> None:
    """Resume; the goal that is sent then succeeds."""
    going.execution.resume()
    await lab.sleep(after)
    server.goals[1].end()
    await succeeded(going)


async def test_cancelled_while_suspended_and_sent_again(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", Structure("timeout", (5,)))
    await lab.sleep(60)
    assert server.events == [(0, "accepted 0"), (1, "cancel 0"), (1.11, "canceled 0")]
    await end_second(lab, server, going)


async def test_a_cancelled_goal_that_the_server_ends_as_aborted_is_sent_again_too(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", cancelled_as=GoalStatus.ABORTED)
    await lab.sleep(2)
    assert server.told == ["accepted 0", "cancel 0", "aborted 0"]
    await end_second(lab, server, going)


async def test_a_goal_aborted_before_the_server_receives_the_cancel_is_sent_again(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", agrees=False)
    server.goals[0].end(GoalStatus.ABORTED)
    await lab.sleep(2)
    await end_second(lab, server, going)


async def test_a_goal_that_the_server_does_not_cancel_and_aborts_later_has_failed(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", agrees=False)
    await lab.sleep(5)
    server.goals[0].end(GoalStatus.ABORTED, "lost the way", error_code=7)
    await failed(going, 'aborted(7,"lost the way")')


async def test_time_in_which_the_goal_rests_does_not_count_but_the_rest_does(lab: Lab) -> None:
    server, going = await begun(lab, "goOrRest", Structure("timeout", (5,)), after=0)
    await lab.sleep(3)
    await going.pause(60)
    going.execution.resume()
    await failed(going, "timeout(5)")
    assert lab.clock.elapsed == pytest.approx(65, abs=0.05)
    assert len(server.goals) == 2


async def test_resumed_before_the_cancelled_goal_has_ended_it_is_sent_again_after_that(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", ending=2)
    await lab.sleep(0.5)
    going.execution.resume()
    await lab.sleep(2)
    expected = [(0, "accepted 0"), (1, "cancel 0"), (3.01, "canceled 0"), (3.01, "accepted 1")]
    assert server.events == expected
    server.goals[1].end()
    await going.done


async def test_a_goal_that_succeeds_while_it_is_being_cancelled_has_succeeded(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", ending=None)
    await lab.sleep(0.1)
    server.goals[0].end()
    await succeeded(going)


async def test_a_server_that_agrees_to_cancel_and_does_not_is_lost(lab: Lab) -> None:
    _, going = await suspended(lab, "goOrRest", ending=None)
    await failed(going, "server_lost")
    assert lab.clock.elapsed == pytest.approx(1 + ENDING, abs=0.02)


async def test_suspended_before_the_server_has_accepted(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", accepting=2)
    await lab.sleep(5)
    assert server.told == ["accepted 0", "cancel 0", "canceled 0"]
    await end_second(lab, server, going)


async def test_suspended_before_it_begins_nothing_is_sent(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest", after=0)
    await lab.sleep(3)
    sent = server.told
    assert sent in ([], ["accepted 0", "cancel 0", "canceled 0"])
    going.execution.resume()
    await lab.sleep(1)
    server.goals[-1].end()
    await going.done


async def test_dropped_while_suspended(lab: Lab) -> None:
    server, going = await suspended(lab, "goOrRest")
    await lab.sleep(1)
    await going.drop(1)
    assert going.execution.ended
    assert [goal.over for goal in server.goals] == [True]


async def test_what_cannot_work_is_said_before_anything_is_sent(lab: Lab) -> None:
    server = FakeServer(lab)
    ended = await lab.call(await lab.make(Navigator), "careless")
    assert not ended.ok
    assert any("pausable=True" in line for line in lab.logged), lab.logged
    assert server.goals == []


async def test_feedback_during_the_end_of_a_suspended_goal_is_ignored(lab: Lab) -> None:
    server, going = await begun(lab, "goOrRest", ending=1.0)
    artifact = going.execution.request.artifact
    watcher = lab.watch(artifact)
    server.goals[0].feedback(distance=9)
    await going.pause(0.5)
    server.goals[0].feedback(distance=8)
    await lab.sleep(1)
    going.execution.resume()
    await lab.sleep(1)
    server.goals[1].feedback(distance=7)
    server.goals[1].end()
    await succeeded(going)
    assert watcher.values("distance") == [(-1,), (9,), (7,)]
    assert [line.partition("] ")[2] for line in lab.logged] == ["sent", "over", "sent", "over"]


async def test_a_goal_that_the_server_does_not_cancel_continues_and_is_logged_and_its_outcome_counts(
    lab: Lab,
) -> None:
    server, going = await begun(lab, "goOrRest", agrees=False)
    watcher = lab.watch(going.execution.request.artifact)
    await going.pause(3)
    server.goals[0].feedback(distance=8)
    going.execution.resume()
    await lab.sleep(1)
    assert server.told == ["accepted 0", "cancel 0"]
    server.goals[0].end()
    await succeeded(going)
    assert watcher.values("distance") == [(-1,), (8,)]
    assert "[a5] the goal of action /go continues although its intention is suspended" in lab.logged


async def test_an_operation_with_many_goals_is_notified_of_pauses_once(lab: Lab) -> None:
    server = FakeServer(lab)
    artifact = await lab.make(Navigator)
    going = lab.begin(artifact, "goOften", 20)
    for number in range(20):
        await lab.sleep(1)
        server.goals[number].end()
    await succeeded(going)
    pauses = going.execution.pauses
    assert pauses is not None
    assert pauses.callbacks == []
