"""Run tests: each in a separate system, or all tests of a file in one."""

import asyncio
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from types import FrameType
from typing import Any, NoReturn

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import FailureReason, details
from jacaros.agents.mind.rules.goals import WatchedGoal
from jacaros.agents.mind.state.intention import PLAN, STEP, Intention
from jacaros.agents.mind.state.pending import is_action
from jacaros.agents.terms.text import text
from jacaros.runtime.alarm import Alarm
from jacaros.runtime.clock import Clock, VirtualClock, WallClock, run
from jacaros.runtime.errors import InternalError, JacarosError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import Deployment, ProjectError
from jacaros.runtime.mas.launch import mapped
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import NO_WORLD
from jacaros.runtime.mas.system import System
from jacaros.testing.assertions import Assertion, Fakes, Probe, actions
from jacaros.testing.suites import AgentTest, FailureReport, Outcome, Suite, with_assertions

LINGER_SECONDS = 1.0
LINGER_CYCLES = 10_000
"""Seconds for which a run may continue after the goal of a test is achieved, until all agents are idle: assertions of goals
posted with ``!!`` count, too."""


@dataclass(frozen=True, slots=True)
class TrialOptions(RunOptions):
    """Options of a test run: those of `RunOptions` (default: virtual clock, seed 0), and the following.

    Attributes:
        timeout: seconds of the run's clock after which a test fails, unless its label sets another limit.
        cycles: reasoning cycles of all agents together after which a test fails.
        patience: seconds of real time after which a test fails; 0 for no limit. Works only in the main thread, on POSIX
            systems.
    """

    fast: bool = True
    seed: int | None = 0
    timeout: float = 60.0
    cycles: int = 1_000_000
    patience: float = 300.0


def run_suite(
    suite: Suite,
    options: TrialOptions | None = None,
    chosen: Callable[[AgentTest], bool] = lambda test: True,
) -> Iterator[Outcome]:
    """Run the tests of a file; yield each outcome as soon as it is known.

    Raises:
        UsageError: the options cannot be combined.
        InternalError: JaCaROS has a defect.
    """
    options = options or TrialOptions()
    options.check()
    for test in filter(chosen, suite.tests if suite.error is None else ()):
        try:
            yield Trial(suite, test, options).run()
        except ProjectError as wrong:
            problem = FailureReport("invalid mapping file", tuple(str(wrong).splitlines()), test.span)
            yield Outcome(test, [problem])


class TookTooLong(BaseException):
    """Raised when a test exceeds its real time; a BaseException, because an exception would only fail the current step."""


