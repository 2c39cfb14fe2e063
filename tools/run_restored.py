"""Run a project like `jacaros run`, but store each mind as JSON at random cycles and continue with a restored one.

run_restored.py PROJECT [--clock fast] …     options of `jacaros run`; JACAROS_RESTORED_SEED sets the seed

The new mind has plans of its own, so nothing that the old one compiled helps it.  A mind that cannot be stored continues as
it is; why is written to the file that the variable JACAROS_NOT_RESTORED names.
"""

import json
import os
import sys
from functools import partial
from random import Random
from typing import Any

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.storage import NotStorable, restore, stored
from jacaros.runtime.cli.main import main
from jacaros.runtime.mas.agents.host import AgentHost

CHANCE = 0.2
"""Probability of restoring a mind after a few cycles."""
FEW = 6
random = Random(os.environ.get("JACAROS_RESTORED_SEED", "1"))
reported: set[str] = set()


def run(host: AgentHost, fuel: int) -> bool:
    """A turn, in pieces."""
    while fuel > 0:
        cycles = min(fuel, random.randint(1, FEW))
        fuel -= cycles
        mind = host.mind
        assert isinstance(mind, Mind)
        more = mind.run(cycles)
        if not mind.stopped and random.random() < CHANCE:
            exchange(host, mind)
        if not more:
            return False
    return True


def exchange(host: AgentHost, old: Mind) -> None:
    """Store a mind, and continue with the one restored from it."""
    try:
        text = json.dumps(stored(old))
    except NotStorable as why:
        if str(why) not in reported and "JACAROS_NOT_RESTORED" in os.environ:
            reported.add(str(why))
            with open(os.environ["JACAROS_NOT_RESTORED"], "a", encoding="utf-8") as report:
                report.write(f"{old.name}: {why}\n")
        return
    for alarm in old.waits.alarms.values():
        alarm.timer.cancel()
    new = Mind(old.name, old.program, host, old.options, old.engine.actions)
    new.observers, new.functions.project = old.observers, old.functions.project  # given by the host
    host.set_mind(new)
    restore(new, json.loads(text), same_host=True)


def host_mind(host: AgentHost, mind: object) -> None:
    """Restore a mind from time to time."""
    HOSTED.fset(host, mind)
    if type(mind) is Mind:
        host.run = partial(run, host)


HOSTED: Any = AgentHost.mind
RESTORING: Any = property(HOSTED.fget, host_mind)
"""Replaces `AgentHost.mind`."""

if __name__ == "__main__":
    AgentHost.mind = RESTORING  # type: ignore[method-assign]
    sys.argv[1:1] = ["run"]
    main()
