"""The disturbances of the experiment: fault files that fit their worlds, the same for the same seed."""

import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.robots.world import World
from jacaros.robots.world.files.faults import read_faults
from jacaros.robots.world.files.world import load_world
from jacaros.testing import RunResult

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from comparison import after_the_end, compared, ends_table, fewer, fisher, mcnemar, significance
from disturbances import (
    FURTHER,
    FURTHER_KINDS,
    KINDS,
    SEEN,
    faults_for,
    held_out,
    is_further,
    kind_of,
    kinds_for,
)
from disturbed_runs import (
    AGENTS,
    BASELINE,
    PATIENCE,
    PATIENT,
    Job,
    Outcome,
    held_out_jobs,
    run_one,
    world_of,
)
from outcomes import AS_IF_DONE, DONE, HUNG, TOLD, damage, end_of, told_at
from run import as_line, from_json, recorded
from scenarios import FURTHER_SCENARIOS, SCENARIOS
from success import further_table, halves_table


@pytest.mark.parametrize("name", SCENARIOS)
def test_all_faults_fit_the_world(name: str, tmp_path: Path) -> None:
    description = load_world(world_of(name, tmp_path))
    for seed in range(50):
        assert read_faults(faults_for(name, seed), description)


@pytest.mark.parametrize("name", FURTHER_SCENARIOS)
def test_all_further_faults_fit_the_world(name: str, tmp_path: Path) -> None:
    description = load_world(world_of(name, tmp_path))
    for seed in range(FURTHER + 1, FURTHER + 21):
        faults = read_faults(faults_for(name, seed), description)
        assert {fault.kind for fault in faults} == {kind_of(name, seed)}
    assert {kind_of(name, seed) for seed in range(FURTHER + 1, FURTHER + 21)} == set(
        kinds_for(name, FURTHER + 1)
    )


def test_every_further_kind_occurs() -> None:
    assert {kind for name in FURTHER_SCENARIOS for kind in kinds_for(name, FURTHER + 1)} == set(FURTHER_KINDS)


def test_every_kind_occurs_and_takes_its_turn() -> None:
    assert {kind for name in SCENARIOS for kind in kinds_for(name)} == set(KINDS)
    for name in SCENARIOS:
        kinds = kinds_for(name)
        assert [kind_of(name, seed) for seed in range(len(kinds))] == kinds


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_seeds_held_out_have_all_kinds(name: str) -> None:
    fresh = {job.seed for job in held_out_jobs(50, 10) if job.scenario == name}
    assert all(map(held_out, fresh))
    assert {kind_of(name, seed) for seed in fresh if not is_further(seed)} == set(kinds_for(name))
    assert not any(map(held_out, (*range(1, 51), *range(FURTHER + 1, FURTHER + 21))))


def test_a_seed_gives_the_same_faults_and_another_seed_others() -> None:
    texts = [faults_for("patrol", seed) for seed in range(50)]
    assert texts == [faults_for("patrol", seed) for seed in range(50)]
    assert len(set(texts)) > 40


@pytest.mark.parametrize("name", ["patrol", "house_cleaning"])
def test_a_tree_with_the_agents_policy_differs_by_its_attempts_alone(name: str) -> None:
    tree = SCENARIOS[name].baseline.read_text(encoding="utf-8")
    assert all(tree.count(each) == 1 for each in PATIENCE)


@pytest.mark.slow
def test_a_tree_with_the_agents_policy_outlasts_aborted_goals() -> None:
    seed = next(each for each in range(1, 50) if kind_of("house_cleaning", each) == "aborted")
    assert not run_one(Job("house_cleaning", BASELINE, seed)).passed
    assert run_one(Job("house_cleaning", PATIENT, seed)).passed


def test_fishers_and_mcnemars_tests_have_the_values_of_their_tables() -> None:
    assert fisher(3, 4, 1, 4) == pytest.approx(34 / 70)  # Fisher's lady tasting tea, two-sided
    assert fisher(50, 50, 50, 50) == 1.0
    assert fisher(8, 8, 0, 7) == pytest.approx(1 / 6435)
    assert mcnemar(10, 0) == pytest.approx(2 / 1024)
    assert mcnemar(0, 0) == 1.0
    assert mcnemar(3, 1) == pytest.approx(10 / 16)


def outcome(seed: int, side: str, passed: bool, seconds: float = 100.0, end: str = "") -> Outcome:
    end = end or (DONE if passed else AS_IF_DONE)
    return Outcome(Job("square", side, seed), kind_of("square", seed), passed, seconds, "", end)


