"""Launching a project in a process: clock, loop, signals, garbage collector."""

import asyncio
import gc
import sys
from collections.abc import Callable
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Any

from jacaros.clock import Clock, VirtualClock, WallClock, new_event_loop
from jacaros.mas.console import Console
from jacaros.mas.deployment import Deployment
from jacaros.mas.interruption import Interrupted, Interruption
from jacaros.mas.loading import load_deployment, mapped
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System
from jacaros.mas.watchdog import Watchdog

GARBAGE_THRESHOLD = 100_000
"""Terms are made and dropped by the million, mostly without cycles: looking for cycles more often costs a
tenth of the time and finds nothing."""

SWITCH_INTERVAL = 0.0005
"""Seconds for which a busy loop may keep the interpreter from a thread that has a message for it.

Python's own 5 ms are more than a message otherwise takes to become a command."""


def launch(
    project: str | Path | Deployment,
    options: RunOptions,
    console: Console,
    when_started: Callable[[System], None] | None = None,
    own_process: bool = True,
) -> int:
    """Run a project to its end; the exit code.

    Args:
        project: a project file, a lone program, or what one declares.
        options: how to run it.
        console: its outputs.
        when_started: called when everything has been made, before the first agent has its turn.
        own_process: settings of the whole process may be changed: signals, the garbage collector, the switches of threads.

    Raises:
        JacarosError: the project cannot be run; the text tells what is wrong.
        InternalError: a defect of JaCaROS showed itself.
    """
    options.check()
    if own_process:
        # Before the programs are read: their syntax trees are many objects that all stay.
        gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)
        sys.setswitchinterval(SWITCH_INTERVAL)
    deployment = mapped(
        project if isinstance(project, Deployment) else load_deployment(project), options.mappings
    )
    clock = _clock(options, console)

    async def main() -> int:
        mas = System(deployment, clock, console, options)
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: _escaped(mas, context))

        def started() -> None:
            if own_process:
                gc.freeze()
                watchdog.start()
            if when_started is not None:
                when_started(mas)

        if not own_process:
            return await mas.run(started)
        with interruption.of(mas.end):
            return await mas.run(started)

    def warn(text: str) -> None:
        console.log(text, "warning")

    interruption, watchdog = Interruption(warn), Watchdog(warn)
    with interruption.signals() if own_process else nullcontext():
        try:
            return interruption.run(partial(new_event_loop, clock), main())
        finally:
            watchdog.stop()


def _clock(options: RunOptions, console: Console) -> Clock:
    if options.ros_clock:
        from jacaros.ros.ros_clock import RosClock  # here: only for simulators on a real graph

        return RosClock(lambda text: console.log(f"[ros] {text}"))
    return VirtualClock() if options.fast else WallClock()


def _escaped(mas: System, context: dict[str, Any]) -> None:
    """Something raised an exception outside of anybody's care."""
    error = context.get("exception")
    if isinstance(error, Interrupted):
        return
    if isinstance(error, Exception) and "handle" in context:
        mas.fail(error)
        return
    mas.console.log(f"error: {context.get('message')}: {type(error).__name__}: {error}", "error")
