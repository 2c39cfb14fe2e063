"""Agents and an action server on the graph inside the process: an action is one step of a plan."""

import asyncio
import shutil
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.action import Abort, ActionPolicy, GoalOutcome, GoalStatus
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project

ARTIFACTS = Path(__file__).parent / "ros" / "programs" / "counting" / "artifacts.py"

BEGIN = """
!begin.
+!begin <- makeArtifact("robot", "CountingRobot", [], R); focus(R); !go; .stopMAS.
-!go[error(E), env_failure_reason(R)] <- .print(E, " ", R).
"""


class Server:
    """Counts; what it does besides depends on the target.

    13: gives up at 3.  9: its process is gone at 3.  Above 100: refuses.

    Args:
        policy: in place of its own.
        stopping: seconds from being cancelled to the end of a goal.

    Attributes:
        deeds: what it did, with the seconds since the beginning.
    """

    def __init__(self, policy: ActionPolicy | None = None, stopping: float = 0.0) -> None:
        self.deeds: list[str] = []
        self.policy = policy or ActionPolicy(lambda goal: "too many" if goal.target > 100 else None)
        self.stopping = stopping

    def offer(self, mas: System) -> None:
        self.clock, self._began = mas.clock, mas.clock.now()
        self.backend = mas.ros.backend()
        self.come()

    def come(self) -> None:
        action = "jacaros_interfaces/action/Count"
        self.server: Any = self.backend.action_server("/count", action, self._count, self.policy)

    def note(self, text: str) -> None:
        self.deeds.append(f"{text} at {round(self.clock.now() - self._began, 1):g}")

    async def _count(self, goal: Any) -> Any:
        target = goal.request.target
        self.note(f"begin {target}")
        number = 0
        try:
            while number < target:
                await self.clock.sleep(goal.request.period)
                number += 1
                goal.feedback(current=number)
                if target == 13 and number == 3:
                    raise Abort("unlucky")
                if target == 9 and number == 3:
                    self.server.vanish()
        except asyncio.CancelledError:
            if self.stopping:
                await self.clock.sleep(self.stopping)
            self.note(f"cancelled {target}")
            raise
        self.note(f"done {target}")
        return {"last": number}


def run(folder: Path, program: str, server: Server | None = None, **options: Any) -> RunResult:
    shutil.copy(ARTIFACTS, folder)
    file = folder / "counter.asl"
    file.write_text(BEGIN + program, encoding="utf-8")
    made = server or Server()
    return run_project(file, seconds=300, when_started=made.offer, **options)


def test_an_action_is_one_step_whose_result_and_feedback_reach_the_plan(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        """
        +!go <- count(3, 0.5, Last); .print("last ", Last).
        +current(N) : N > 0 <- .print(N).
        """,
    )
    assert result.of("counter") == ["1", "2", "3", "last 3"]
    assert result.errors == []


@pytest.mark.parametrize(
    ("step", "reason"),
    [
        ("count(101, 1, L)", "rejected"),
        ("count(13, 1, L)", 'aborted(0,"unlucky")'),
        ("countWithin(4, 50, 1)", "timeout(4)"),
        ("count(9, 1, L)", "server_lost"),
    ],
)
def test_each_way_to_fail_reaches_the_plan_with_its_reason(tmp_path: Path, step: str, reason: str) -> None:
    result = run(tmp_path, f"+!go <- {step}; .print(never).")
    assert result.of("counter") == [f"action_failed {reason}"]
    assert result.exit_code == 0


class CancelledElsewhere:
    """A goal that another client cancels."""

    goal_id = "1"

    async def outcome(self, timeout: float | None = None) -> GoalOutcome:
        return GoalOutcome(GoalStatus.CANCELED, None)


def test_a_goal_cancelled_by_another_client_fails_as_canceled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def send(*arguments: object) -> CancelledElsewhere:
        return CancelledElsewhere()

    monkeypatch.setattr("jacaros.robots.ros.action_client.ActionClient.send", send)
    result = run(tmp_path, "+!go <- count(5, 1, L); .print(never).")
    assert result.of("counter") == ["action_failed canceled"]


def test_an_action_that_no_server_offers_is_unavailable_and_not_lost(tmp_path: Path) -> None:
    server = Server()
    server.come = lambda: None  # type: ignore[method-assign]
    result = run(tmp_path, "+!go <- count(5, 1, L); .print(never).", server)
    assert result.of("counter") == ["action_failed server_unavailable"]
    assert 5 <= result.seconds < 6


def test_a_dropped_intention_cancels_its_goal(tmp_path: Path) -> None:
    server = Server()
    result = run(
        tmp_path,
        """
        +!go <- !!count; .wait(3500); .drop_intention(count); .print(dropped); .wait(2000).
        +!count <- count(50, 1, L); .print(never).
        """,
        server,
    )
    assert result.of("counter") == ["dropped"]
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 3.5"]


def test_a_goal_continues_while_its_intention_is_suspended_and_its_result_is_held_back(
    tmp_path: Path,
) -> None:
    server = Server()
    result = run(
        tmp_path,
        """
        +!go <- !!count; .wait(1500); .suspend(count); .wait(10000); .print(resuming);
                .resume(count); .wait({+counted}).
        +!count <- count(5, 1, L); .print(L); +counted.
        """,
        server,
    )
    assert result.of("counter") == ["resuming", "5"]
    assert server.deeds == ["begin 5 at 0", "done 5 at 5"]


