"""The plans of ``$jacaros/artifacts.asl``."""

from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project

INCLUDE = '{ include("$jacaros/artifacts.asl") }\n'

THESIS = {
    "create_odom": "toolOdom",
    "create_cmd_vel": "toolCmd_vel",
    "create_cmd_vel_odom": "toolCmd_vel_odom",
    "create_cmd_vel_mux_odom": "toolCmd_vel_mux_odom",
    "create_battery": "toolBattery",
    "create_cleaner": "toolCleaner",
}


def run(folder: Path, **programs: str) -> RunResult:
    """Run agents with these programs, with the library included in each."""
    for name, program in programs.items():
        (folder / f"{name}.asl").write_text(INCLUDE + program, encoding="utf-8")
    project = folder / "system.jcm"
    agents = "".join(f"agent {name}\n" for name in programs)
    project.write_text(f"mas system {{\n{agents}}}\n", encoding="utf-8")
    return run_project(project, seconds=30)


def test_an_artifact_in_use_shows_its_properties(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        robot="""
        !start.
        +!start <- !use_artifact("b", "ArtSimBattery", [level(30)]); ?battery(N); .print(N); .stopMAS.
        """,
    )
    assert (result.lines, result.errors) == (["[robot] 30"], [])


def test_two_agents_use_one_artifact(tmp_path: Path) -> None:
    program = """
        !start.
        +!start <- !use_artifact("b", "ArtSimBattery"); ?battery(N); .print(N).
        """
    result = run(tmp_path, one=program, two=program)
    assert (sorted(result.lines), result.errors) == (["[one] 100", "[two] 100"], [])


def test_an_agent_waits_for_an_artifact_that_is_created_later(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        early="""
        !start.
        +!start <- ?artifact("b", Id); focus(Id); ?battery(N); .print(N); .stopMAS.
        """,
        late="""
        !start.
        +!start <- .wait(3000); .print(now); !create_artifact("b", "ArtSimBattery", []).
        """,
    )
    assert (result.lines, result.errors) == (["[late] now", "[early] 100"], [])
    assert 3.0 <= result.seconds <= 3.2


def test_a_missing_artifact_is_logged_after_five_seconds(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        robot="""
        !start.
        +!start <- ?artifact("b", Id); .print(never).
        -!start[error_msg(Text)] <- .print("failed: ", Text); .stopMAS.
        """,
    )
    assert len(result.lines) == 1
    assert result.lines[0].startswith("[robot] failed: ")
    assert "b" in result.lines[0]
    assert result.seconds == pytest.approx(5.0, abs=0.3)


def test_a_failed_creation_is_logged_with_its_reason(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        robot="""
        !start.
        +!start <- !use_artifact("b", "ArtBatery").
        -!start[env_failure_reason(R), error_msg(Text)] <- .print(R); .print(Text); .stopMAS.
        """,
    )
    assert result.lines[0] == '[robot] makeArtifactFailure("unknown_artifact_template","ArtBatery")'
    assert "ArtBatery" in result.lines[1]


@pytest.mark.parametrize(("create", "tool"), THESIS.items())
def test_the_plans_of_the_thesis_make_and_find(create: str, tool: str, tmp_path: Path) -> None:
    result = run(
        tmp_path,
        robot=f"""
        !start.
        +!start <- !{create}; ?{tool}(Id); focus(Id); .print(done); .stopMAS.
        """,
    )
    assert (result.lines, result.errors) == (["[robot] done"], [])


def test_odometry_of_a_robot_with_a_name(tmp_path: Path) -> None:
    result = run(
        tmp_path,
        robot="""
        !start.
        +!start <- !create_odom("robot_0"); ?toolOdom("robot_0", Id); focus(Id); .print(done); .stopMAS.
        """,
    )
    assert (result.lines, result.errors) == (["[robot] done"], [])
