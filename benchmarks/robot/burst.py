"""How long a safety plan waits when 10,000 percepts come at once and the bumper last, as JSON: without and with urgency."""

import json
import time
from typing import Any

from yardstick import call

from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import SOURCE_PERCEPT, atom, structure
from jacaros.testing import AgentHarness

PERCEPTS = 10_000
ROUNDS = 3

PROGRAM = """
+reading(Place, Value) : Value >= 0 <- ++seen(Place).
@bump[{urgency}] +bumped <- brake.
"""


def burst(urgency: str) -> dict[str, Any]:
    """One burst."""
    agent = AgentHarness(PROGRAM.format(urgency=urgency), actions={"brake": lambda: True})
    agent.run()
    annotations = annotation_set((SOURCE_PERCEPT,))
    percepts = [
        Percept("add", structure("reading", float(place), 1.0), annotations) for place in range(PERCEPTS)
    ]
    percepts.append(Percept("signal", atom("bumped"), annotations))
    began = time.process_time()
    agent.mind.perceive(percepts)
    cycles = 0
    while not agent.acts:
        agent.step(1)
        cycles += 1
    braked = time.process_time()
    low = len(agent.mind.beliefs[structure("seen", 1.0)[0]])
    while agent.step(1000):
        pass
    ended = time.process_time()
    handled = len(agent.mind.beliefs[structure("seen", 1.0)[0]])
    if handled != PERCEPTS:
        raise SystemExit(f"only {handled} percepts were handled")
    return {"cycles": cycles, "low": low, "time": (braked - began) * 1e6, "all": (ended - began) * 1e6}


def main() -> None:
    """Measure."""
    yardstick = call()
    ways = {"plain": "priority(10)", "urgent": "urgency(10)"}
    figures: dict[str, Any] = {"percepts": PERCEPTS, "call": yardstick}
    for _ in range(ROUNDS):
        for way, urgency in ways.items():
            found = burst(urgency)
            known = figures.setdefault(way, found)
            known["time"] = min(known["time"], found["time"])
            known["all"] = min(known["all"], found["all"])
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
