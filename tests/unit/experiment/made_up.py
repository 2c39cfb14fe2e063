"""Made-up outcomes, drawn from a seed: what agents and baselines would do in them says nothing about what they do."""

import random

from family import AGENTS, BASELINE
from record import Damage, Outcome
from response import DOSES

KINDS_OF = {
    "out_and_back": ("slip", "late", "lost", "carried"),
    "square": ("slip", "late", "lost", "carried"),
    "fake_battery": ("late", "lost"),
    "patrol": ("slip", "late", "lost", "carried", "battery", "aborted"),
    "house_cleaning": tuple(DOSES),
}
FEW = 50
OTHERS = {
    "recovery tree": 200,
    "state machine": 200,
    "agents that drive themselves": FEW,
    "agents without urgency": FEW,
    "agents without checks": FEW,
    "baseline without pause": FEW,
}
STRENGTH = {AGENTS: 0.85, BASELINE: 0.6}


def outcomes(seeds: int = 200, others: bool = True) -> list[Outcome]:
    """Return runs of all sides in all scenarios."""
    found = []
    for scenario, kinds in KINDS_OF.items():
        sides = {AGENTS: seeds, BASELINE: seeds}
        if others and scenario in ("patrol", "house_cleaning"):
            sides |= {side: min(number, seeds) for side, number in OTHERS.items()}
        for side, number in sides.items():
            for seed in range(2001, 2001 + number):
                found.append(outcome(scenario, side, seed, kinds[seed % len(kinds)]))
    return found


def outcome(scenario: str, side: str, seed: int, kind: str) -> Outcome:
    """Return a run; the draw of its dose is the same for all sides."""
    shared, own = random.Random(f"{scenario}/{seed}"), random.Random(f"{scenario}/{side}/{seed}")
    dose = DOSES.get(kind, DOSES["slip"])
    value = round(shared.uniform(dose.low, dose.high), 2)
    harm = (value - dose.low) / (dose.high - dose.low)
    end = "done"
    if own.random() > STRENGTH.get(side, 0.7) * (1.4 - harm):
        end = "told" if own.random() < STRENGTH.get(side, 0.5) else "silent"
    told = round(own.uniform(0, 30), 2) if end == "told" else None
    damage = Damage(own.randrange(3) if end != "done" else 0, own.random() < 0.02, int(own.random() < 0.03))
    return Outcome(
        *(scenario, side, seed, int(shared.random() < 0.1), kind, value, round(shared.uniform(0.05, 0.8), 3)),
        *(end, end == "silent" and own.random() < 0.3, round(own.uniform(20, 200), 2), 5.0, told),
        *(round(own.uniform(2, 30), 2), damage, "" if end == "done" else "made up"),
    )
