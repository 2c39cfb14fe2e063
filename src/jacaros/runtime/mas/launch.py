"""Load a project, and launch it in a process: clock, event loop, signals, garbage collector.

Ctrl+C, SIGTERM, SIGHUP and, on Windows, SIGBREAK (Ctrl+Break) end a run in any state. `jacaros.robots.ros.lifetime` handles
the signals: it stops the robots and then calls this module. The event loop handles a signal between two callbacks. A
step that never ends blocks it; then the signal is raised in the middle of the step.
"""

import asyncio
import gc
import sys
import warnings
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.robots.ros import lifetime
from jacaros.runtime.alarm import Alarm
from jacaros.runtime.clock import Clock, VirtualClock, WallClock, new_event_loop
from jacaros.runtime.files.texts import is_file
from jacaros.runtime.mas.agents.programs import PROJECTS, source_folders
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, FocusSpec, ProjectError
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import Join, System
from jacaros.runtime.mas.watchdog import Watchdog

GARBAGE_THRESHOLD = 100_000
"""Programs create and drop millions of terms, mostly without cycles. More frequent garbage collection costs 10 % of the
time and finds nothing.
"""

SWITCH_INTERVAL = 0.0005
"""Seconds for which a busy event loop may keep the interpreter from a thread that has a message for it.

Python's default of 5 ms is longer than a message otherwise takes to become a command.
"""


def load_deployment(path: str | Path) -> Deployment:
    """Return what the project file *path* declares. A lone `.asl` or `.py` file is a system of one agent with its name.

    Raises:
        ProjectError: all errors of the file, including missing programs of agents.
    """
    path = Path(path)
    if path.suffix in (".asl", ".py"):
        return _lone_agent(path)
    if path.suffix not in PROJECTS:
        raise ProjectError(
            [Diagnostic("error", f"unsupported file type: {path} (expected .mas2j, .jcm, .asl or .py)")]
        )
    from jacaros.runtime.mas.project.reading import (
        read_project,  # here: a lone program starts sooner without it
    )

    deployment = read_project(path).deployment
    if any(diagnostic.severity == "error" for diagnostic in deployment.ignored):
        raise ProjectError(deployment.ignored)
    return deployment


def mapped(deployment: Deployment, names: Sequence[str | Path]) -> Deployment:
    """Return the deployment with the artifacts of mapping files. A lone program focuses all of them.

    Raises:
        ProjectError: all errors in the files.
    """
    if not names:
        return deployment
    from jacaros.runtime.mas.mappings import with_mappings  # here: most runs have none

    return with_mappings(deployment, tuple(map(str, names)))


def in_fleet(deployment: Deployment) -> Deployment:
    """Return the deployment of a member of a fleet: a lone program perceives the other members without asking."""
    agents = deployment.agents
    if len(agents) != 1 or agents[0].span is not None:
        return deployment
    focus = (*agents[0].focus, FocusSpec("fleet", "main"))
    return replace(deployment, agents=(replace(agents[0], focus=focus),))


def _lone_agent(path: Path) -> Deployment:
    if not is_file(path):
        raise ProjectError([Diagnostic("error", f"file not found: {path}")])
    agent = AgentSpec(path.stem, path, path.stem)
    base = path.parent
    return Deployment(path.stem, base, (agent,), artifact_environment=True, source_paths=source_folders(base))


def launch(
    project: str | Path | Deployment,
    options: RunOptions,
    console: RunConsole,
    when_started: Callable[[System], None] | None = None,
    own_process: bool = True,
    join: Join | None = None,
) -> int:
    """Run a project to its end. Return the exit code.

    Args:
        project: a project file, a lone program, or a deployment.
        options: run options.
        console: its outputs.
        when_started: called when everything has been created, before the first agent has its turn.
        join: joins a fleet.
        own_process: whether settings of the whole process may be changed: signals, garbage collector, thread switches.

    Raises:
        JacarosError: the project cannot run. The text says why.
        InternalError: a defect of JaCaROS.
    """
    options.check()
    if own_process:
        # Before the programs are read: their syntax trees are many long-lived objects.
        gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)
        sys.setswitchinterval(SWITCH_INTERVAL)
    deployment = mapped(
        project if isinstance(project, Deployment) else load_deployment(project), options.mappings
    )
    if join is not None:
        deployment = in_fleet(deployment)
    clock = chosen_clock(options, console)

    async def main() -> int:
        mas = System(deployment, clock, console, options, join=join)
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


