"""The report of the benchmarks: the content of its tables, and the goals that are met."""

import json
import runpy
from pathlib import Path
from typing import Any

import pytest
from graphs import figures_in
from mind.engines import AGENTSPEAK, OURS
from mind.rounds import measure, row_of
from mind.workloads import Workload, single
from report.goals import goals_of, latency_goals
from report.page import filled
from report.tables import latency, parts_of

ROOT = Path(__file__).parents[3]
CALLS = {"quick": 10.0, "slow": 60.0}


def workload(name: str, **rest: Any) -> Workload:
    return single(name, "count", 1000, lambda n, k: n, **rest)


def outcomes(engine: str, each: Workload, n: int) -> dict[str, Any]:
    """Return the output of an engine."""
    if engine == OURS:
        calls = CALLS[each.name.partition(" ")[0]] * n
        return {"seconds": calls * 1e-8, "calls": calls, "megabytes": 20.0, "results": ["7"]}
    if "for ever" in each.name:
        return {"note": "> 30 s", "at_least": 29.0}
    if "fails" in each.name:
        return {"note": "fails"}
    result = "8" if "wrong" in each.name else "7"
    return {"seconds": n * 1e-6, "megabytes": 30.0, "results": [result]}


PROGRAMS = (
    workload("quick goals", goal=25, faster=15, sizes={AGENTSPEAK: 100}),
    workload("quick work for ever", goal=50),
    workload("quick work without a peer", goal=50, lacks={AGENTSPEAK: "something"}),
    workload("slow work", goal=50),
    workload("quick work that fails", goal=None),
    workload("quick work that is wrong", goal=None),
)


@pytest.fixture
def report() -> dict[str, Any]:
    """A report of made-up figures, as it is read from its file."""
    engines = [OURS, AGENTSPEAK]
    told: list[str] = []
    figures = measure(PROGRAMS, engines, 2, outcomes, told.append)
    assert len(told) == 2 * len(PROGRAMS)
    found = json.loads((Path(__file__).parent / "report.json").read_text(encoding="utf-8"))
    rows = [row_of(each, its, engines) for each, its in zip(PROGRAMS, figures, strict=True)]
    found["programs"] = json.loads(json.dumps(rows))
    return dict(found)


def rows_of(table: str) -> dict[str, list[str]]:
    """The cells of a table, by the first of each row."""
    rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in table.splitlines()]
    return {row[0]: row[1:] for row in rows[2:]}


def test_a_program_has_its_cost_its_goal_and_its_peer(report: dict[str, Any]) -> None:
    rows = rows_of(parts_of(report)["programs"])
    assert rows["quick goals"] == [
        "100 ns per cycle", "10", "≤ 25 met", "20 MB", "10 ×", "≥ 15 **missed**", "30 MB",
    ]  # fmt: skip
    assert rows["slow work"][1:3] == ["60", "≤ 50 **missed**"]
    assert rows["slow work"][4:6] == ["1.7 ×", "≥ 12 **missed**"]


def test_goals_are_judged_by_the_worst(report: dict[str, Any]) -> None:
    goals = {goal.text: (goal.measured, goal.met) for goal in goals_of(report)}
    assert goals["a cycle of sub-goals ≤ 25 empty calls"] == ("10", True)
    assert goals["any other step ≤ 50 empty calls"] == ("60 (slow work); over it: slow work", False)
    assert goals["a look-up in 20,000 facts ≤ 2 × one in 200"] == ("not measured", None)
    assert goals["≥ 15 × python-agentspeak: quick goals"] == ("10 × (quick goals)", False)
    assert goals["memory of 1,000,000 cycles of tail recursion ≤ 1.2 × an empty program's"][1] is True
    start = "`jacaros run hello.asl` ≤ 0.35 s of processor time where an empty Python takes 0.02 s"
    assert goals[start] == ("0.300 s where it takes 0.020 s", True)
    assert goals["an operation, there and back, ≤ 20 µs"][1] is True
    assert goals["≥ 10,000 updates a second of a property with ten observers"][1] is False


def test_the_page_shows_its_figures() -> None:
    docs = ROOT / "docs"
    figures = json.loads((docs / "benchmarks.json").read_text(encoding="utf-8"))
    page = (docs / "benchmarks.md").read_text(encoding="utf-8")
    same = filled(page, parts_of(figures)) == page
    assert same, "docs/benchmarks.md is out of date: run `.venv/bin/python benchmarks/bench.py --page`"


def test_latencies_are_read_from_what_is_printed() -> None:
    text = (
        "ros2     agent  median   1.25 ms  90 %   2.00 ms  99 %  12.50 ms   (600 messages)\n"
        "ros2     3 messages lost\n"
        "ros2     agent  flat out     1234 a second\n"
    )
    assert figures_in(text, "ros2-jazzy") == [
        {
            "graph": "ros2-jazzy", "way": "agent", "median": 0.00125, "most": 0.002, "nearly_all": 0.0125,
            "messages": 600, "rate": 1234.0,
        }
    ]  # fmt: skip


def test_an_agent_is_compared_with_a_bare_echo_on_each_graph() -> None:
    figures = [
        {"graph": graph, "way": way, "median": median, "most": 1.0, "nearly_all": 1.0, "messages": 600, "rate": None}
        for graph, way, median in [("ros1", "agent", 0.002), ("ros1", "bare", 0.001), ("ros2", "agent", 0.00125),
                                   ("ros2", "bare", 0.001)]
    ]  # fmt: skip
    assert [(goal.measured, goal.met) for goal in latency_goals(figures)] == [
        ("2.00 ×", False),
        ("1.25 ×", True),
    ]
    assert "| ros1 | through an agent | 2.00 ms | 1000 ms | 1000 ms | 2.00 × |" in latency(
        {"figures": figures, "notes": []}
    )


def test_flat_out_counts_the_replies_of_each_way() -> None:
    pings = runpy.run_path(str(ROOT / "benchmarks" / "latency" / "pings.py"))
    now = 0.0
    sent: list[tuple[str, float]] = []
    flat = pings["FlatOut"](lambda: now, lambda way, number: sent.append((way, number)))
    while not flat.over:
        flat.next()
        for _ in range(5 if len(flat.rates) == 0 else 10):
            if sent:
                flat.returned(*sent.pop())
        sent = sent[-1:]
        now += 0.01
    assert flat.rates == {"agent": pytest.approx(500, rel=0.02), "bare": pytest.approx(1000, rel=0.02)}
