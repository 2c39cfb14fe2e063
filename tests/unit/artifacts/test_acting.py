"""Operations over actions: results, feedback, reasons, dropping, and the three ways to suspend."""

import math
from typing import Any, ClassVar

import pytest
from fake_actions import FakeServer
from robot_lab import Lab, Run, in_lab

from jacaros.artifacts.ros.acting import ACCEPTANCE, ENDING, error_code, missing_number
from jacaros.artifacts.ros.options import number, positive
from jacaros.artifacts.ros.ros_artifact import RosArtifact
from jacaros.env import Out, Structure, internal_operation, operation
from jacaros.ros.action import GoalStatus

ACTION = "nav2_msgs/action/NavigateToPose"


class Navigator(RosArtifact):
    """Drives by an action, in all ways that there are."""

    known_options: ClassVar = {"timeout": positive, "refuse_pause": number}

    def open(self) -> None:
        self.define_property("distance", -1)
        self.goer = self.action_client("go", ACTION)
        self.calls: list[str] = []

    @property
    def limit(self) -> Any:
        return self.options.get("timeout")

    @internal_operation
    def show_distance(self, feedback: Any) -> None:
        """Show how far it is."""
        self.update_property("distance", feedback.distance)

    @operation
    async def go(self, x: float, reached: Out) -> None:
        """Drive, whatever becomes of the intention."""
        result = await self.act(self.goer, {"x": x}, timeout=self.limit, on_feedback=self.show_distance)
        reached.set(result.x)

    @operation(name="goOrRest", pausable=True)
    async def go_or_rest(self, x: float) -> None:
        """Drive; cancelled while suspended."""
        await self.act(self.goer, {"x": x}, timeout=self.limit, suspend="cancel")

    @operation(name="goOrWait", pausable=True)
    async def go_or_wait(self, x: float) -> None:
        """Drive; paused while suspended."""
        await self.act(
            self.goer,
            {"x": x},
            timeout=self.limit,
            suspend="pause",
            pause=self._pause,
            resume=lambda: self.log("resume"),
        )

    async def _pause(self) -> None:
        self.log("pause")
        if "refuse_pause" in self.options:
            raise RuntimeError("no brakes")

    @operation
    async def careless(self) -> None:
        """Want to be cancelled without being told of pauses."""
        await self.act(self.goer, {}, suspend="cancel")

    @operation(pausable=True)
    async def helpless(self) -> None:
        """Want to pause without knowing how."""
        await self.act(self.goer, {}, suspend="pause")

    @operation
    async def send(self, goal: Any) -> None:
        """Send any goal."""
        await self.act(self.goer, goal)


def failed(run: Run, reason: str) -> str:
    """Assert the failure reason; gives the message."""
    assert run.outcome is not None
    assert run.reason == reason
    return str(run.outcome.message)


def test_the_result_comes_back_and_feedback_is_a_property() -> None:
    async def body(lab: Lab) -> None:
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
        await going.done
        assert out.value == 2.9
        assert going.outcome is not None
        assert going.outcome.ok
        assert watcher.holds("distance") == [(1,)]

    in_lab(body, None)


def test_a_server_that_refuses_is_rejected() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.refusal = "out of the map"
        artifact = await lab.make(Navigator)
        assert failed(await lab.call(artifact, "go", 3, Out()), "rejected") == "out of the map"

    in_lab(body, None)


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
def test_a_server_that_gives_up_says_why(result: dict[str, Any], text: str, reason: str) -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        server.goals[0].end(GoalStatus.ABORTED, text, **result)
        await going.done
        assert going.reason.replace(" ", "") == reason.replace(" ", "")

    in_lab(body, None)


def test_a_code_may_be_a_message_as_in_moveit() -> None:
    class Code:
        val = -2

    class Result:
        error_code = Code()

    assert error_code(Result()) == -2


def test_somebody_elses_cancel_is_canceled() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        server.goals[0].end(GoalStatus.CANCELED)
        await going.done
        assert "somebody else" in failed(going, "canceled")

    in_lab(body, None)


def test_time_that_is_up_cancels_the_goal_and_waits_for_nobody() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.ending = None
        artifact = await lab.make(Navigator, Structure("timeout", (3,)))
        going = await lab.call(artifact, "go", 3, Out())
        failed(going, "timeout(3)")
        assert lab.clock.elapsed == pytest.approx(3)
        await lab.sleep(0.1)
        assert server.events == [(0, "accepted 0"), (3, "cancel 0")]

    in_lab(body, None)


