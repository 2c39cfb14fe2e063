"""Running tests: each in a system of its own, or those of a file one after the other in one system."""

import asyncio
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

from jacaros.alarm import Alarm
from jacaros.asl import nodes
from jacaros.asl.lowering import lower_value
from jacaros.asl.source import Span
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.explaining.lost_goals import details
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules.goals import describe
from jacaros.bdi.rules.watched import WatchedGoal
from jacaros.bdi.state.intention import PLAN, STEP, Intention
from jacaros.bdi.state.waiting import is_action
from jacaros.clock import Clock, VirtualClock, WallClock, run
from jacaros.errors import InternalError, JacarosError
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.deployment import Deployment, ProjectError
from jacaros.mas.loading import mapped
from jacaros.mas.options import RunOptions
from jacaros.mas.python_code import PythonCode
from jacaros.mas.ros_graph import NO_WORLD
from jacaros.mas.system import System
from jacaros.terms.text import text
from jacaros.testing.assertions import actions
from jacaros.testing.outcomes import Outcome, Problem, SuiteOutcome
from jacaros.testing.probe import Assertion, Probe
from jacaros.testing.recorded import Fakes
from jacaros.testing.suites import AgentTest, Suite, with_assertions

if TYPE_CHECKING:
    from jacaros.testing.fake_graph import FakeGraph

LINGER_SECONDS = 1.0
LINGER_CYCLES = 10_000
"""When a test has achieved its goal the run goes on until nobody has anything to do, but no longer than this: for the goals
that it posted with ``!!``, whose assertions count too."""


@dataclass(frozen=True, slots=True)
class TrialOptions(RunOptions):
    """How tests are run: the attributes of `RunOptions` (on the virtual clock with seed 0 unless given), and these.

    Attributes:
        timeout: seconds of the run's clock after which a test has failed, unless its label says otherwise.
        cycles: reasoning cycles of all agents together after which a test has failed.
        patience: seconds of the wall clock after which a test has failed, whatever it does; 0 for no such limit.  It works
            in the main thread of a process on POSIX systems.
        shared: the tests of a file run one after the other in one system, as on Jason.
    """

    fast: bool = True
    seed: int | None = 0
    timeout: float = 60.0
    cycles: int = 1_000_000
    patience: float = 300.0
    shared: bool = False


def run_suite(
    suite: Suite,
    options: TrialOptions | None = None,
    chosen: Callable[[AgentTest], bool] = lambda test: True,
) -> Iterator[Outcome]:
    """Run the tests of a file; each outcome comes when it is there.

    Raises:
        UsageError: options that cannot go together.
        InternalError: a defect of JaCaROS showed itself.
    """
    options = options or TrialOptions()
    options.check()
    tests = [test for test in suite.tests if chosen(test)]
    if suite.error is not None or not tests:
        return
    for together in [tests] if options.shared else [[test] for test in tests]:
        yield from _outcomes(suite, together, options)


def _outcomes(suite: Suite, tests: Sequence[AgentTest], options: TrialOptions) -> list[Outcome]:
    """Make tests in one run."""
    try:
        trial = Trial(suite, tests, options)
    except ProjectError as wrong:
        told = Problem("a mapping is wrong", tuple(str(wrong).splitlines()), tests[0].span)
        return [Outcome(test, problems=[told]) for test in tests]
    return trial.run()


def run_suites(suites: Sequence[Suite], options: TrialOptions | None = None) -> list[SuiteOutcome]:
    """Run all tests of several files."""
    return [SuiteOutcome(suite, list(run_suite(suite, options))) for suite in suites]


class TookTooLong(BaseException):
    """The wall clock says that a test hangs; no ordinary exception, because those of a step only fail that step."""


