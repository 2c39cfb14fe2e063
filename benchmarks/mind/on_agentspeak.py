"""Run a program on python-agentspeak and print what it cost, as JSON: seconds of processor time and peak memory.

    on_agentspeak.py NAME=FILE[#COUNT] ...

Runs in an environment of its own (tools/bench.sh makes it): the library is GPL and no part of JaCaROS.
"""

import json
import resource
import sys
import time
from typing import Any

import agentspeak
import agentspeak.runtime
import agentspeak.stdlib


class Stopped(BaseException):
    """The program called ``.stopMAS``."""


def actions() -> Any:
    """The standard actions, and ``.stopMAS``, which the library lacks."""
    table = agentspeak.Actions(agentspeak.stdlib.actions)

    @table.add(".stopMAS", 0)
    def stop(agent: Any, term: Any, intention: Any) -> Any:
        raise Stopped

    return table


def main(agents: list[str]) -> None:
    """Make the agents, then run them until one stops the system."""
    environment = agentspeak.runtime.Environment()
    table = actions()
    for declared in agents:
        name, _, file = declared.partition("=")
        file, _, count = file.partition("#")
        with open(file, encoding="utf-8") as source:
            if count:
                environment.build_agents(source, int(count), table)
            else:
                environment.build_agent(source, table, name=name)
    began = time.process_time()
    try:
        environment.run()
    except Stopped:
        pass
    else:
        sys.exit("the program ended without .stopMAS")
    seconds = time.process_time() - began
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"seconds": seconds, "megabytes": memory}))


if __name__ == "__main__":
    sys.setrecursionlimit(100_000)
    main(sys.argv[1:])
