"""The disturbances of the experiment, and the runs with them: drawn again until both sides of a pair feel them."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.robots.world import World
from jacaros.robots.world.files.faults import read_faults
from jacaros.robots.world.files.world import load_world
from jacaros.testing import RunResult

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

import record
import run
import runs
from disturbances import (
    DRAWS,
    FURTHER_KINDS,
    FURTHER_SEEDS,
    KINDS,
    QUARTER,
    SEEDS,
    disturbance,
    kind_of,
    kinds_for,
)
from outcomes import DONE, SILENT, TOLD, Damage, damage, effect_at, end_of, told_at
from record import Outcome
from runs import Family, families, run_family, run_one, sides_of
from scenarios import FURTHER_SCENARIOS, SCENARIOS
from sides import AGENTS, BASELINE, PAIR, world_of

# ---- what is drawn


@pytest.mark.parametrize("name", SCENARIOS)
def test_all_faults_fit_the_world(name: str, tmp_path: Path) -> None:
    description = load_world(world_of(name, tmp_path))
    for seed in SEEDS[:28]:
        assert read_faults(disturbance(name, seed, seed % DRAWS).faults, description)


@pytest.mark.parametrize("name", FURTHER_SCENARIOS)
def test_all_further_faults_fit_the_world(name: str, tmp_path: Path) -> None:
    description = load_world(world_of(name, tmp_path))
    drawn = [disturbance(name, seed) for seed in FURTHER_SEEDS]
    for each in drawn:
        assert {fault.kind for fault in read_faults(each.faults, description)} == {each.kind}
    assert {each.kind for each in drawn} == set(kinds_for(name, FURTHER_SEEDS[0]))


def test_every_kind_occurs_and_takes_its_turn() -> None:
    assert {kind for name in SCENARIOS for kind in kinds_for(name)} == set(KINDS)
    assert {kind for name in FURTHER_SCENARIOS for kind in kinds_for(name, FURTHER_SEEDS[0])} == set(
        FURTHER_KINDS
    )
    for name in SCENARIOS:
        turn = len(kinds_for(name))
        assert sorted(kind_of(name, seed) for seed in SEEDS[:turn]) == sorted(kinds_for(name))


@pytest.mark.parametrize("name", SCENARIOS)
def test_doses_and_shares_have_the_ranges_of_the_protocol(name: str) -> None:
    for seed in SEEDS:
        drawn = disturbance(name, seed)
        kind = KINDS[drawn.kind]
        assert kind.least <= drawn.dose <= kind.most
        assert (0.05 <= drawn.share <= 0.8) if kind.latest else drawn.share == 0.0
    doses = [disturbance(name, seed).dose for seed in SEEDS if kind_of(name, seed) == "lost"]
    assert min(doses) < 0.1
    assert max(doses) > 0.5


def test_a_draw_is_the_same_each_time_and_another_draw_is_another() -> None:
    assert disturbance("patrol", 2003, 1) == disturbance("patrol", 2003, 1)
    draws = [disturbance("patrol", 2003, draw) for draw in range(DRAWS)]
    assert len({each.kind for each in draws}) == 1
    assert len({each.faults for each in draws}) == DRAWS


# ---- pairs


def outcome(family: Family, side: str, draw: int = 0, effect: float | None = 1.0, end: str = DONE) -> Outcome:
    kind = kind_of(family.scenario, family.seed)
    harm = Damage(0, False, 0)
    return Outcome(
        family.scenario, side, family.seed, draw, kind, 0.1, 0.2, end, False, 9.0, effect, None, 2.0, harm, ""
    )


def with_effect(feels: Callable[[str, int], bool]) -> Callable[[Family, str, int], Outcome]:
    """Make runs whose disturbance has an effect if *feels*(side, draw)."""
    return lambda family, side, draw: outcome(family, side, draw, 1.0 if feels(side, draw) else None)


PATROL = Family("patrol", QUARTER[0])


def test_a_pair_is_drawn_again_until_both_sides_feel_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "run_one", with_effect(lambda side, draw: draw >= (3 if side == AGENTS else 2)))
    found = run_family(PATROL)
    assert {each.draw for each in found} == {3}
    assert set(PAIR) < {each.side for each in found}


def test_a_seed_without_effect_is_left_out_on_all_sides(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "run_one", with_effect(lambda side, draw: side != BASELINE))
    assert run_family(PATROL) == []


def test_the_pair_alone_decides_the_draw(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "run_one", with_effect(lambda side, draw: side in PAIR or draw > 0))
    assert [(each.side, each.draw) for each in run_family(PATROL)] == [(side, 0) for side in PAIR]


def test_all_seeds_of_the_protocol_run_and_a_quarter_on_the_other_sides() -> None:
    every = [family for family in families() if family.seed in SEEDS]
    assert len(every) == 200 * len(SCENARIOS)
    sides = [side for family in every if family.scenario == "patrol" for side in sides_of(family)]
    assert {side: sides.count(side) for side in sides} == {
        "agents": 200,
        "baseline": 200,
        "recovery tree": 200,
        "state machine": 200,
        "agents that drive themselves": 50,
        "agents without urgency": 50,
        "agents without checks": 50,
        "baseline without pause": 50,
    }


# ---- outcomes


@pytest.mark.parametrize(
    ("output", "exit_code", "told", "end"),
    [
        ([(3.0, "[robot] I need help: stuck")], 0, 3.0, TOLD),
        ([(3.0, "[robot] driving"), (4.0, "[robot] goal !go failed: blocked")], 0, 4.0, TOLD),
        ([(5.0, "[robot] I am stuck: door(shut). What shall I do?")], 0, 5.0, TOLD),
        ([], 1, 60.0, TOLD),
        ([(1.0, "[robot] I need help: stuck")], 0, None, SILENT),  # before the effect
        ([(3.0, "[robot] 650 mm from where I started")], 0, None, SILENT),
        ([(3.0, "  = help: did you mean `go`?")], 0, None, SILENT),
    ],
)
def test_a_failing_run_has_told_or_not(
    output: list[tuple[float, str]], exit_code: int, told: float | None, end: str
) -> None:
    result = RunResult(timed=output, exit_code=exit_code, seconds=60.0)
    assert told_at(result, 2.0) == told
    assert end_of(told, done=False) == end
    assert end_of(told, done=True) == DONE


def test_an_effect_after_the_end_does_not_count() -> None:
    world = World.load("house", faults="faults:\n  f: {kind: battery_drop, to: 50, at: 1}\n")
    world.run(2.0)
    assert effect_at(RunResult(seconds=2.0, ground_truth=world.ground_truth)) == pytest.approx(1.0, abs=0.1)
    assert effect_at(RunResult(seconds=0.5, ground_truth=world.ground_truth)) is None


def test_damage_counts_from_the_effect() -> None:
    world = World.load("house")
    world.log_task(world.robot().name, "mop floor kitchen")  # it is in the hallway
    world.run(2.0)
    assert damage(world.ground_truth, 1.0) == (0, False, 0)
    world.log_task(world.robot().name, "mop floor kitchen")
    assert damage(world.ground_truth, 1.0) == (0, False, 1)


# ---- the record


def test_a_record_has_the_same_bytes_whatever_the_order(tmp_path: Path) -> None:
    lines = [outcome(Family("square", seed), side) for seed in (2, 1) for side in PAIR]
    record.write(lines, tmp_path / "one.gz")
    record.write(reversed(lines), tmp_path / "other.gz")
    assert (tmp_path / "one.gz").read_bytes() == (tmp_path / "other.gz").read_bytes()
    assert record.read(tmp_path / "one.gz") == sorted(lines)
    assert record.read(tmp_path / "none.gz") == []


def test_an_interrupted_experiment_continues_from_its_journal(tmp_path: Path) -> None:
    journal = tmp_path / "runs.jsonl"
    known, left_out, new = Family("square", 1), Family("square", 2), Family("fake_battery", SEEDS[-1])
    lines = [
        f'[["square", 1], [{run.json.dumps(record.as_line(outcome(known, AGENTS)))}]]',
        '[["square", 2], []]',
    ]
    journal.write_text("\n".join(lines) + "\n", encoding="utf-8")
    found = list(run.made([known, left_out, new], journal, 1))
    assert found[0] == outcome(known, AGENTS)
    assert [each[:3] for each in found[1:]] == [("fake_battery", side, SEEDS[-1]) for side in PAIR]
    assert list(run.made([known, left_out, new], journal, 1)) == found


def test_sides_that_cannot_run_keep_their_recorded_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    machine = [outcome(Family("patrol", seed), "state machine") for seed in (1, 2, 3)]
    monkeypatch.setattr(run, "RECORD", tmp_path / "record.gz")
    monkeypatch.setattr(run, "can_run", lambda side: side != "state machine")
    record.write([*machine, outcome(Family("patrol", 1), AGENTS)], run.RECORD)
    new = [outcome(Family("patrol", 1), AGENTS), outcome(Family("patrol", 2), AGENTS, draw=1)]
    assert run.kept(new) == machine[:1]
    assert "state machine" in capsys.readouterr().out


def test_a_run_that_is_not_as_recorded_is_a_difference() -> None:
    one, other = outcome(PATROL, AGENTS), outcome(PATROL, BASELINE)
    assert run.differences([one, other], [other, one]) == []
    assert "not run" in run.differences([one, other], [one])[0]
    assert "recorded" in run.differences([one], [one._replace(end=SILENT)])[0]


# ---- real runs


def test_a_disturbance_is_felt_at_its_share_of_the_way() -> None:
    family = Family("square", next(each for each in range(1, 9) if kind_of("square", each) == "slip"))
    found = run_one(family, BASELINE, 0)
    assert found.effect is not None
    assert 0.0 < found.effect < found.seconds
    assert found.share > 0.0


@pytest.mark.slow
def test_a_tree_with_a_pause_outlasts_aborted_goals() -> None:
    seed = next(
        each
        for each in range(1, 99)
        if kind_of("patrol", each) == "aborted" and disturbance("patrol", each).dose > 10.0
    )
    family = Family("patrol", seed)
    assert run_one(family, BASELINE, 0).end == DONE
    assert run_one(family, "baseline without pause", 0).end == TOLD


@pytest.mark.slow
def test_a_missed_grasp_fetches_nothing() -> None:
    seed = next(each for each in range(3100, 3200) if kind_of("fetch", each) == "missed_grasp")
    found = run_one(Family("fetch", seed), AGENTS, 0)
    assert found.effect is not None
    assert found.end in (DONE, TOLD)