def chosen_clock(options: RunOptions, console: RunConsole, other: Clock | None = None) -> Clock:
    """Return the clock that the options ask for: that of the ROS graph, or else *other*, or a new one."""
    if options.ros_clock:
        from jacaros.robots.ros.ros_clock import RosClock  # here: only for simulators on a real graph

        return RosClock(lambda text: console.log(f"[ros] {text}"))
    return other or (VirtualClock() if options.fast else WallClock())


def _escaped(mas: System, context: dict[str, Any]) -> None:
    """Handle an exception that no caller can catch."""
    error = context.get("exception")
    if isinstance(error, Interrupted):
        return
    if isinstance(error, Exception) and "handle" in context:
        mas.fail(error)
        return
    mas.console.log(f"error: {context.get('message')}: {type(error).__name__}: {error}", "error")


PATIENCE = 0.3
"""Seconds that the event loop has to handle a signal."""
CLOSING = 5.0
"""Seconds until everything is closed."""
THREADS = 1.0
"""Seconds in which threads of operations must end after everything else is closed."""
AGAIN = 2.0
"""Seconds after which an `Interrupted` that was swallowed is raised again."""


class Interrupted(KeyboardInterrupt):
    """Raised in the middle of a step, or of other code that blocks the event loop.

    It is a `KeyboardInterrupt`, because asyncio lets only that and `SystemExit` end a loop. What is open on the loop is
    closed afterwards.
    """


class Interruption:
    """How signals end a run.

    The first signal ends the run in order as soon as the event loop has a turn, and by force after `PATIENCE`. Another
    one ends it immediately.

    Args:
        tell: takes a line of the log.

    Attributes:
        exit_code: 128 plus the number of the signal; 0 without one.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self.exit_code = 0
        self._tell = tell
        self._told = False
        self._ending = self._over = False
        self._end: Callable[[], object] | None = None
        self._alarm = Alarm(self._interrupt)

    def run(self, make_loop: Callable[[], asyncio.AbstractEventLoop], main: Coroutine[Any, Any, int]) -> int:
        """Run *main*, which sets by `of` what signals end, on a new event loop. Return the exit code."""
        try:
            with asyncio.Runner(loop_factory=make_loop) as runner:
                try:
                    return runner.run(main)
                except Interrupted:
                    # The runner closes what is open on the loop.
                    self._alarm.set(THREADS if self._ending else CLOSING, AGAIN)
                    return self.exit_code
        except Interrupted:
            return self.exit_code
        finally:
            self._over = True
            self._alarm.cancel()

    def signals(self) -> AbstractContextManager[None]:
        """Let signals end the run. Enter it on the main thread, around `run`."""
        return lifetime.serving(self._notice)

    @contextmanager
    def of(self, end: Callable[[int], None]) -> Iterator[None]:
        """Let signals call *end* with an exit code, on the running event loop."""
        loop = asyncio.get_running_loop()

        def serve() -> None:
            self._ending = True
            self._alarm.set(CLOSING, AGAIN)
            end(self.exit_code)

        self._end = partial(loop.call_soon_threadsafe, serve)
        try:
            yield
        finally:
            if self.exit_code:
                self._alarm.set(THREADS, AGAIN)

    def _notice(self, number: int, frame: FrameType | None) -> None:
        if self._over:
            return  # nothing is left to interrupt
        again, self.exit_code = self.exit_code != 0, 128 + number
        if again or self._end is None:
            self._interrupt(number, frame)
        self._end()
        self._alarm.set(PATIENCE, AGAIN)

    def _interrupt(self, number: int, frame: FrameType | None) -> NoReturn:
        del number
        if not self._told:
            from jacaros.runtime.mas.watchdog import (  # here: most runs end without it
                current_step,
                is_of_user,
                task_of,
            )

            self._told = True
            if task_of(frame) is not None:
                if is_of_user(frame):  # a second Ctrl+C, or a busy machine: the run itself is at work
                    self._tell(f"interrupted in the middle of a step: {current_step(frame)}")
            elif self._ending:  # otherwise an import was interrupted, as at the start: nothing is abandoned
                self._tell("the run has ended; abandoning an operation that did not stop")
        # The exception may occur between the creation of a coroutine and its first step. The process ends anyway.
        warnings.filterwarnings("ignore", "coroutine .* was never awaited", RuntimeWarning)
        raise Interrupted
