"""Whole runs on virtual time: beginning, end, creation and end of agents."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.errors import InternalError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project

Project = Callable[..., Path]


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """Write files into a folder. Return the path of the first one."""

    def write(**files: str) -> Path:
        paths = []
        for name, text in files.items():
            stem, _, suffix = name.rpartition("_")
            path = tmp_path / f"{stem}.{suffix}"
            path.write_text(text, encoding="utf-8")
            paths.append(path)
        return paths[0]

    return write


def test_a_lone_program_runs_to_its_stop(project: Project) -> None:
    result = run_project(project(hello_asl="!go. +!go <- .print(hi); .stopMAS(0, 7); .print(late)."))
    assert result.lines == ["[hello] hi"]
    assert result.exit_code == 7
    assert result.errors == []
    assert result.of("hello") == ["hi"]


def test_a_stop_can_be_announced(project: Project) -> None:
    result = run_project(
        project(a_asl="!go. +!go <- .stopMAS(2000, 3); .wait(1500); .print(still); .wait(9000).")
    )
    assert result.lines == ["[a] still"]
    assert result.exit_code == 3
    assert result.seconds == pytest.approx(2.0)


def test_an_idle_run_ends_on_request(project: Project) -> None:
    result = run_project(project(a_asl="!go. +!go <- .wait(500); .print(done)."), until_idle=True)
    assert result.lines == ["[a] done"]
    assert result.exit_code == 0
    assert result.seconds == pytest.approx(0.5)


def test_a_run_without_goals_is_idle_immediately(project: Project) -> None:
    assert run_project(project(a_asl="p(1)."), until_idle=True).exit_code == 0


def test_waiting_for_an_event_that_never_happens_is_idle(project: Project) -> None:
    result = run_project(project(a_asl='!go. +!go <- .wait("+never"); .print(late).'), until_idle=True)
    assert result.lines == []


def test_a_run_ends_after_its_time(project: Project) -> None:
    result = run_project(project(a_asl="!go. +!go <- .wait(1000); .print(tick); !go."), seconds=3.5)
    assert result.of("a") == ["tick"] * 3
    assert result.exit_code == 0


def test_an_endless_plan_does_not_delay_the_end(project: Project) -> None:
    result = run_project(project(a_asl="!go. +!go <- !go."), seconds=0.002)
    assert result.exit_code == 0
    assert result.seconds == pytest.approx(0.002, abs=1e-5)


def test_an_action_without_environment_fails(project: Project) -> None:
    file = project(
        p_mas2j="MAS p { agents: a; }",
        a_asl='!go. +!go <- move(1). -!go[error(E),env_failure_reason(R)] <- .print(E, " ", R); .stopMAS.',
    )
    assert run_project(file).lines == ["[a] action_failed no_environment"]


def test_agents_talk_and_share_a_program(project: Project) -> None:
    file = project(
        p_mas2j="MAS p { agents: boss; worker #2; }",
        boss_asl="!go. +!go <- .broadcast(achieve, work). +done[source(A)] : .count(done[source(_)], 1) <- .print(A).",
        worker_asl="+!work[source(B)] <- .my_name(N); .print(N); .send(B, tell, done).",
    )
    result = run_project(file, until_idle=True)
    assert result.of("worker1") == ["worker1"]
    assert result.of("worker2") == ["worker2"]
    assert result.of("boss")


def test_goals_and_beliefs_of_the_project_come_first(project: Project) -> None:
    file = project(
        p_mas2j='MAS p { agents: a [beliefs="p(2)", goals="first"]; }',
        a_asl="p(1). !second. +!first : .findall(X, p(X), L) <- .print(first, L). +!second <- .print(second).",
    )
    assert run_project(file, until_idle=True).lines[0].startswith("[a] first")


def test_agents_create_and_kill_agents(project: Project) -> None:
    file = project(
        a_asl="""
        !go.
        +!go <- .create_agent(helper, "h.asl"); .create_agent(h); .wait(100);
                .all_names(L); .print(L); .kill_agent(helper); .all_names(M); .print(M);
                !missing; .stopMAS.
        +!missing <- .create_agent(missing).
        -!missing <- .print(none).
        """,
        h_asl="!hello. +!hello <- .my_name(N); .print(N); .wait(500); .print(late).",
    )
    result = run_project(file)
    assert result.of("helper") == ["helper"]
    assert result.of("h") == ["h"]
    assert result.of("a")[-1] == "none"
    assert any("program not found: missing.asl" in line for line in result.errors)


def test_a_wrong_program_is_refused_before_anything_runs(project: Project) -> None:
    file = project(
        p_mas2j="MAS p { agents: a; b; }", a_asl="!go. +!go <- .print(hi).", b_asl="!go. +!go <- .print("
    )
    result = run_project(file)
    assert result.lines == []
    assert result.exit_code == 1
    assert "b.asl:1" in result.errors[0]


def test_the_same_seed_gives_the_same_run(project: Project) -> None:
    file = project(a_asl="!go. +!go <- .random(X); .print(X).")
    first, second, other = [run_project(file, seed=seed, until_idle=True).lines for seed in (1, 1, 2)]
    assert first == second
    assert first != other


def test_agents_have_generators_of_their_own(project: Project) -> None:
    file = project(p_mas2j="MAS p { agents: a #2; }", a_asl="!go. +!go <- .random(X); .print(X).")
    lines = run_project(file, until_idle=True).lines
    assert lines[0].partition("] ")[2] != lines[1].partition("] ")[2]


def test_a_defect_ends_the_run(project: Project) -> None:
    file = project(a_asl="!go. +!go <- .wait(1000); .print(late).")

    def break_it(mas: System) -> None:
        mas.clock.call_later(0.5, lambda: mas.fail(InternalError("broken")))

    with pytest.raises(InternalError, match="broken"):
        run_project(file, when_started=break_it)


def test_the_graph_is_left_in_order_even_if_the_end_of_an_agent_fails(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Robots are stopped when the graph is left."""
    file = project(a_asl="!go. +!go <- .wait(1000); .print(late).")
    stopped: list[str] = []

    def broken(host: AgentHost) -> None:
        raise InternalError(f"{host.name} cannot end")

    def watch(mas: System) -> None:
        mas.ros.backend().add_exit_hook(lambda: stopped.append("robot"))
        monkeypatch.setattr(AgentHost, "end", broken)

    with pytest.raises(InternalError, match="a cannot end"):
        run_project(file, seconds=0.5, when_started=watch)
    assert stopped == ["robot"]


def test_the_clock_of_the_run_is_seen_by_agents(project: Project) -> None:
    result = run_project(project(a_asl="!go. +!go <- .date(Y,M,D); .print(Y,M,D)."), until_idle=True)
    assert result.lines == ["[a] 202011"]
    assert VirtualClock().now() == 1577836800.0


def test_undeclared_files_are_reported(tmp_path: Path) -> None:
    result = run_project(tmp_path / "none.asl")
    assert result.exit_code == 1
    assert "file not found: " in result.errors[0]
    assert isinstance(result, RunResult)
