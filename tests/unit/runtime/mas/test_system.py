"""Whole runs on virtual time: beginning, end, creation and end of agents."""

from collections.abc import Callable
from typing import Any

import pytest

from jacaros.runtime.clock import VirtualClock
from jacaros.runtime.errors import InternalError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult

Ran = Callable[..., RunResult]
ENDLESS = {"until_idle": False}


@pytest.mark.parametrize(
    ("program", "options", "said", "code", "seconds"),
    [
        ("!go. +!go <- .print(hi); .stopMAS(0, 7); .print(late).", ENDLESS, ["hi"], 7, 0.0),
        ("!go. +!go <- .stopMAS(2000, 3); .wait(1500); .print(still); .wait(9000).", {}, ["still"], 3, 2.0),
        ("!go. +!go <- .wait(500); .print(done).", {}, ["done"], 0, 0.5),
        ("p(1).", {}, [], 0, 0.0),
        ('!go. +!go <- .wait("+never"); .print(late).', {}, [], 0, 0.0),
        ("!go. +!go <- .wait(1000); .print(tick); !go.", {"seconds": 3.5}, ["tick"] * 3, 0, 3.5),
        ("!go. +!go <- !go.  // jacaros: allow loop-without-wait", {"seconds": 0.002}, [], 0, 0.002),
    ],
    ids=["stop", "announced stop", "idle", "no goals", "wait for nothing", "time limit", "endless plan"],
)
def test_a_run_ends(
    ran: Ran, program: str, options: dict[str, Any], said: list[str], code: int, seconds: float
) -> None:
    result = ran(program, **options)
    assert result.lines == [f"[a] {line}" for line in said]
    assert result.of("a") == said
    assert (result.exit_code, result.errors) == (code, [])
    assert result.seconds == pytest.approx(seconds, abs=1e-5)


def test_an_action_without_environment_fails(ran: Ran) -> None:
    result = ran(
        p_mas2j="MAS p { agents: a; }",
        a_asl='!go. +!go <- move(1). -!go[error(E),env_failure_reason(R)] <- .print(E, " ", R); .stopMAS.',
    )
    assert result.lines == ["[a] action_failed no_environment"]


def test_agents_create_and_kill_agents(ran: Ran) -> None:
    result = ran(
        """!go.
        +!go <- .create_agent(helper, "h.asl"); .create_agent(h); .wait(100);
                .all_names(L); .print(L); .kill_agent(helper); .all_names(M); .print(M);
                !missing; .stopMAS.
        +!missing <- .create_agent(missing).
        -!missing <- .print(none).""",
        h_asl="!hello. +!hello <- .my_name(N); .print(N); .wait(500); .print(late).",
    )
    assert result.of("helper") == ["helper"]
    assert result.of("h") == ["h"]
    assert result.of("a")[-1] == "none"
    assert any("program not found: missing.asl" in line for line in result.errors)


def test_a_wrong_program_is_refused_before_anything_runs(ran: Ran) -> None:
    result = ran(
        p_mas2j="MAS p { agents: a; b; }", a_asl="!go. +!go <- .print(hi).", b_asl="!go. +!go <- .print("
    )
    assert result.lines == []
    assert result.exit_code == 1
    assert "b.asl:1" in result.errors[0]


def test_the_same_seed_gives_the_same_run_and_agents_have_generators_of_their_own(ran: Ran) -> None:
    files = {"p_mas2j": "MAS p { agents: a #2; }", "a_asl": "!go. +!go <- .random(X); .print(X)."}
    first, second, other = [ran(**files, seed=seed).lines for seed in (1, 1, 2)]
    assert first == second
    assert first != other
    assert first[0].partition("] ")[2] != first[1].partition("] ")[2]


LATE = "!go. +!go <- .wait(1000); .print(late)."


def test_a_defect_ends_the_run(ran: Ran) -> None:
    def break_it(mas: System) -> None:
        mas.clock.call_later(0.5, lambda: mas.fail(InternalError("broken")))

    with pytest.raises(InternalError, match="broken"):
        ran(LATE, when_started=break_it)


def test_the_graph_is_left_in_order_even_if_the_end_of_an_agent_fails(ran: Ran, monkeypatch):
    """Robots are stopped when the graph is left."""
    stopped: list[str] = []

    def broken(host: AgentHost) -> None:
        raise InternalError(f"{host.name} cannot end")

    def watch(mas: System) -> None:
        mas.ros.backend().add_exit_hook(lambda: stopped.append("robot"))
        monkeypatch.setattr(AgentHost, "end", broken)

    with pytest.raises(InternalError, match="a cannot end"):
        ran(LATE, seconds=0.5, when_started=watch)
    assert stopped == ["robot"]


def test_the_clock_of_the_run_is_seen_by_agents(ran: Ran) -> None:
    assert ran("!go. +!go <- .date(Y,M,D); .print(Y,M,D).").lines == ["[a] 202011"]
    assert VirtualClock().now() == 1577836800.0
