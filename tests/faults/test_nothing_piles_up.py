"""A long run: repeated work leaves nothing behind."""

import asyncio
import gc
from collections import Counter
from typing import Any

from faults_lab import Lab, in_lab

NOTES = {"PathSample", "Moment"}
"""Records of the laboratory and the world, which are kept for later analysis."""


def kinds() -> Counter[str]:
    """How many objects of each class of ours there are."""
    gc.collect()
    found = Counter(
        f"{type(each).__module__}.{type(each).__qualname__}"
        for each in gc.get_objects()
        if str(type(each).__module__).startswith("jacaros") and type(each).__name__ not in NOTES
    )
    for name in ("Task", "Future", "TimerHandle"):
        found[name] = sum(type(each).__name__ == name for each in gc.get_objects())
    return found


def test_finished_goals_calls_motions_and_artifacts_use_no_memory() -> None:
    looks: list[Counter[str]] = []
    registries: list[dict[str, int]] = []

    def look(lab: Lab) -> None:
        looks.append(kinds())
        node: Any = lab.graph.find("node", "/agents")
        registries.append(
            {
                "members": len(node.members),
                "exit hooks": len(node.lifetime._hooks),
                "timers": len(lab.clock._timers),
                "tasks": len(asyncio.all_tasks()),
            }
        )

    def faults(lab: Lab) -> None:
        for minutes in (1, 4):
            lab.at(60 * minutes, lambda: look(lab))

    lab = in_lab("all_day.asl", faults, mapping="nav2.yaml", seconds=241)
    assert lab.truth.odometer() > 30, "it was at it all the time"
    assert [line for line in lab.errors if "failed" in line] == []
    before, after = looks
    grown = {kind: (before[kind], many) for kind, many in after.items() if many > before[kind] + 20}
    assert grown == {}
    for registry in registries:
        # A guest more or less at the moment of the look.
        assert registry["members"] < 40
        assert registry["exit hooks"] < 12
        assert registry["timers"] < 60
        assert registry["tasks"] < 15