class Trial:
    """One run of a system in which tests are made, one after the other."""

    def __init__(self, suite: Suite, tests: Sequence[AgentTest], options: TrialOptions) -> None:
        assert suite.deployment is not None
        self._warnings = frozenset(suite.warnings)
        self._options = options
        self._outcomes = [Outcome(test) for test in tests]
        self._number = -1
        self._goal: WatchedGoal | None = None
        self._done = False
        self._lingers = False
        self._cycles = 0
        self._began = self._began_run = 0.0
        self._timers: list[Any] = []
        self._probes: dict[str, Probe] = {}
        self._actions = actions(self._probes)
        clock_class = _MeteredVirtualClock if options.fast else _MeteredWallClock
        self._clock: Clock = clock_class(self._busy)
        self._others: FakeGraph | None = None
        self._mappings = tuple(
            dict.fromkeys((*options.mappings, *(name for test in tests for name in test.mappings)))
        )
        self._mas = self._system(suite.deployment)

    def _system(self, deployment: Deployment) -> System:
        """The system, with the artifacts of the mappings; then in a graph without a robot, unless a world is named."""
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

    def run(self) -> list[Outcome]:
        """Make the tests; their outcomes, in order.

        Raises:
            InternalError: a defect of JaCaROS showed itself.
        """
        try:
            with _patience(self._options.patience * len(self._outcomes)):
                run(self._main, self._clock)
        except TookTooLong:
            self._hangs()
        except InternalError:
            raise
        except JacarosError as wrong:
            self._end_run(Problem("the system cannot be started", tuple(str(wrong).splitlines())))
        self._end_run(Problem("the program ended the run (.stopMAS) before the test had ended"))
        return self._outcomes

    async def _main(self) -> None:
        asyncio.get_running_loop().set_exception_handler(self._escaped)
        await self._mas.run(self._next)

    # ---- one test after the other

    @property
    def _outcome(self) -> Outcome:
        return self._outcomes[max(self._number, 0)]

    def _next(self) -> None:
        """Begin the next test, or end the run."""
        for timer in self._timers:
            timer.cancel()
        if self._number + 1 == len(self._outcomes):
            self._done = True
            self._mas.end(0)
            return
        self._number += 1
        test = self._outcome.test
        self._forget_messages()
        self._lingers = False
        self._cycles = 0
        self._began, self._began_run = time.perf_counter(), self._clock.now()
        limit = test.timeout if test.timeout is not None else self._options.timeout
        self._timers = [self._clock.call_later(limit, lambda: self._timed_out(limit))]
        host = self._mas.directory.find(test.agent)
        if host is None or not isinstance(host.mind, Mind):
            self._fail(
                Problem(f"the test was not started: there is no agent {test.agent} any more", (), test.span)
            )
            return
        self._goal = WatchedGoal(host.mind, lower_value(test.goal), self._goal_ended)

    def _forget_messages(self) -> None:
        """A test hears what is published from its beginning on."""
        if self._others is not None:
            self._others.forget()
        elif self._mappings:
            self._others_in_graph()

    def _others_in_graph(self) -> "FakeGraph":
        """The rest of the ROS graph, which comes into being when a test first plays it."""
        if self._others is None:
            from jacaros.testing.fake_graph import FakeGraph  # here: most tests have no ROS graph

            self._others = FakeGraph(self._mas.ros)
        return self._others

    def _goal_ended(self) -> None:
        """The goal of the test is achieved or has failed."""
        assert self._goal is not None
        if self._goal.failed:
            self._fail(_failure(self._outcome.test, self._goal.reason))
            return
        self._lingers = True
        self._cycles = 0
        self._timers.append(self._clock.call_later(LINGER_SECONDS, self._finish))

    def _finish(self) -> None:
        """The test is over."""
        self._note_times()
        self._next()

    def _note_times(self) -> None:
        self._outcome.seconds = time.perf_counter() - self._began
        self._outcome.simulated = self._clock.now() - self._began_run

    def _fail(self, problem: Problem) -> None:
        self._outcome.problems.append(problem)
        self._finish()

    def _end_run(self, problem: Problem) -> None:
        """The run is over before its time: a problem of the present test, and of those that have not begun."""
        if self._done:
            return
        self._done = True
        if not self._lingers:
            self._outcome.problems.append(problem)
        if self._began:
            self._note_times()
        for outcome in self._outcomes[max(self._number, 0) + 1 :]:
            outcome.problems.append(Problem("the test was not started: the run had ended"))

    # ---- what ends a test that does not end by itself

    def _timed_out(self, limit: float) -> None:
        if self._lingers:
            self._finish()
            return
        told = f"the test did not end within {limit:g} s of the run's clock"
        self._give_up(told)

    def _busy(self, cycles: int) -> None:
        """Agents made reasoning cycles."""
        self._cycles += cycles
        if self._done or self._number < 0:
            return
        if self._lingers:
            if self._cycles > LINGER_CYCLES:
                self._finish()
        elif self._cycles > self._options.cycles:
            self._give_up(
                f"the test did not end within {self._options.cycles} reasoning cycles: an endless loop?"
            )

    def _idle(self) -> None:
        """No agent has anything to do or waits for anything but the environment."""
        if self._done:
            return
        if self._lingers:
            self._finish()
        elif self._mas.environment is None:
            self._give_up("the test did not end, and nothing happens any more")
        elif self._goal is not None and not self._goal.intentions():
            self._give_up("the test did not end")

    def _give_up(self, told: str) -> None:
        assert self._goal is not None
        problem = _stuck(told, self._goal.intentions(), self._outcome.test)
        for intention in self._goal.intentions():
            self._goal.agent.finish(intention)
        self._fail(problem)

    def _hangs(self) -> None:
        told = (
            f"the test was stopped after {self._options.patience:g} s of real time: a step that does not end"
        )
        intentions = self._goal.intentions() if self._goal is not None else []
        self._end_run(_stuck(told, intentions, self._outcome.test))

    def _escaped(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Something raised an exception outside of anybody's care."""
        del loop
        error = context.get("exception")
        if isinstance(error, TookTooLong):
            self._hangs()
            self._mas.end(1)
        elif isinstance(error, Exception) and "handle" in context:
            self._mas.fail(error)
        else:
            self.log(f"error: {context.get('message')}: {type(error).__name__}: {error}", "error")

    # ---- looking on

    def _observe(self, host: AgentHost) -> None:
        """Look on at an agent, from its making on."""
        mind = host.mind
        if isinstance(mind, Mind):
            fakes = Fakes(mind.complete, host.set_timer)
            printed = partial(self._printed_by, host.name)
            self._probes[host.name] = Probe(fakes, self._asserted, printed, self._others_in_graph)
            mind.observers.lost = partial(self._lost, host.name)
            host.intercept = fakes.begin
            host.intercept_stop = fakes.stop

    def _asserted(self, assertion: Assertion) -> None:
        """An agent made an assertion."""
        self._outcome.assertions += 1
        if not assertion.passed:
            self._outcome.problems.append(Problem.of(assertion))

    def _lost(self, agent: str, told: str, details: Sequence[str], span: Span | None) -> None:
        """An intention of an agent failed, and nobody took care of that."""
        outcome = self._outcome
        if outcome.output and outcome.output[-1].startswith(f"[{agent}] ") and told in outcome.output[-1]:
            # The warning about it says the same.
            outcome.output.pop()
        first, _, rest = told.partition(": ")
        told_further = (rest, *details) if rest else tuple(details)
        outcome.problems.append(Problem(f"agent {agent}: {first}", told_further, span))

    def _printed_by(self, agent: str) -> Sequence[str]:
        prefix = f"[{agent}] "
        return [line.removeprefix(prefix) for line in self._outcome.output if line.startswith(prefix)]

    def print(self, agent: str, text: str) -> None:
        """Keep a line that an agent prints."""
        self._outcome.output.append(f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        """Keep a line for people; warnings about the programs are told once, not in each test."""
        del level
        if text not in self._warnings:
            self._outcome.output.append(text)


def _failure(test: AgentTest, reason: FailureReason | None) -> Problem:
    """Why the goal of a test failed."""
    if reason is None:
        return Problem("the goal of the test failed", (), test.span)
    place = reason.span() or test.span
    told = filter(None, (reason.message(), *details(reason)))
    return Problem(f"the goal of the test failed: {reason.error()}", tuple(told), place)


def _stuck(told: str, intentions: Sequence[Intention], test: AgentTest) -> Problem:
    """Why a test does not come to an end."""
    if not intentions:
        return Problem(f"{told}: its intention was dropped", (), test.span)
    intention = intentions[-1]
    state, reason = describe(intention)
    frame = intention.frames[-1]
    info = getattr(frame[STEP], "info", None)
    place = info.node.span if info is not None else frame[PLAN].node.span
    if state == "waiting":
        what = f"it waits for the end of {text(reason[1])}" if is_action(reason) else "it waits here"
        return Problem(told, (what,), place)
    return Problem(told, (f"it is {state}",) if state != "running" else (), place or test.span)


class _MeteredVirtualClock(VirtualClock):
    """A virtual clock that tells of the cycles of agents."""

    def __init__(self, on_busy: Callable[[int], None]) -> None:
        super().__init__()
        self._on_busy = on_busy

    def busy(self, cycles: int) -> None:
        super().busy(cycles)
        self._on_busy(cycles)


class _MeteredWallClock(WallClock):
    """The time of day, and told of the cycles of agents."""

    def __init__(self, on_busy: Callable[[int], None]) -> None:
        super().__init__()
        self._on_busy = on_busy

    def busy(self, cycles: int) -> None:
        self._on_busy(cycles)


@contextmanager
def _patience(seconds: float) -> Iterator[None]:
    """Raise `TookTooLong` in the middle of whatever is done when it takes too long."""
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
