"""Operations over actions: results, feedback, reasons, and dropping."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from fake_actions import FakeServer
from navigator import Navigator, begun, failed, succeeded
from robot_lab import Lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.kit.acting import ACCEPTANCE, error_code, missing_number
from jacaros.robots.kit.connection import GUARD_TIMEOUT
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.guarded import guarded_by


async def test_the_result_comes_back_and_feedback_is_a_property(lab: Lab) -> None:
    server = FakeServer(lab)
    artifact = await lab.make(Navigator, "robot_0")
    assert server.clients[0].name == "/robot_0/go"
    watcher = lab.watch(artifact)
    out = Out()
    going = lab.begin(artifact, "go", 3, out)
    await lab.sleep(1)
    [goal] = server.goals
    assert goal.fields == {"x": 3}
    for distance in (2, 1):
        goal.feedback(distance=distance)
    assert watcher.values("distance") == [(-1,), (2,), (1,)]
    goal.end(x=2.9)
    goal.feedback(distance=0)
    await succeeded(going)
    assert out.value == 2.9
    assert watcher.holds("distance") == [(1,)]


async def test_a_server_that_refuses_is_rejected(lab: Lab) -> None:
    _, going = await begun(lab, "go", after=0, refusal="out of the map")
    assert await failed(going, "rejected") == "out of the map"


@pytest.mark.parametrize(
    ("result", "text", "reason"),
    [
        ({"error_code": 203, "error_msg": "no path"}, "", 'aborted(203,"no path")'),
        (
            {"error_code": 203, "error_msg": "no path"},
            "text of the server",
            'aborted(203,"text of the server")',
        ),
        ({}, "", 'aborted(0,"")'),
        ({"error_code": -4, "error_string": "joint limits"}, "", 'aborted(-4,"joint limits")'),
    ],
)
async def test_a_server_that_aborts_gives_the_reason(
    lab: Lab, result: dict[str, Any], text: str, reason: str
) -> None:
    server, going = await begun(lab, "go")
    server.goals[0].end(GoalStatus.ABORTED, text, **result)
    await going.done
    assert going.reason.replace(" ", "") == reason.replace(" ", "")


def test_a_code_may_be_a_message_as_in_moveit() -> None:
    assert error_code(SimpleNamespace(error_code=SimpleNamespace(val=-2))) == -2


async def test_a_goal_cancelled_by_another_client_is_canceled(lab: Lab) -> None:
    server, going = await begun(lab, "go")
    server.goals[0].end(GoalStatus.CANCELED)
    assert "another client cancelled" in await failed(going, "canceled")


async def test_a_timeout_cancels_the_goal_without_waiting(lab: Lab) -> None:
    server, going = await begun(lab, "go", Structure("timeout", (3,)), after=0, ending=None)
    await failed(going, "timeout(3)")
    assert lab.clock.elapsed == pytest.approx(3)
    await lab.sleep(0.1)
    assert server.events == [(0, "accepted 0"), (3, "cancel 0")]


async def test_a_server_that_is_not_there_is_unavailable_and_one_that_leaves_is_lost(lab: Lab) -> None:
    server = FakeServer(lab)
    server.offered = False
    artifact = await lab.make(Navigator)
    await failed(lab.begin(artifact, "go", 3, Out()), "server_unavailable")
    assert lab.clock.elapsed == pytest.approx(ACCEPTANCE, abs=0.11)
    hasty = await lab.make(Navigator, Structure("timeout", (1,)))
    began = lab.clock.elapsed
    await failed(lab.begin(hasty, "go", 3, Out()), "server_unavailable")
    assert lab.clock.elapsed - began == pytest.approx(1, abs=0.11)
    server.offered = True
    going = lab.begin(artifact, "go", 3, Out())
    await lab.sleep(1)
    server.leave()
    await failed(going, "server_lost")


async def test_a_goal_is_sent_when_the_guard_can_cancel_it(lab: Lab) -> None:
    server = FakeServer(lab)
    found = guarded_by(lab.backend).found
    found["guard"] = {}
    lab.begin(await lab.make(Navigator), "go", 3, Out())
    await lab.sleep(4)
    assert server.goals == []
    found["guard"] = {"/go": 1}
    await lab.sleep(0.1)
    assert len(server.goals) == 1


async def test_a_guard_that_never_finds_the_server_delays_a_goal_and_is_reported(lab: Lab) -> None:
    server = FakeServer(lab)
    guarded_by(lab.backend).found["guard"] = {}
    lab.begin(await lab.make(Navigator), "go", 3, Out())
    await lab.sleep(GUARD_TIMEOUT + 0.1)
    assert len(server.goals) == 1
    [warning] = lab.logged
    assert "the guard has not found the server of action /go after 10 s; sending the goal anyway" in warning


async def test_a_missing_server_is_unavailable_as_soon_with_a_guard(lab: Lab) -> None:
    server = FakeServer(lab)
    server.offered = False
    guarded_by(lab.backend).found["guard"] = {}
    await failed(lab.begin(await lab.make(Navigator), "go", 3, Out()), "server_unavailable")
    assert lab.clock.elapsed == pytest.approx(ACCEPTANCE, abs=0.11)


async def test_a_server_that_neither_accepts_nor_rejects_in_time_has_its_goal_cancelled(lab: Lab) -> None:
    server, going = await begun(lab, "go", after=0, accepting=ACCEPTANCE + 2)
    await failed(going, f"timeout({ACCEPTANCE:g})")
    await lab.sleep(3)
    assert server.events[:2] == [(7, "accepted 0"), (7, "cancel 0")]


async def test_a_goal_that_does_not_fit_is_never_sent(lab: Lab) -> None:
    server = FakeServer(lab)
    artifact = await lab.make(Navigator)
    await failed(lab.begin(artifact, "send", {"typo": 1}), 'wrong_value("typo")')
    await failed(lab.begin(artifact, "send", {"pose": {"at": [0.0, math.nan]}}), 'wrong_value("pose.at[1]")')
    assert server.goals == []
    assert missing_number({"a": [1, 2.0, {"b": math.inf}]}) is None


# Dropping.


async def test_dropping_cancels_the_goal_without_waiting(lab: Lab) -> None:
    server, going = await begun(lab, "go", ending=None)
    await going.drop(0.005)
    assert going.execution.ended
    assert server.events == [(0, "accepted 0"), (1, "cancel 0")]
    assert not going.done.done()


async def test_dropping_before_the_server_has_accepted_cancels_the_goal_as_soon_as_it_does(lab: Lab) -> None:
    server, going = await begun(lab, "go", accepting=2)
    await going.drop(0.1)
    assert going.execution.ended
    await lab.sleep(2)
    assert server.events == [(2, "accepted 0"), (2, "cancel 0"), (2.11, "canceled 0")]


@pytest.mark.parametrize("delay", [2.0, 1.9999999, 2.0000001])
async def test_dropping_at_the_moment_of_acceptance_cancels_the_goal(lab: Lab, delay: float) -> None:
    server, going = await begun(lab, "go", after=0, accepting=2)
    lab.clock.call_later(delay, going.execution.cancel)
    await lab.sleep(3)
    assert server.told == ["accepted 0", "cancel 0", "canceled 0"]


async def test_an_artifact_that_is_disposed_cancels_its_goals(lab: Lab) -> None:
    server, going = await begun(lab, "go")
    lab.workspace.dispose_artifact(going.execution.request.artifact)
    await going.done
    assert "cancel 0" in server.told
    assert server.goals[0].over


async def test_two_goals_are_pursued_side_by_side_and_one_of_them_dropped(lab: Lab) -> None:
    server = FakeServer(lab)
    artifact = await lab.make(Navigator)
    outs = Out(), Out()
    first, second = (lab.begin(artifact, "go", x, out) for x, out in zip((1, 2), outs, strict=True))
    await lab.sleep(1)
    await first.drop(1)
    assert [goal.over for goal in server.goals] == [True, False]
    server.goals[1].end(x=2)
    await second.done
    assert not first.done.done()
    assert outs[1].value == 2


async def test_feedback_during_the_end_of_a_dropped_goal_is_ignored(lab: Lab) -> None:
    server, going = await begun(lab, "go", ending=1)
    watcher = lab.watch(going.execution.request.artifact)
    server.goals[0].feedback(distance=2)
    await going.drop(0.5)
    server.goals[0].feedback(distance=1)
    await lab.sleep(1)
    assert watcher.values("distance") == [(-1,), (2,)]
    assert server.goals[0].over


async def test_the_end_of_a_dropped_goal_is_not_reported(lab: Lab) -> None:
    for end in (lambda server: None, FakeServer.leave):
        server, going = await begun(lab, "go", ending=3.0)
        await going.drop(1)
        end(server)
        await lab.sleep(10)
    assert lab.logged == []


async def test_a_server_without_time_to_accept_is_reported_with_the_total_time(lab: Lab) -> None:
    server, going = await begun(lab, "goOrRest", Structure("timeout", (4,)))
    await going.pause(1)
    server.accepting = 10
    going.execution.resume()
    await failed(going, "timeout(4)")
    assert lab.clock.elapsed == pytest.approx(5, abs=0.02)