def test_a_server_that_is_not_there_and_one_that_leaves_are_lost() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.offered = False
        artifact = await lab.make(Navigator)
        failed(await lab.call(artifact, "go", 3, Out()), "server_lost")
        assert lab.clock.elapsed == pytest.approx(ACCEPTANCE, abs=0.11)
        hasty = await lab.make(Navigator, Structure("timeout", (1,)))
        began = lab.clock.elapsed
        failed(await lab.call(hasty, "go", 3, Out()), "server_lost")
        assert lab.clock.elapsed - began == pytest.approx(1, abs=0.11)
        server.offered = True
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        server.leave()
        await going.done
        failed(going, "server_lost")

    in_lab(body, None)


def test_a_server_that_does_not_say_whether_it_accepts_has_too_little_time_and_the_goal_is_cancelled() -> (
    None
):
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.accepting = ACCEPTANCE + 2
        artifact = await lab.make(Navigator)
        failed(await lab.call(artifact, "go", 3, Out()), f"timeout({ACCEPTANCE:g})")
        await lab.sleep(3)
        assert server.events[:2] == [(7, "accepted 0"), (7, "cancel 0")]

    in_lab(body, None)


def test_a_goal_that_does_not_fit_is_never_sent() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        failed(await lab.call(artifact, "send", {"typo": 1}), 'wrong_value("typo")')
        failed(
            await lab.call(artifact, "send", {"pose": {"at": [0.0, math.nan]}}), 'wrong_value("pose.at[1]")'
        )
        assert server.goals == []
        assert missing_number({"a": [1, 2.0, {"b": math.inf}]}) is None

    in_lab(body, None)


# Dropping.


def test_dropping_cancels_the_goal_and_waits_for_nobody() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.ending = None
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        going.execution.cancel()
        await lab.sleep(0.005)
        assert going.execution.ended
        assert server.events == [(0, "accepted 0"), (1, "cancel 0")]
        assert not going.done.done()

    in_lab(body, None)


def test_dropping_before_the_server_has_accepted_cancels_the_goal_as_soon_as_it_does() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.accepting = 2
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        going.execution.cancel()
        await lab.sleep(0.1)
        assert going.execution.ended
        await lab.sleep(2)
        assert server.events == [(2, "accepted 0"), (2, "cancel 0"), (2.11, "canceled 0")]

    in_lab(body, None)


@pytest.mark.parametrize("delay", [2.0, 1.9999999, 2.0000001])
def test_dropping_at_the_moment_of_acceptance_cancels_the_goal(delay: float) -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.accepting = 2
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        lab.clock.call_later(delay, going.execution.cancel)
        await lab.sleep(3)
        assert [text for _, text in server.events] == ["accepted 0", "cancel 0", "canceled 0"]

    in_lab(body, None)


def test_an_artifact_that_is_disposed_cancels_its_goals() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        lab.workspace.dispose_artifact(artifact)
        await going.done
        assert "cancel 0" in [text for _, text in server.events]
        assert server.goals[0].over

    in_lab(body, None)


def test_goals_under_way_are_cancelled_when_the_process_ends() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        backend: Any = lab.backend
        backend.exit_hooks.run()
        assert server.goals[0].over

    in_lab(body, None)


def test_a_disposed_artifact_leaves_no_exit_hook_behind() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        lab.workspace.dispose_artifact(artifact)
        await lab.sleep(0.1)
        backend: Any = lab.backend
        backend.exit_hooks.run()
        assert [text for _, text in server.events] == ["closed"]

    in_lab(body, None)


def test_two_goals_are_pursued_side_by_side_and_one_of_them_dropped() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        outs = Out(), Out()
        first, second = (lab.begin(artifact, "go", x, out) for x, out in zip((1, 2), outs, strict=True))
        await lab.sleep(1)
        first.execution.cancel()
        await lab.sleep(1)
        assert [goal.over for goal in server.goals] == [True, False]
        server.goals[1].end(x=2)
        await second.done
        assert not first.done.done()
        assert outs[1].value == 2

    in_lab(body, None)


# Suspending.


def test_going_on_while_suspended() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator, Structure("timeout", (10,)))
        going = lab.begin(artifact, "go", 3, Out())
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(1)
        server.goals[0].end(x=3)
        await going.done
        assert server.events == [(0, "accepted 0"), (2, "succeeded 0")]

    in_lab(body, None)


def test_cancelled_while_suspended_and_sent_again() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator, Structure("timeout", (5,)))
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(60)
        assert server.events == [(0, "accepted 0"), (1, "cancel 0"), (1.11, "canceled 0")]
        going.execution.resume()
        await lab.sleep(3)
        server.goals[1].end()
        await going.done
        assert going.outcome is not None
        assert going.outcome.ok

    in_lab(body, None)


