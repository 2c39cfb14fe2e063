"""Goals over actions and services that fail and that no plan saves: what people read about them."""

from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.action import Abort, ActionPolicy, GoalOutcome, GoalStatus
from jacaros.runtime.mas.system import System
from jacaros.testing import run_project

MAPPING = """\
operations:
  count:
    parameters: [n]
    action: count
    type: jacaros_interfaces/action/Count
    goal: {target: $n, period: 1}
    timeout: 8
  hold: {service: hold, type: std_srvs/srv/SetBool, request: {data: true}, timeout: 2}
"""

PROGRAM = """\
!patrol.
+!patrol <- !visit(kitchen).
+!visit(R) <- STEP; .print(never).
"""

COUNT = "jacaros_interfaces/action/Count"
GONE = "the server of action /count went away during goal /robot-1"
FAILED = "[robot] warning: the goal !patrol failed and has no plan for its failure: action_failed, "


class Server:
    """Counts and holds; 13: gives up, 9: its process is gone, above 100: refuses."""

    def offer(self, mas: System) -> None:
        self.clock = mas.clock
        backend = mas.ros.backend()
        policy = ActionPolicy(lambda goal: "too many" if goal.target > 100 else None)
        self.server: Any = backend.action_server("/count", COUNT, self._count, policy)
        backend.service("/hold", "std_srvs/srv/SetBool", lambda request: {"message": "the brake is worn"})

    async def _count(self, goal: Any) -> Any:
        await self.clock.sleep(1)
        if goal.request.target == 13:
            raise Abort("no path")
        if goal.request.target == 9:
            self.server.vanish()
        await self.clock.sleep(20)
        return {}


def told(folder: Path, step: str, server: bool = True) -> list[str]:
    """The lines that people read of a goal whose plan for a sub-goal makes a step."""
    file, mapping = folder / "robot.asl", folder / "robot.yaml"
    file.write_text(PROGRAM.replace("STEP", step), encoding="utf-8")
    mapping.write_text(MAPPING, encoding="utf-8")
    when_started = Server().offer if server else None
    result = run_project(
        file, seconds=60, until_idle=True, mappings=[mapping], world="none", when_started=when_started
    )
    assert result.lines == []
    lines = [line.replace(f"{folder}/", "") for each in result.errors for line in each.splitlines()]
    return lines[next(n for n, line in enumerate(lines) if line.startswith(FAILED[:12])) :]


def expected(message: str, step: str, reason: str) -> list[str]:
    return [
        f"{FAILED}{message} (robot.asl:3)",
        f"  step: {step}, for !visit(kitchen), !patrol",
        f"  reason: env_failure_reason({reason})",
    ]


@pytest.mark.parametrize(
    ("step", "message", "reason"),
    [
        ("count(101)", "the server of action /count rejected the goal: too many", "rejected"),
        ("count(13)", "action /count was aborted: no path", 'aborted(0,"no path")'),
        ("count(5)", "action /count did not end within 8 s", "timeout(8)"),
        ("count(9)", f"{GONE}; it is unknown whether the goal continues", "server_lost"),
        ("hold", "service /hold refused: the brake is worn", 'service_refused(hold,"the brake is worn")'),
    ],
)
def test_a_failure_is_logged_with_its_reason_step_and_goals(
    tmp_path: Path, step: str, message: str, reason: str
) -> None:
    assert told(tmp_path, step) == expected(message, step, reason)


def test_a_goal_cancelled_by_another_client(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Cancelled:
        goal_id = "1"

        async def outcome(self, timeout: float | None = None) -> GoalOutcome:
            return GoalOutcome(GoalStatus.CANCELED, None)

    async def send(*arguments: object) -> Cancelled:
        return Cancelled()

    monkeypatch.setattr("jacaros.robots.ros.action_client.ActionClient.send", send)
    message = "another client cancelled the goal of action /count"
    assert told(tmp_path, "count(5)") == expected(message, "count(5)", "canceled")


def test_servers_that_are_not_there(tmp_path: Path) -> None:
    assert told(tmp_path, "count(5)", server=False) == expected(
        f"no server offered action /count ({COUNT}) within 5 s", "count(5)", "server_unavailable"
    )
    assert told(tmp_path, "hold", server=False) == expected(
        "no node offered service /hold (std_srvs/srv/SetBool) within 2 s",
        "hold",
        "service_unavailable(hold)",
    )


def test_an_unknown_operation(tmp_path: Path) -> None:
    assert told(tmp_path, "cuont(5)") == [
        (
            f"{FAILED}no artifact of workspace /main has an operation cuont/1; did you mean `count/1` of 'robot'? "
            "(robot.asl:3)"
        ),
        "  step: cuont(5), for !visit(kitchen), !patrol",
        '  reason: env_failure_detail(unknown_operation("cuont/1"))',
    ]
