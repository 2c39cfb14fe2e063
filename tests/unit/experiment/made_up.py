"""Made-up outcomes, drawn from a seed: what agents and baselines would do in them says nothing about what they do."""

import random

from disturbances import SEEDS, disturbance, kind_of
from family import AGENTS, BASELINE
from outcomes import Damage
from record import Outcome
from response import DOSES
from scenarios import SCENARIOS
from sides import OVER_NAV2

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
    for scenario in SCENARIOS:
        sides = {AGENTS: seeds, BASELINE: seeds}
        if others and scenario in OVER_NAV2:
            sides |= {side: min(number, seeds) for side, number in OTHERS.items()}
        found += [outcome(scenario, side, seed) for side in sides for seed in SEEDS[: sides[side]]]
    return found


def outcome(scenario: str, side: str, seed: int) -> Outcome:
    """Return a run; its disturbance is the same for all sides."""
    own = random.Random(f"{scenario}/{side}/{seed}")
    drawn, dose = disturbance(scenario, seed), DOSES[kind_of(scenario, seed)]
    harm = (drawn.dose - dose.low) / (dose.high - dose.low)
    end = "done"
    if own.random() > STRENGTH.get(side, 0.7) * (1.4 - harm):
        end = "told" if own.random() < STRENGTH.get(side, 0.5) else "silent"
    told = round(own.uniform(0, 30), 2) if end == "told" else None
    damage = Damage(own.randrange(3) if end != "done" else 0, own.random() < 0.02, int(own.random() < 0.03))
    return Outcome(
        *(scenario, side, seed, int(seed % 10 == 0), *drawn[:3], end, end == "silent" and own.random() < 0.3),
        *(round(own.uniform(20, 200), 2), 5.0, told, round(own.uniform(2, 30), 2), damage),
        "" if end == "done" else "made up",
    )