def test_time_in_which_the_goal_rests_does_not_count_but_the_rest_does() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator, Structure("timeout", (5,)))
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(3)
        going.execution.pause()
        await lab.sleep(60)
        going.execution.resume()
        await going.done
        failed(going, "timeout(5)")
        assert lab.clock.elapsed == pytest.approx(65, abs=0.05)
        assert len(server.goals) == 2

    in_lab(body, None)


def test_resumed_before_the_cancelled_goal_has_ended_it_is_sent_again_after_that() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.ending = 2
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(0.5)
        going.execution.resume()
        await lab.sleep(2)
        expected = [(0, "accepted 0"), (1, "cancel 0"), (3.01, "canceled 0"), (3.01, "accepted 1")]
        assert server.events == expected
        server.goals[1].end()
        await going.done

    in_lab(body, None)


def test_a_goal_that_succeeds_while_it_is_being_cancelled_has_succeeded() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.ending = None
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(0.1)
        server.goals[0].end()
        await going.done
        assert going.outcome is not None
        assert going.outcome.ok

    in_lab(body, None)


def test_a_server_that_does_not_cancel_goes_on_and_its_end_counts() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.agrees = False
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(10)
        going.execution.resume()
        await lab.sleep(1)
        assert [text for _, text in server.events] == ["accepted 0", "cancel 0"]
        server.goals[0].end()
        await going.done

    in_lab(body, None)


def test_a_server_that_agrees_to_cancel_and_does_not_is_lost() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.ending = None
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await going.done
        failed(going, "server_lost")
        assert lab.clock.elapsed == pytest.approx(1 + ENDING, abs=0.02)

    in_lab(body, None)


def test_suspended_before_the_server_has_accepted() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        server.accepting = 2
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(5)
        assert [text for _, text in server.events] == ["accepted 0", "cancel 0", "canceled 0"]
        going.execution.resume()
        await lab.sleep(3)
        server.goals[1].end()
        await going.done

    in_lab(body, None)


def test_suspended_before_it_begins_nothing_is_sent() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrRest", 3)
        going.execution.pause()
        await lab.sleep(3)
        sent = [text for _, text in server.events]
        assert sent in ([], ["accepted 0", "cancel 0", "canceled 0"])
        going.execution.resume()
        await lab.sleep(1)
        server.goals[-1].end()
        await going.done

    in_lab(body, None)


def test_dropped_while_suspended() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        for operation_name in ("goOrRest", "goOrWait"):
            going = lab.begin(artifact, operation_name, 3)
            await lab.sleep(1)
            going.execution.pause()
            await lab.sleep(1)
            going.execution.cancel()
            await lab.sleep(1)
            assert going.execution.ended
            assert server.goals[-1].over
        assert len(server.goals) == 2

    in_lab(body, None)


def test_paused_and_resumed_at_the_server() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator, Structure("timeout", (5,)))
        going = lab.begin(artifact, "goOrWait", 3)
        for _ in range(2):
            await lab.sleep(1)
            going.execution.pause()
            await lab.sleep(10)
            going.execution.resume()
        await lab.sleep(1)
        server.goals[0].end()
        await going.done
        assert going.outcome is not None
        assert going.outcome.ok
        assert [line.partition("] ")[2] for line in lab.logged] == ["pause", "resume"] * 2
        assert len(server.goals) == 1

    in_lab(body, None)


def test_a_goal_that_ends_while_it_is_paused_has_ended() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        going = lab.begin(artifact, "goOrWait", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(1)
        server.goals[0].end(GoalStatus.ABORTED, "lost the way", error_code=7)
        await going.done
        failed(going, 'aborted(7,"lost the way")')

    in_lab(body, None)


def test_a_goal_that_cannot_be_paused_is_cancelled_and_sent_again() -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator, Structure("refuse_pause", (1,)))
        going = lab.begin(artifact, "goOrWait", 3)
        await lab.sleep(1)
        going.execution.pause()
        await lab.sleep(2)
        assert [text for _, text in server.events] == ["accepted 0", "cancel 0", "canceled 0"]
        assert any("could not be paused: RuntimeError: no brakes" in line for line in lab.logged)
        going.execution.resume()
        await lab.sleep(1)
        server.goals[1].end()
        await going.done

    in_lab(body, None)


@pytest.mark.parametrize(
    ("name", "told"), [("careless", "pausable=True"), ("helpless", "pause=... and resume=...")]
)
def test_what_cannot_work_is_said_before_anything_is_sent(name: str, told: str) -> None:
    async def body(lab: Lab) -> None:
        server = FakeServer(lab)
        artifact = await lab.make(Navigator)
        ended = await lab.call(artifact, name)
        assert ended.outcome is not None
        assert not ended.outcome.ok
        assert any(told in line for line in lab.logged), lab.logged
        assert server.goals == []

    in_lab(body, None)