def test_seeds_whose_fault_came_after_an_end_are_left_out_on_both_sides() -> None:
    late = next(each for each in range(1, 50) if kind_of("square", each) == "carried")
    early = late + len(kinds_for("square"))
    runs = [outcome(late, AGENTS, True, seconds=0.5), outcome(early, AGENTS, True)]
    runs += [outcome(late, BASELINE, False), outcome(early, BASELINE, True)]
    (found,) = compared(runs)
    assert [each.job.seed for each in found.agents] == [late, early]
    assert [each.job.seed for each in found.disturbed().agents] == [early]
    assert [each.job.seed for each in found.disturbed().baseline] == [early]
    assert after_the_end(runs).startswith("In 1 runs")
    assert after_the_end(runs[1:]).startswith("No program")


def test_sentences_follow_the_figures() -> None:
    close = [outcome(seed, side, seed % 2 == 0) for seed in range(1, 11) for side in (AGENTS, BASELINE)]
    assert "Fisher's exact test: none" in significance(close)
    assert fewer(close).endswith("in no scenario.")
    apart = [outcome(seed, side, side == BASELINE) for seed in range(1, 11) for side in (AGENTS, BASELINE)]
    assert "Fisher's exact test: square" in significance(apart)
    assert fewer(apart).endswith("in square (0 : 10 of 10).")


def test_runs_are_counted_by_how_they_end() -> None:
    runs = [outcome(each, BASELINE, False, end=end) for each, end in enumerate((TOLD, HUNG, AS_IF_DONE))]
    rows = {str(row[0]): row[1:] for row in ends_table([*runs, outcome(9, AGENTS, True)]).rows}
    assert rows[BASELINE] == (3, 0, 1, 1, 1, "67 %")
    assert rows[AGENTS] == (1, 1, 0, 0, 0, "0 %")


@pytest.mark.parametrize(
    ("output", "exit_code", "seconds", "told", "end"),
    [
        ([(3.0, "[robot] I need help: stuck")], 0, 100.0, 3.0, TOLD),
        ([(3.0, "[robot] driving"), (4.0, "[robot] goal !go failed: blocked")], 0, 50.0, 4.0, TOLD),
        ([(5.0, "[robot] I am stuck: door(shut). What shall I do?")], 0, 100.0, 5.0, TOLD),
        ([], 1, 60.0, 60.0, TOLD),
        ([(3.0, "[robot] 650 mm from where I started")], 0, 60.0, None, AS_IF_DONE),
        ([(3.0, "  = help: did you mean `go`?")], 0, 100.0, None, HUNG),
    ],
)
def test_a_failing_run_has_told_or_not(
    output: list[tuple[float, str]], exit_code: int, seconds: float, told: float | None, end: str
) -> None:
    result = RunResult(timed=output, exit_code=exit_code, seconds=seconds)
    assert told_at(result) == told
    assert end_of(result, False, 100.0) == end
    assert end_of(result, True, 100.0) == DONE


def test_damage_counts_from_the_disturbance() -> None:
    world = World.load("house", faults="faults:\n  f: {kind: battery_drop, to: 0, at: 1}\n")
    world.log_task(world.robot().name, "mop floor kitchen")  # it is in the hallway
    world.run(2.0)
    assert damage(world.ground_truth) == (0, True, 0)
    world.log_task(world.robot().name, "mop floor kitchen")
    assert damage(world.ground_truth) == (0, True, 1)


def test_further_runs_are_counted_by_kind_and_by_half() -> None:
    seeds = [FURTHER + each for each in range(1, 5)]
    runs = [outcome(each, AGENTS, each % 2 == 0) for each in seeds]
    assert further_table(runs).rows == (
        ("square", "lost_localisation", "2 / 0 / 0 / 0"),
        ("square", "person_in_the_way", "0 / 0 / 2 / 0"),
    )
    fresh = outcome(FURTHER + SEEN + 1, AGENTS, True)
    assert halves_table([*runs, fresh]).rows == (("square", AGENTS, "2 / 0 / 2 / 0", "1 / 0 / 0 / 0"),)


def test_an_interrupted_experiment_continues_from_its_journal(tmp_path: Path) -> None:
    journal = tmp_path / "runs.jsonl"
    known, new = outcome(1, AGENTS, True), Job("out_and_back", AGENTS, 3)
    journal.write_text(f"{as_line(known)}\n", encoding="utf-8")
    found = recorded([new, known.job], journal, 1)
    assert found[1] == known
    assert (found[0].job, found[0].end) == (new, TOLD)
    assert from_json(f"[{','.join(journal.read_text('utf-8').splitlines())}]") == [known, found[0]]


@pytest.mark.slow
def test_a_missed_grasp_fetches_nothing() -> None:
    found = [run_one(Job("fetch", AGENTS, seed)) for seed in (FURTHER + 2, FURTHER + 5)]
    assert {each.kind for each in found} == {"missed_grasp"}
    assert all(each.end in (DONE, TOLD) for each in found)
