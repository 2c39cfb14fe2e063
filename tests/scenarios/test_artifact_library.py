"""The plans of ``$jacaros/artifacts.asl``."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project

INCLUDE = '{ include("$jacaros/artifacts.asl") }\n'

Run = Callable[..., RunResult]

THESIS = {
    "create_odom": "toolOdom",
    "create_cmd_vel": "toolCmd_vel",
    "create_cmd_vel_odom": "toolCmd_vel_odom",
    "create_cmd_vel_mux_odom": "toolCmd_vel_mux_odom",
    "create_battery": "toolBattery",
    "create_cleaner": "toolCleaner",
}


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Runs agents with these programs, with the library included in each; `start` is the only plan of an agent a."""

    def run(start: str = "", **programs: str) -> RunResult:
        if start:
            programs["a"] = f"!start. +!start <- {start}; .stopMAS."
        for name, program in programs.items():
            (tmp_path / f"{name}.asl").write_text(INCLUDE + program, encoding="utf-8")
        project = tmp_path / "system.jcm"
        agents = "".join(f"agent {name}\n" for name in programs)
        project.write_text(f"mas system {{\n{agents}}}\n", encoding="utf-8")
        return run_project(project, seconds=30)

    return run


def test_an_artifact_in_use_shows_its_properties(run: Run) -> None:
    result = run('!use_artifact("b", "ArtSimBattery", [level(30)]); ?battery(N); .print(N)')
    assert (result.lines, result.errors) == (["[a] 30"], [])


def test_two_agents_use_one_artifact(run: Run) -> None:
    program = '!start. +!start <- !use_artifact("b", "ArtSimBattery"); ?battery(N); .print(N).'
    result = run(one=program, two=program)
    assert (sorted(result.lines), result.errors) == (["[one] 100", "[two] 100"], [])


def test_an_agent_waits_for_an_artifact_that_is_created_later(run: Run) -> None:
    result = run(
        early='!start. +!start <- ?artifact("b", Id); focus(Id); ?battery(N); .print(N); .stopMAS.',
        late='!start. +!start <- .wait(3000); .print(now); !create_artifact("b", "ArtSimBattery", []).',
    )
    assert (result.lines, result.errors) == (["[late] now", "[early] 100"], [])
    assert 3.0 <= result.seconds <= 3.2


def test_a_missing_artifact_is_logged_after_five_seconds(run: Run) -> None:
    fails = '-!start[error_msg(Text)] <- .print("failed: ", Text); .stopMAS.'
    result = run(robot=f'!start. +!start <- ?artifact("b", Id); .print(never). {fails}')
    assert len(result.lines) == 1
    assert result.lines[0].startswith("[robot] failed: ")
    assert "b" in result.lines[0]
    assert result.seconds == pytest.approx(5.0, abs=0.3)


def test_a_failed_creation_is_logged_with_its_reason(run: Run) -> None:
    fails = "-!start[env_failure_reason(R), error_msg(Text)] <- .print(R); .print(Text); .stopMAS."
    result = run(robot=f'!start. +!start <- !use_artifact("b", "ArtBatery"). {fails}')
    assert result.lines[0] == '[robot] makeArtifactFailure("unknown_artifact_template","ArtBatery")'
    assert "ArtBatery" in result.lines[1]


@pytest.mark.parametrize(("create", "tool"), THESIS.items())
def test_the_plans_of_the_thesis_make_and_find(create: str, tool: str, run: Run) -> None:
    result = run(f"!{create}; ?{tool}(Id); focus(Id); .print(done)")
    assert (result.lines, result.errors) == (["[a] done"], [])


def test_odometry_of_a_robot_with_a_name(run: Run) -> None:
    result = run('!create_odom("robot_0"); ?toolOdom("robot_0", Id); focus(Id); .print(done)')
    assert (result.lines, result.errors) == (["[a] done"], [])