def test_a_goal_that_is_cancelled_while_suspended_is_sent_again(tmp_path: Path) -> None:
    server = Server()
    result = run(
        tmp_path,
        """
        +!go <- !!count; .wait(2500); .suspend(count); .wait(10000); .resume(count); .wait({+counted}).
        +!count <- countOrRest(5, 1); .print(counted); +counted.
        """,
        server,
    )
    assert result.of("counter") == ["counted"]
    assert server.deeds == [
        "begin 5 at 0",
        "cancelled 5 at 2.5",
        "begin 5 at 12.5",
        "done 5 at 17.5",
    ]


def test_a_suspended_goal_is_sent_again_though_another_goal_came_in_between(tmp_path: Path) -> None:
    server = Server(ActionPolicy(preempt=True))
    result = run(
        tmp_path,
        """
        +!go <- !!job; .wait(2500); .suspend(job); count(1, 0.1, _); .resume(job); .wait({+counted}).
        +!job <- countOrRest(5, 1); .print(counted); +counted.
        """,
        server,
    )
    assert result.of("counter") == ["counted"]
    assert server.deeds == [
        "begin 5 at 0",
        "cancelled 5 at 2.5",
        "begin 1 at 2.5",
        "done 1 at 2.6",
        "begin 5 at 2.6",
        "done 5 at 7.6",
    ]


DROP_AND_COUNT = """
    +!go <- !!job; .wait(2500); .drop_intention(job); count(1, 0.1, _); .print(counted); .wait(10000).
    +!job <- count(50, 1, _).
    """


def test_the_next_goal_waits_until_a_dropped_one_has_ended(tmp_path: Path) -> None:
    server = Server(stopping=2.0)
    result = run(tmp_path, DROP_AND_COUNT, server)
    assert result.of("counter") == ["counted"]
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 4.5", "begin 1 at 4.5", "done 1 at 4.6"]
    assert result.errors == []


def test_a_goal_that_does_not_end_keeps_the_next_one_waiting_for_five_seconds_and_people_are_warned(
    tmp_path: Path,
) -> None:
    server = Server(stopping=60.0)
    result = run(tmp_path, DROP_AND_COUNT, server)
    assert result.of("counter") == ["counted"]
    assert server.deeds == ["begin 50 at 0", "begin 1 at 7.5", "done 1 at 7.6"]
    told = "\n".join(result.errors)
    assert (
        "warning: action /count: a cancelled goal has not ended within 5 s; sending the next goal anyway"
        in told
    )
    assert (
        "warning: action /count: an abandoned goal has not ended 5 s after it was cancelled; the robot may still be moving"
        in told
    )


def test_a_goal_that_its_server_does_not_cancel_keeps_no_other_waiting(tmp_path: Path) -> None:
    server = Server(ActionPolicy(may_cancel=lambda goal: False))
    result = run(tmp_path, DROP_AND_COUNT, server)
    assert result.of("counter") == ["counted"]
    assert server.deeds[:3] == ["begin 50 at 0", "begin 1 at 2.5", "done 1 at 2.6"]
    assert "the robot may still be moving" in "\n".join(result.errors)


def test_two_intentions_have_a_goal_each(tmp_path: Path) -> None:
    server = Server()
    result = run(
        tmp_path,
        """
        +!go <- !!count(4); !!count(6); .wait({+counted(6)}).
        +!count(N) <- count(N, 1, L); .print(L); +counted(N).
        """,
        server,
    )
    assert result.of("counter") == ["4", "6"]
    assert server.deeds == ["begin 4 at 0", "begin 6 at 0", "done 4 at 4", "done 6 at 6"]


def test_the_limit_of_an_action_cancels_its_goal(tmp_path: Path) -> None:
    server = Server()
    result = run(
        tmp_path,
        """
        +!go <- count(50, 1, L)[timeout(2000)].
        """,
        server,
    )
    assert result.of("counter") == ['action_failed operation_timeout("count/3",2000)']
    assert server.deeds[:2] == ["begin 50 at 0", "cancelled 50 at 2"]


@pytest.mark.parametrize(
    "ending",
    [
        ".stopMAS",
        "lookupArtifact(robot, R); disposeArtifact(R); .wait(1000)",
        ".kill_agent(counter); .wait(1000)",
    ],
)
def test_the_end_of_run_artifact_or_agent_cancels_the_goal(tmp_path: Path, ending: str) -> None:
    server = Server()
    run(tmp_path, f"+!go <- !!count; .wait(1500); {ending}. +!count <- count(50, 1, L).", server)
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 1.5"]


def test_a_server_that_comes_late_and_one_that_comes_back_need_no_restart(tmp_path: Path) -> None:
    server = Server()
    server.come, come = (lambda: None), server.come  # type: ignore[method-assign]

    def offer(mas: System) -> None:
        Server.offer(server, mas)
        mas.clock.call_later(2, come)
        mas.clock.call_later(20, come)

    server.offer = offer  # type: ignore[method-assign]
    result = run(
        tmp_path,
        """
        +!go <- !try(3); !try(9); .wait(20000); !try(2).
        +!try(N) <- count(N, 1, L); .print(L).
        -!try(N)[env_failure_reason(R)] <- .print(R).
        """,
        server,
    )
    assert result.of("counter") == ["3", "server_lost", "2"]
