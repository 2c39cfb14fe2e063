"""A multi-agent system in a Python program: begin, end and clock."""

import asyncio
from collections.abc import Callable, Coroutine
from dataclasses import replace
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self, TypeVar

from jacaros.artifacts.kernel.faults import error_text
from jacaros.errors import UsageError
from jacaros.mas.console import StandardConsole, place_of_fault
from jacaros.mas.deployment import Deployment
from jacaros.mas.embedding.waits import RunEnded, Waits
from jacaros.mas.history.explanation import Explanation
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System
from jacaros.runtime.clock import Clock, VirtualClock, VirtualEventLoop, WallClock, clock_of, new_event_loop

if TYPE_CHECKING:
    from jacaros.mas.debugging.debugger import Debugger


class PrintedLine(NamedTuple):
    """A line of an agent's output.

    Attributes:
        agent: name of the agent.
        text: the line, without the name.
    """

    agent: str
    text: str

    def __str__(self) -> str:
        return f"[{self.agent}] {self.text}"


OnPrint = Callable[[str, str], None]
"""Called with the name of an agent and its output."""

OnLog = Callable[[str, str], None]
"""Called with a line of the log and its level: ``debug``, ``info``, ``warning`` or ``error``."""


class PrintedConsole:
    """The console of an embedded system.

    Args:
        on_print: prints the output of agents. Default: print ``[agent] text`` to standard output.
        on_log: logs lines. Default: standard error.
    """

    def __init__(self, on_print: OnPrint | None, on_log: OnLog | None) -> None:
        # Looks up the standard streams on each write: tests and notebooks replace them.
        self._standard = StandardConsole()
        self._on_print = on_print or self._standard.print
        self._on_log = on_log or self._standard.log
        self._listeners: list[OnPrint] = []

    def listen(self, callback: OnPrint) -> Callable[[], None]:
        """Also call *callback* with all output from now on. Return a function that ends this."""
        self._listeners.append(callback)
        return lambda: self._listeners.remove(callback) if callback in self._listeners else None

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output."""
        for callback in (self._on_print, *self._listeners):
            try:
                callback(agent, text)
            except Exception as error:
                self.log(
                    f"error: an on_print callback raised {error_text(error)}{place_of_fault(error)}",
                    "error",
                )

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        try:
            self._on_log(text, level)
        except Exception as error:
            self._standard.log(text, level)
            self._standard.log(
                f"error: an on_log callback raised {error_text(error)}{place_of_fault(error)}", "error"
            )

    def close(self) -> None:
        """Write what waits for a slow reader."""
        self._standard.close()


class EmbeddedRun:
    """The run of a system during a block of a Python program.

    Args:
        deployment: the system.
        options: run options. The clock is that of the event loop, or of the ROS graph.
        on_print: called with agent and text whenever an agent prints.
        on_log: called with text and level of each line of the log.

    Raises:
        UsageError: options exclude each other.
    """

    def __init__(
        self, deployment: Deployment, options: RunOptions, on_print: OnPrint | None, on_log: OnLog | None
    ) -> None:
        options.check()
        self._deployment = deployment
        self._options = options
        self._console = PrintedConsole(on_print, on_log)
        self._begun: tuple[System, Waits] | None = None
        self._stop_watching: Callable[[], None] = lambda: None
        self._at_end: list[Callable[[], None]] = []

    async def __aenter__(self) -> Self:
        """Create what the project declares, and start its agents.

        Raises:
            JacarosError: the system cannot start. The text says why.
        """
        if self._begun is not None:
            raise UsageError("this Mas has already run; create another one")
        loop = asyncio.get_running_loop()
        clock: Clock = clock_of(loop)
        options = replace(self._options, fast=clock.virtual)
        options.check()
        if options.ros_clock:
            from jacaros.ros.ros_clock import RosClock  # here: only for simulators on a real graph

            clock = RosClock(lambda text: self._console.log(f"[ros] {text}"))
        system = System(self._deployment, clock, self._console, options)
        waits = Waits(clock)
        self._begun = system, waits
        system.lifecycle.when_ended = waits.agent_ended
        try:
            await system.start()
        except BaseException:
            await system.close()
            waits.run_ended("the run could not be started")
            raise
        system.when_ended(lambda code: waits.run_ended(f"the run ended with exit code {code}"))
        if isinstance(loop, VirtualEventLoop):
            self._stop_watching = loop.when_stuck(waits.stuck)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        system, waits = self._running
        self._stop_watching()
        waits.run_ended("the run has ended")
        for close in self._at_end:
            close()
        system.end(0)
        try:
            await system.close()
        finally:
            self._console.close()
        if system.error is not None and (error is None or isinstance(error, RunEnded)):
            raise system.error

    @property
    def _running(self) -> tuple[System, Waits]:
        if self._begun is None:
            raise RunEnded("the system is not running: use it inside `async with Mas(...) as mas:`")
        self._begun[1].check_thread()
        return self._begun

    @property
    def system(self) -> System:
        """The run itself, for what this class does not offer. Its interface may change with every version.

        Raises:
            RunEnded: the run has not begun.
        """
        return self._running[0]

    def explain(
        self, question: str, at: float | None = None, agent: str = "", robot: str = ""
    ) -> Explanation:
        """Answer a question about the run, such as ``stopped``, ``+alarm(_)`` or ``plan @low``.

        The history begins with the first question, or with the run if the option ``explain`` is set or a program
        mentions ``.why``.

        Args:
            question: as for `jacaros why`.
            at: seconds since the history began. Default: now.
            agent, robot: restrict the answer to this agent or robot.

        Raises:
            UsageError: the question is not understood.
            RunEnded: the run has not begun.
        """
        return self._running[0].answer(question, at, agent, robot)

    @property
    def _open(self) -> System:
        """The running system.

        Raises:
            RunEnded: it is not running.
        """
        system, _ = self._running
        if system.exit_code is not None:
            raise RunEnded("the run has ended")
        return system

    def stop(self, exit_code: int = 0) -> None:
        """End the run, as ``.stopMAS`` does. The block continues, but no agent has another turn."""
        self._running[0].end(exit_code)

    async def ended(self) -> int:
        """Wait until the run ends (by ``.stopMAS`` or `stop`). Return its exit code.

        Raises:
            InternalError: a defect of JaCaROS ended it.
        """
        system, _ = self._running
        code = await system.ended()
        if system.error is not None:
            raise system.error
        return code

    @property
    def exit_code(self) -> int | None:
        """The exit code of the run; None while it is running."""
        return self._begun[0].exit_code if self._begun is not None else None

    async def until_idle(self, timeout: float | None = None) -> None:
        """Wait until all agents are idle and no operation is running.

        Worlds, batteries and processes of artifacts do not count: they never end.

        Args:
            timeout: time limit in seconds of the run's clock. None: no limit.

        Raises:
            TimeoutError: agents were still busy after the time limit.
            RunEnded: the run ended first.
        """
        system, waits = self._running
        idle: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        stop = system.idleness.watch(lambda: None if idle.done() else idle.set_result(None))
        if system.scheduler.idle:
            system.idleness.look()
        try:
            await waits.wait(idle, lambda: "the agents did not become idle", timeout)
        finally:
            stop()

    # ---- debugging

    @property
    def debugger(self) -> "Debugger":
        """Pauses and steps the run, and sets breakpoints."""
        return self._open.debugger

    def reload(self) -> list[str]:
        """Read changed programs again, and replace plans and rules. See `jacaros.mas.debugging.Debugger.reload`.

        Raises:
            AslError: a program has errors; nothing has been replaced.
        """
        return self._open.debugger.reload()

    # ---- time

    @property
    def clock(self) -> Clock:
        """The run's clock: that of the event loop, or of the ROS graph (``ros_clock``)."""
        return self._running[0].clock

    async def sleep(self, seconds: float) -> None:
        """Wait for this number of seconds of the run's clock."""
        await self.clock.sleep(seconds)

    def __repr__(self) -> str:
        if self._begun is None:
            return f"<Mas {self._deployment.name}, not begun>"
        code = self.exit_code
        how = "running" if code is None else f"ended with exit code {code}"
        return f"<Mas {self._deployment.name}, {how}>"


T = TypeVar("T")


def run(main: Coroutine[Any, Any, T], *, clock: Literal["real", "fast"] = "real") -> T:
    """Run a coroutine to its end, as `asyncio.run` does, on an event loop with its own clock. Return its result.

    Args:
        main: the coroutine, such as ``main()``.
        clock: ``real`` for real time; ``fast`` for the virtual clock, which jumps to the next timer as soon as all tasks
            wait. Then ``asyncio.sleep`` and time limits take no real time either.

    Raises:
        UsageError: an event loop is already running, as in a notebook (``await`` the coroutine there); or the clock is
            unknown.
    """
    chosen: Clock
    try:
        if clock not in ("real", "fast"):
            raise UsageError(f"unknown clock `{clock}`; expected `real` or `fast`")
        if _is_running():
            raise UsageError(
                "an event loop is already running (a notebook?); await the coroutine instead of calling jacaros.run"
            )
    except UsageError:
        main.close()
        raise
    chosen = VirtualClock() if clock == "fast" else WallClock()
    with asyncio.Runner(loop_factory=partial(new_event_loop, chosen)) as runner:
        return runner.run(main)


def _is_running() -> bool:
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True
