"""The disturbances of the experiment: fault files that fit their worlds, the same for the same seed."""

import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.sim.faults.file import read_faults
from jacaros.sim.files.world import load_world

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from disturbances import KINDS, faults_for, kind_of, kinds_for
from disturbed_runs import world_of
from scenarios import SCENARIOS


@pytest.mark.parametrize("name", SCENARIOS)
def test_all_faults_fit_the_world(name: str, tmp_path: Path) -> None:
    description = load_world(world_of(name, tmp_path))
    for seed in range(50):
        assert read_faults(faults_for(name, seed), description)


def test_every_kind_occurs_and_takes_its_turn() -> None:
    assert {kind for name in SCENARIOS for kind in kinds_for(name)} == set(KINDS)
    for name in SCENARIOS:
        kinds = kinds_for(name)
        assert [kind_of(name, seed) for seed in range(len(kinds))] == kinds


def test_a_seed_gives_the_same_faults_and_another_seed_others() -> None:
    texts = [faults_for("patrol", seed) for seed in range(50)]
    assert texts == [faults_for("patrol", seed) for seed in range(50)]
    assert len(set(texts)) > 40
