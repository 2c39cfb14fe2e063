"""Agents and an action server on the graph inside the process: an action is one step of a plan."""

import asyncio
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.action import ActionPolicy
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

    9: its process is gone at 3.

    Attributes:
        deeds: what it did, with the seconds since the beginning.
        policy: which goals it accepts.
        stopping: seconds from being cancelled to the end of a goal.
    """

    def __init__(self) -> None:
        self.deeds: list[str] = []
        self.policy = ActionPolicy()
        self.stopping = 0.0

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
                if target == 9 and number == 3:
                    self.server.vanish()
        except asyncio.CancelledError:
            if self.stopping:
                await self.clock.sleep(self.stopping)
            self.note(f"cancelled {target}")
            raise
        self.note(f"done {target}")
        return {"last": number}


@pytest.fixture
def server() -> Server:
    return Server()


@pytest.fixture
def run(tmp_path: Path, server: Server) -> Callable[[str], RunResult]:
    """Runs a program whose goal is ``!go`` when it has the robot's artifact, with the server."""
    shutil.copy(ARTIFACTS, tmp_path)
    file = tmp_path / "counter.asl"

    def run(program: str) -> RunResult:
        file.write_text(BEGIN + program, encoding="utf-8")
        return run_project(file, seconds=300, when_started=server.offer)

    return run


def test_an_action_is_one_step_whose_result_and_feedback_reach_the_plan(run) -> None:
    result = run("""
        +!go <- count(3, 0.5, Last); .print("last ", Last).
        +current(N) : N > 0 <- .print(N).
        """)
    assert result.of("counter") == ["1", "2", "3", "last 3"]
    assert result.errors == []


def test_an_action_that_no_server_offers_is_unavailable_and_not_lost(run, server: Server) -> None:
    server.come = lambda: None  # type: ignore[method-assign]
    result = run("+!go <- count(5, 1, L); .print(never).")
    assert result.of("counter") == ["action_failed server_unavailable"]
    assert 5 <= result.seconds < 6


def test_a_dropped_intention_cancels_its_goal(run, server: Server) -> None:
    result = run("""
        +!go <- !!count; .wait(3500); .drop_intention(count); .print(dropped); .wait(2000).
        +!count <- count(50, 1, L); .print(never).
        """)
    assert result.of("counter") == ["dropped"]
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 3.5"]


def test_a_goal_continues_while_its_intention_is_suspended_and_its_result_is_held_back(run, server) -> None:
    result = run("""
        +!go <- !!count; .wait(1500); .suspend(count); .wait(10000); .print(resuming);
                .resume(count); .wait({+counted}).
        +!count <- count(5, 1, L); .print(L); +counted.
        """)
    assert result.of("counter") == ["resuming", "5"]
    assert server.deeds == ["begin 5 at 0", "done 5 at 5"]


def test_a_goal_that_is_cancelled_while_suspended_is_sent_again(run, server: Server) -> None:
    result = run("""
        +!go <- !!count; .wait(2500); .suspend(count); .wait(10000); .resume(count); .wait({+counted}).
        +!count <- countOrRest(5, 1); .print(counted); +counted.
        """)
    assert result.of("counter") == ["counted"]
    assert server.deeds == ["begin 5 at 0", "cancelled 5 at 2.5", "begin 5 at 12.5", "done 5 at 17.5"]


def test_a_suspended_goal_is_sent_again_though_another_goal_came_in_between(run, server: Server) -> None:
    server.policy = ActionPolicy(preempt=True)
    result = run("""
        +!go <- !!job; .wait(2500); .suspend(job); count(1, 0.1, _); .resume(job); .wait({+counted}).
        +!job <- countOrRest(5, 1); .print(counted); +counted.
        """)
    assert result.of("counter") == ["counted"]
    assert server.deeds == [
        *("begin 5 at 0", "cancelled 5 at 2.5", "begin 1 at 2.5", "done 1 at 2.6", "begin 5 at 2.6"),
        "done 5 at 7.6",
    ]


DROP_AND_COUNT = """
    +!go <- !!job; .wait(2500); .drop_intention(job); count(1, 0.1, _); .print(counted); .wait(10000).
    +!job <- count(50, 1, _).
    """


def test_the_next_goal_waits_until_a_dropped_one_has_ended(run, server: Server) -> None:
    server.stopping = 2.0
    result = run(DROP_AND_COUNT)
    assert result.of("counter") == ["counted"]
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 4.5", "begin 1 at 4.5", "done 1 at 4.6"]
    assert result.errors == []


def test_a_goal_that_does_not_end_keeps_the_next_one_waiting_for_five_seconds_and_people_are_warned(
    run, server: Server
) -> None:
    server.stopping = 60.0
    result = run(DROP_AND_COUNT)
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


def test_a_goal_that_its_server_does_not_cancel_keeps_no_other_waiting(run, server: Server) -> None:
    server.policy = ActionPolicy(may_cancel=lambda goal: False)
    result = run(DROP_AND_COUNT)
    assert result.of("counter") == ["counted"]
    assert server.deeds[:3] == ["begin 50 at 0", "begin 1 at 2.5", "done 1 at 2.6"]
    assert "the robot may still be moving" in "\n".join(result.errors)


def test_two_intentions_have_a_goal_each(run, server: Server) -> None:
    result = run("""
        +!go <- !!count(4); !!count(6); .wait({+counted(6)}).
        +!count(N) <- count(N, 1, L); .print(L); +counted(N).
        """)
    assert result.of("counter") == ["4", "6"]
    assert server.deeds == ["begin 4 at 0", "begin 6 at 0", "done 4 at 4", "done 6 at 6"]


def test_the_limit_of_an_action_cancels_its_goal(run, server: Server) -> None:
    result = run("+!go <- count(50, 1, L)[timeout(2000)].")
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
def test_the_end_of_run_artifact_or_agent_cancels_the_goal(run, ending: str, server: Server) -> None:
    run(f"+!go <- !!count; .wait(1500); {ending}. +!count <- count(50, 1, L).")
    assert server.deeds == ["begin 50 at 0", "cancelled 50 at 1.5"]


def test_a_server_that_comes_late_and_one_that_comes_back_need_no_restart(run, server: Server) -> None:
    server.come, come = (lambda: None), server.come  # type: ignore[method-assign]

    def offer(mas: System) -> None:
        Server.offer(server, mas)
        mas.clock.call_later(2, come)
        mas.clock.call_later(20, come)

    server.offer = offer  # type: ignore[method-assign]
    result = run("""
        +!go <- !try(3); !try(9); .wait(20000); !try(2).
        +!try(N) <- count(N, 1, L); .print(L).
        -!try(N)[env_failure_reason(R)] <- .print(R).
        """)
    assert result.of("counter") == ["3", "server_lost", "2"]
