"""An agent on the graph inside the process, and nodes beside it."""

import gc
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.mas.console import StandardConsole
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

WORLD = "name: no_robots\nrobots:\n  - {name: elsewhere, namespace: elsewhere}\n"
"""A world whose robot keeps out of the way: its topics are those of another namespace."""

SETTLED = 0.5
"""Seconds after which the agent has made and focused its artifacts."""


def run(program: str, begin: Callable[[System], None], artifacts: str = "", fast: bool = True) -> None:
    """Run an agent; *begin* is called when it has settled, and ends the run."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "agent.asl"
        source.write_text(program, encoding="utf-8")
        (Path(folder) / "artifacts.py").write_text(artifacts, encoding="utf-8")
        world = Path(folder) / "no_robots.yaml"
        world.write_text(WORLD, encoding="utf-8")

        def started(mas: System) -> None:
            gc.freeze()
            mas.clock.call_later(SETTLED, lambda: begin(mas))

        launch(source, RunOptions(fast=fast, world=world), StandardConsole("error"), started)


def node(mas: System, name: str) -> Backend:
    """A node of the run's graph."""
    graph: Any = mas.ros.backend()
    made = open_backend("memory", mas.clock, name, graph=graph.graph)
    try:
        made.start().send(None)
    except StopIteration:
        return made
    raise RuntimeError("the graph inside the process waits for nothing")
