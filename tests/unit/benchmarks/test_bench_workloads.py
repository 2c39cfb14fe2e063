"""Every benchmark program does its work, with as many units as in the table."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from mind import scaling
from mind.engines import AGENTSPEAK, OURS
from mind.marks import Marks
from mind.rounds import turns
from mind.workloads import WORKLOADS, Workload

from jacaros.testing import run_project


def small(workload: Workload, k: int) -> Workload:
    """The same among fewer others."""
    agents = tuple((name, file, k if count > 1 else 1) for name, file, count in workload.agents)
    return replace(workload, k=k if workload.k else 0, agents=agents)


def run(workload: Workload, n: int, times: int, folder: Path) -> tuple[list[str], int]:
    """What a program prints, and its cycles."""
    minds: list[Any] = []
    result = run_project(
        workload.write(folder, n, times),
        when_started=lambda mas: minds.extend(host.mind for host in mas.directory),
    )
    assert (result.exit_code, result.errors) == (0, [])
    lines = [line.partition("] ")[2] for line in result.lines]
    return lines, sum(mind.counts.cycles for mind in minds)


@pytest.mark.parametrize("workload", WORKLOADS, ids=lambda each: each.name)
def test_a_program_runs_the_requested_number_of_times(workload: Workload, tmp_path: Path) -> None:
    lines, _ = run(small(workload, 4), 6, 3, tmp_path)
    assert [line.split()[0] for line in lines] == ["begin", "end"] * 3
    assert len(set(lines)) == 2, "the work has the same result each time"


COUNTED = [workload for workload in WORKLOADS if workload.unit == "cycle"]


@pytest.mark.parametrize("workload", COUNTED, ids=lambda each: each.name)
@pytest.mark.parametrize(("n", "k"), [(6, 4), (11, 4), (6, 9)])
def test_the_table_has_the_number_of_cycles_of_the_work(
    workload: Workload, n: int, k: int, tmp_path: Path
) -> None:
    meant = small(workload, k)
    (_, twice), (_, once) = (run(meant, n, times, tmp_path) for times in (2, 1))
    assert twice - once == meant.units_of(n, meant.k)


def test_other_units_are_counted_as_they_come(tmp_path: Path) -> None:
    by_name = {workload.name: workload for workload in WORKLOADS}
    assert run(by_name["join"], 7, 1, tmp_path)[0][-1] == "end 7"
    assert by_name["join"].units_of(7, 0) == 7
    assert by_name["fib by rules"].units_of(5, 0) == 15


@pytest.mark.parametrize("curve", scaling.CURVES, ids=lambda each: each.name)
@pytest.mark.parametrize("size", [1, 3])
def test_programs_that_grow_do_their_work(curve: scaling.Curve, size: int, tmp_path: Path) -> None:
    workload = curve.at(size)
    lines, _ = run(workload, 8, 2, tmp_path)
    assert [line.split()[0] for line in lines] == ["begin", "end"] * 2


def test_a_smaller_workload_is_repeated_where_the_peer_does_less() -> None:
    workload = replace(WORKLOADS[0], n=100, sizes={AGENTSPEAK: 10}, lacks={})
    assert turns(workload, [OURS, AGENTSPEAK]) == [(OURS, 100), (AGENTSPEAK, 10), (OURS, 10)]
    alike = replace(workload, sizes={})
    assert turns(alike, [OURS, AGENTSPEAK]) == [(OURS, 100), (AGENTSPEAK, 100)]
    assert turns(replace(workload, lacks={AGENTSPEAK: "it"}), [OURS, AGENTSPEAK]) == [(OURS, 100)]


def marked(*texts: str) -> Iterator[Marks]:
    marks = Marks()
    for text in texts:
        marks.take(text)
    yield marks


def test_marks_keep_the_results_and_leave_out_what_is_not_work() -> None:
    (marks,) = marked("begin", "noise", "end 5.0", "end 6", "begin", "end")
    report = marks.report()
    assert report["results"] == ["5", ""]
    assert report["times"] == 2
    assert report["seconds"] == marks.seconds[1]
    assert report["first"] == marks.seconds[0]
    assert report["megabytes"] > 1
