"""Run baselines on the virtual clock, as fast as the machine.

python experiment/virtual_run.py patrol --seed 3 --faults faults.yaml
"""

import argparse
import asyncio
import sys
import traceback
import types
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from beside import importing_beside
from jacaros.robots.world import World
from jacaros.robots.world.node import SimNode
from jacaros.runtime.clock import VirtualClock, new_event_loop
from jacaros.runtime.errors import JacarosError
from jacaros.testing import RunResult
from scenarios import SCENARIOS, Scenario
from virtual_rclpy.graph import TimeIsUp, VirtualGraph, being_current
from virtual_rclpy.installed import installed

LONGEST = 3000.0
"""Seconds of the virtual clock after which a program that has not ended is ended."""

COASTING = 1.0
"""Seconds that the world continues when the program has ended: without commands a robot stops in half a second."""


def run_baseline(
    name: str | Scenario,
    world: str | Path | None = None,
    seconds: float = LONGEST,
    seed: int = 0,
    faults: str | Path | None = None,
    parameters: Mapping[str, Any] | None = None,
) -> RunResult:
    """Run a baseline, as `jacaros.testing.run_project` runs the agents of a project; the same arguments give the same run.

    Args:
        name: of the scenario, see `SCENARIOS`; or a scenario.
        world: world file, name or text in place of the scenario's.
        seconds: of the virtual clock, after which a program that has not ended is ended.
        seed: of the world.
        faults: fault file, or its text.
        parameters: of the node, in place of the scenario's.

    Returns:
        The outcome. ``lines`` has what the node logged, ``errors`` what the graph logged and the traceback of a program
        that failed, ``seconds`` the time when the program ended.

    Raises:
        KeyError: unknown scenario.
        WorldError: the world or the fault file is wrong.
    """
    scenario = SCENARIOS[name] if isinstance(name, str) else name
    made = World.load(scenario.world if world is None else world, seed, faults)
    made.ground_truth.keep = None
    clock = VirtualClock()
    result = RunResult(now=lambda: clock.elapsed)
    with asyncio.Runner(loop_factory=partial(new_event_loop, clock)) as runner:
        given = scenario.parameters if parameters is None else parameters
        graph = VirtualGraph(clock, runner.get_loop(), given, result.print, result.log)
        node = SimNode(made, graph.node("world"), clock)
        runner.run(_begin(node))
        clock.call_later(seconds, graph.end_program)
        result.exit_code = _run_program(scenario.baseline, graph, result)
        result.seconds = clock.elapsed
        runner.run(_finish(node, graph))
    result.ground_truth = made.ground_truth
    return result


async def _begin(node: SimNode) -> None:
    node.start()


async def _finish(node: SimNode, graph: VirtualGraph) -> None:
    await graph.clock.sleep(COASTING)
    node.close()
    await graph.close()


def _run_program(program: Path, graph: VirtualGraph, result: RunResult) -> int:
    """Run a file as ``python FILE`` does, and return its exit code."""
    _forget_blackboard()
    try:
        with being_current(graph), installed(), importing_beside(program):
            _execute(program)
    except TimeIsUp:
        pass
    except SystemExit as end:
        return int(end.code or 0)
    except Exception:
        result.errors.append(traceback.format_exc())
        return 1
    return 0


def _execute(program: Path) -> None:
    """Execute a file as the module ``__main__``.

    Not by `runpy`, whose frames have no file: a library that inspects the stack for each line that it logs looks for
    their source in all modules, and YASMIN spent nine tenths of its time on that.
    """
    module, before = types.ModuleType("__main__"), sys.modules["__main__"]
    module.__file__ = str(program)
    sys.modules["__main__"] = module
    try:
        exec(compile(program.read_bytes(), str(program), "exec"), vars(module))
    finally:
        sys.modules["__main__"] = before


def _forget_blackboard() -> None:
    """Clear the blackboard of the run before: py_trees has one for the process."""
    from py_trees.blackboard import Blackboard  # here: not every environment that has tests has py_trees

    Blackboard.clear()


def main() -> int:
    """Run what the command line names; the exit code is 0 if the run passes its checker."""
    parser = argparse.ArgumentParser(description="Run a baseline on the virtual clock, and judge the run.")
    parser.add_argument("scenario", choices=SCENARIOS)
    parser.add_argument("--world", help="world file or name, in place of the scenario's")
    parser.add_argument(
        "--for", dest="seconds", type=float, default=LONGEST, help="end after so many seconds"
    )
    parser.add_argument("--seed", type=int, default=0, help="seed of the world")
    parser.add_argument("--faults", help="fault file")
    given = parser.parse_args()
    try:
        result = run_baseline(given.scenario, given.world, given.seconds, given.seed, given.faults)
    except JacarosError as problem:
        print(problem, file=sys.stderr)
        return 1
    print(*result.lines, *result.errors, sep="\n")
    verdict = SCENARIOS[given.scenario].judge(result)
    print(f"{result.seconds:.1f} seconds, exit code {result.exit_code}", *verdict.lines(), sep="\n")
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main())
