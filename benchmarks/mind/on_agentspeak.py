"""Run a program on python-agentspeak and print what it cost, as JSON (see `marks.Marks.report`).

    on_agentspeak.py NAME=FILE[#COUNT] ...

Runs in a separate environment (created by ``make bench``), because the library is GPL and not part of JaCaROS.
"""

import json
import sys
from typing import Any

import agentspeak
import agentspeak.runtime
import agentspeak.stdlib
from marks import Marks


class Stopped(BaseException):
    """The program called ``.stopMAS``."""


def actions(marks: Marks) -> Any:
    """The standard actions, with a ``.print`` that takes the time and ``.stopMAS``, which the library lacks."""
    table = agentspeak.Actions(agentspeak.stdlib.actions)

    @table.add(".stopMAS", 0)
    def stop(agent: Any, term: Any, intention: Any) -> Any:
        raise Stopped

    @table.add(".print")
    def mark(agent: Any, term: Any, intention: Any) -> Any:
        values = [agentspeak.freeze(each, intention.scope, {}) for each in term.args]
        marks.take("".join(map(agentspeak.asl_str, values)))
        yield

    return table


class Environment(agentspeak.runtime.Environment):
    """Name agents directly: the library tries all numbers, which takes minutes for 10,000 agents and is not the work."""

    def _make_name(self, path: str) -> str:
        return path if path not in self.agents else f"{path}{len(self.agents)}"


def main(agents: list[str]) -> None:
    """Make the agents, then run them until one stops the system."""
    environment = Environment()
    marks = Marks()
    table = actions(marks)
    for declared in agents:
        name, _, file = declared.partition("=")
        file, _, count = file.partition("#")
        with open(file, encoding="utf-8") as source:
            if count:
                environment.build_agents(source, int(count), table, name=name)
            else:
                environment.build_agent(source, table, name=name)
    try:
        environment.run()
    except Stopped:
        print(json.dumps(marks.report()))
    else:
        sys.exit("the program ended without .stopMAS")


if __name__ == "__main__":
    sys.setrecursionlimit(100_000)
    main(sys.argv[1:])
