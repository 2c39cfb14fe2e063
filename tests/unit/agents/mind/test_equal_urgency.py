"""Where everything is equally urgent, all goes as without urgency: programs whose order was recorded on Jason."""

from pathlib import Path

import pytest

from jacaros.agents.mind.rules import urgency
from jacaros.testing import RunResult, run_project

CASES = Path(__file__).parents[3] / "conformance"
PROGRAMS = sorted(
    path
    for area in ("concurrency", "failure", "intentions", "messages", "plan_selection", "programs")
    for pattern in ("*.asl", "*/*.mas2j")
    for path in (CASES / area).glob(pattern)
)


def test_there_are_programs():
    assert len(PROGRAMS) > 50


@pytest.mark.parametrize("ordered", [False, True], ids=["plain", "in order of urgency"])
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_program_prints_the_same(program, ordered, monkeypatch):
    ordered_agents = []

    def run() -> RunResult:
        return run_project(
            program,
            seconds=120,
            when_started=lambda mas: ordered_agents.extend(
                isinstance(host.mind.selections, urgency.Urgent) for host in mas.directory
            ),
        )

    plain = run()
    assert not any(ordered_agents)
    monkeypatch.setattr(urgency, "has_urgent_plans", lambda agent: True)
    if ordered:
        monkeypatch.setattr(urgency.Urgent, "_calm_down", lambda selections: None)
    ordered_agents.clear()
    urgent = run()
    assert all(ordered_agents)
    assert (urgent.lines, urgent.errors, urgent.exit_code) == (plain.lines, plain.errors, plain.exit_code)