class Trial:
    """A run of one system for one test."""

    def __init__(self, suite: Suite, test: AgentTest, options: TrialOptions) -> None:
        assert suite.deployment is not None
        self._warnings = frozenset(suite.warnings)
        self._options = options
        self._outcome = Outcome(test)
        self._goal: WatchedGoal | None = None
        self._done = False
        self._lingers = False
        self._cycles = 0
        self._began = self._began_run = 0.0
        self._probes: dict[str, Probe] = {}
        self._actions = actions(self._probes)
        self._clock: Clock = VirtualClock() if options.fast else WallClock()
        self._move, self._clock.busy = self._clock.busy, self._busy  # type: ignore[method-assign]
        self._mappings = tuple(dict.fromkeys((*options.mappings, *test.mappings)))
        self._mas = self._system(suite.deployment)

    def _system(self, deployment: Deployment) -> System:
        """Create the system with the artifacts of the mapping files, in a graph without a robot unless a world is named."""
        options, world = self._options, self._options.world
        if self._mappings and world is None and deployment.world is None:
            world = NO_WORLD
        return System(
            mapped(deployment, self._mappings),
            self._clock,
            self,
            replace(options, world=world),
            self._prepare,
            self._observe,
            self._idle,
        )

    def _prepare(self, program: nodes.Program, code: PythonCode) -> nodes.Program:
        """Add the assertion goals to a program, and the actions behind them, which report to this test."""
        code.actions.update(self._actions)
        return with_assertions(program)

    def run(self) -> Outcome:
        """Run the test.

        Raises:
            InternalError: JaCaROS has a defect.
        """
        try:
            with _patience(self._options.patience):
                run(self._main, self._clock)
        except TookTooLong:
            self._hangs()
        except InternalError:
            raise
        except JacarosError as wrong:
            self._end_run(FailureReport("cannot start the system", tuple(str(wrong).splitlines())))
        self._end_run(FailureReport("the program ended the run (.stopMAS) before the test ended"))
        return self._outcome

    async def _main(self) -> None:
        asyncio.get_running_loop().set_exception_handler(self._escaped)
        await self._mas.run(self._start)

    def _start(self) -> None:
        test = self._outcome.test
        self._began, self._began_run = time.perf_counter(), self._clock.now()
        limit = test.timeout if test.timeout is not None else self._options.timeout
        self._clock.call_later(limit, lambda: self._timed_out(limit))
        host = self._mas.directory.find(test.agent)
        if host is None or not isinstance(host.mind, Mind):
            message = f"the test was not started: agent {test.agent} no longer exists"
            self._fail(FailureReport(message, (), test.span))
            return
        self._goal = WatchedGoal(host.mind, lower_value(test.goal), self._goal_ended)

    def _goal_ended(self) -> None:
        assert self._goal is not None
        if self._goal.failed:
            self._fail(_failure(self._outcome.test, self._goal.reason))
            return
        self._lingers = True
        self._cycles = 0
        self._clock.call_later(LINGER_SECONDS, self._finish)

    def _finish(self) -> None:
        """End the test, unless it has ended."""
        if self._done:
            return
        self._note_times()
        self._done = True
        self._mas.end(0)

    def _note_times(self) -> None:
        self._outcome.seconds = time.perf_counter() - self._began
        self._outcome.simulated = self._clock.now() - self._began_run

    def _fail(self, problem: FailureReport) -> None:
        self._outcome.problems.append(problem)
        self._finish()

    def _end_run(self, problem: FailureReport) -> None:
        """Handle an early end of the run."""
        if self._done:
            return
        self._done = True
        if not self._lingers:
            self._outcome.problems.append(problem)
        if self._began:
            self._note_times()

    # ---- limits

    def _timed_out(self, limit: float) -> None:
        if self._lingers:
            self._finish()
        elif not self._done:
            self._give_up(f"the test did not end within {limit:g} s of the run's clock")

    def _busy(self, cycles: int) -> None:
        """Count reasoning cycles that agents report to the clock."""
        self._move(cycles)
        self._cycles += cycles
        if self._done or not self._began:
            return
        if self._lingers:
            if self._cycles > LINGER_CYCLES:
                self._finish()
        elif self._cycles > self._options.cycles:
            limit = f"{self._options.cycles} reasoning cycles"
            self._give_up(f"the test did not end within {limit}: an endless loop?")

    def _idle(self) -> None:
        """Handle an idle run: no agent has anything to do, or waits for anything but the environment."""
        if self._done:
            return
        if self._lingers:
            self._finish()
        elif self._mas.environment is None:
            self._give_up("the test did not end, and nothing is left to do")
        elif self._goal is not None and not self._goal.intentions():
            self._give_up("the test did not end")

    def _give_up(self, message: str) -> None:
        assert self._goal is not None
        problem = _stuck(message, self._goal.intentions(), self._outcome.test)
        for intention in self._goal.intentions():
            self._goal.agent.finish(intention)
        self._fail(problem)

    def _hangs(self) -> None:
        seconds = f"{self._options.patience:g} s of real time"
        message = f"the test did not end within {seconds}: a step that never ends?"
        intentions = self._goal.intentions() if self._goal is not None else []
        self._end_run(_stuck(message, intentions, self._outcome.test))

    def _escaped(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Handle an exception that no caller can catch."""
        del loop
        error = context.get("exception")
        if isinstance(error, TookTooLong):
            self._hangs()
            self._mas.end(1)
        elif isinstance(error, Exception) and "handle" in context:
            self._mas.fail(error)
        else:
            self.log(f"error: {context.get('message')}: {type(error).__name__}: {error}", "error")

    # ---- observation

    def _observe(self, host: AgentHost) -> None:
        mind = host.mind
        if isinstance(mind, Mind):
            fakes = Fakes(mind.complete, host.set_timer)
            printed = partial(self._printed_by, host.name)
            self._probes[host.name] = Probe(fakes, self._asserted, printed)
            mind.observers.lost = partial(self._lost, host.name)
            host.intercept = fakes.begin
            host.intercept_stop = fakes.stop

    def _asserted(self, assertion: Assertion) -> None:
        self._outcome.assertions += 1
        if not assertion.passed:
            self._outcome.problems.append(FailureReport.of(assertion))

    def _lost(self, agent: str, message: str, details: Sequence[str], span: Span | None) -> None:
        """Record the failure of an intention that no plan handled."""
        outcome = self._outcome
        if outcome.output and outcome.output[-1].startswith(f"[{agent}] ") and message in outcome.output[-1]:
            # The warning about it has the same text.
            outcome.output.pop()
        first, _, rest = message.partition(": ")
        further = (rest, *details) if rest else tuple(details)
        outcome.problems.append(FailureReport(f"agent {agent}: {first}", further, span))

    def _printed_by(self, agent: str) -> Sequence[str]:
        prefix = f"[{agent}] "
        return [line.removeprefix(prefix) for line in self._outcome.output if line.startswith(prefix)]

    def print(self, agent: str, text: str) -> None:
        """Record a line of an agent's output."""
        self._outcome.output.append(f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        """Record a log line; warnings about programs are reported once, not for each test."""
        del level
        if text not in self._warnings:
            self._outcome.output.append(text)


def _failure(test: AgentTest, reason: FailureReason | None) -> FailureReport:
    """Return why the goal of a test failed."""
    if reason is None:
        return FailureReport("the goal of the test failed", (), test.span)
    place = reason.place.span() or test.span
    message = filter(None, (reason.message(), *details(reason)))
    return FailureReport(f"the goal of the test failed: {reason.error()}", tuple(message), place)


def _stuck(message: str, intentions: Sequence[Intention], test: AgentTest) -> FailureReport:
    """Return why a test does not end."""
    if not intentions:
        return FailureReport(f"{message}: its intention was dropped", (), test.span)
    intention = intentions[-1]
    state = intention.state
    frame = intention.frames[-1]
    info = getattr(frame[STEP], "info", None)
    place = info.node.span if info is not None else frame[PLAN].node.span
    if state == "waiting":
        reason = intention.waiting.reason
        what = f"it waits for {text(reason[1])}" if is_action(reason) else "it waits here"
        return FailureReport(message, (what,), place)
    return FailureReport(message, (f"it is {state}",) if state != "running" else (), place or test.span)


@contextmanager
def _patience(seconds: float) -> Iterator[None]:
    """Raise `TookTooLong` in the current step after *seconds* of real time."""
    if seconds <= 0 or threading.current_thread() is not threading.main_thread():
        yield
        return

    def ring(number: int, frame: FrameType | None) -> NoReturn:
        raise TookTooLong

    alarm = Alarm(ring)
    alarm.set(seconds)
    try:
        yield
    finally:
        alarm.cancel()
