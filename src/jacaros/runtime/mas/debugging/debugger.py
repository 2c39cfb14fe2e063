"""The debugger of a running system. It stops agents, timers and the embedded world together."""

import asyncio
import sys
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, get_args

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.cycle import observe_steps
from jacaros.agents.mind.rules.failure_reason import FailureReason
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import EVENT_GOAL, PLAN, STEP, Event, Intention
from jacaros.agents.mind.state.triggers import Goal
from jacaros.agents.terms.values import Annotations
from jacaros.look.records.words import shown_event
from jacaros.robots.ros.guarded import guarded_by
from jacaros.runtime.clock import Clock, WallClock, outside_run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import entered
from jacaros.runtime.mas.debugging.breakpoints import (
    Breakpoint,
    ConditionBreakpoint,
    EventBreakpoint,
    FailureBreakpoint,
    LineBreakpoint,
    breakpoint_at,
    lines_that_stop,
    step_line,
)
from jacaros.runtime.mas.debugging.failures import Failed, failed
from jacaros.runtime.mas.debugging.reload import reload_programs
from jacaros.runtime.mas.directory import Directory
from jacaros.runtime.mas.history.run_environment import ObservedSystem
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph
from jacaros.runtime.mas.scheduler import Runnable

StepKind = Literal["cycle", "step", "event", "over", "out"]
"""Until where to continue: the next reasoning cycle, plan step or event; or, of one intention, the next step outside
subgoals (``over``), or the step after the end of its current plan (``out``).
"""

STEPS = get_args(StepKind)


@dataclass(frozen=True)
class _Stepping:
    """A requested step.

    Attributes:
        what: the kind.
        agent: the agent to step; None for the one that is next.
        intention: the intention to step; None for any.
        height: the greatest height of its stack at which the step ends.
        begun: by agent, the number of the cycle in which the step began.
    """

    what: StepKind
    agent: str | None
    intention: Intention | None
    height: int
    begun: Mapping[str, int]


@dataclass(frozen=True)
class DebugState:
    """The state of a debugger: the data of a ``debug`` record, see ``docs/reference/recordings.md``.

    Attributes:
        state: ``paused`` or ``running``.
        why: why the run was paused, such as ``pause``, ``step`` or ``breakpoint patrol.asl:14``. Empty while it runs.
        speed: seconds of the run's clock per second of real time; 0.0 for the virtual clock.
        cannot: what a pause does not stop, in words.
        agent: the agent that is held before an event or a step. Empty without one.
        event: the event before which it is held, such as ``+battery(57)``. Empty for a step.
        file, line: location of the step before which it is held. Empty and 0 for an event.
        intention: number of its intention; 0 without one.
        breakpoints: the breakpoints, as data for `Debugger.add_breakpoint`.
    """

    state: Literal["paused", "running"]
    why: str = ""
    speed: float = 1.0
    cannot: tuple[str, ...] = ()
    agent: str = ""
    event: str = ""
    file: str = ""
    line: int = 0
    intention: int = 0
    breakpoints: tuple[Mapping[str, Any], ...] = ()

    def data(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {**asdict(self), "cannot": list(self.cannot), "breakpoints": list(self.breakpoints)}


DebugListener = Callable[[DebugState], None]


class Debugger:
    """Pauses, steps and continues a run, and changes its speed and programs.

    All methods must be called in the thread of the run's event loop. Several systems on one loop with the virtual clock
    share this clock: a pause stops the time of all of them.

    Args:
        system: the system.
    """

    def __init__(self, system: ObservedSystem) -> None:
        self._system = system
        self._breakpoints: dict[str, Breakpoint] = {}
        self._listeners: list[DebugListener] = []
        self._state = DebugState("running", speed=self.speed)
        self._stepping: _Stepping | None = None
        self._noted: dict[str, dict[str, None]] = {}
        """By agent, the breakpoints met by belief changes and signals that no plan handles, since its last step."""
        self._failure: Failed | None = None
        self._watches = False
        self._over = False

    # ---- state

    @property
    def paused(self) -> bool:
        """Whether the run is paused."""
        return self._state.state == "paused"

    @property
    def state(self) -> DebugState:
        """The current state, as listeners received it."""
        return self._state

    @property
    def failure(self) -> Failed | None:
        """The failure at which the run is paused, or None."""
        return self._failure if self.paused else None

    def listen(self, listener: DebugListener) -> Callable[[], None]:
        """Call *listener* with every new state. Return a function that ends this."""
        return entered(self._listeners, listener)

    async def wait_until_paused(self) -> DebugState:
        """Wait until the run is paused, by a breakpoint or otherwise. Return the state."""
        if self.paused:
            return self._state
        found: asyncio.Future[DebugState] = asyncio.get_running_loop().create_future()

        def notice(state: DebugState) -> None:
            if state.state == "paused" and not found.done():
                found.set_result(state)

        end = self.listen(notice)
        try:
            return await found
        finally:
            end()

    # ---- pause and continue

    def pause(self, why: str = "pause") -> None:
        """Pause agents, timers and the embedded world. On a real graph, command zero velocity first.

        An agent in the middle of its turn is held before its next step. No effect on a run that is paused or has ended.
        """
        if not self.paused and not self._over:
            self._hook()
            self._stop(DebugState("paused", why))

    def resume(self) -> None:
        """Continue where the run was paused. No effect on a running one."""
        if not self.paused:
            return
        self._failure = None
        self._change(DebugState("running"))
        self._system.scheduler.resume()
        self._system.clock.resume()

    def step(
        self, what: StepKind = "step", agent: str | None = None, intention: Intention | None = None
    ) -> None:
        """Continue until the next reasoning cycle, plan step or event, and pause before it.

        Meanwhile time advances, and other agents have their turns.

        Args:
            what: ``cycle``, ``step``, ``event``, ``over`` or ``out``. The last goal of a plan replaces the plan on the
                stack, so ``over`` enters it.
            agent: name of the agent to step. None for the one that is next.
            intention: the intention to step with ``step``, ``over`` and ``out``. None for any with ``step``, and otherwise
                for the one that is held. If it ends, the run pauses before the next step of its agent.

        Raises:
            UsageError: *what* or *agent* is unknown, or no intention is held.
        """
        if what not in STEPS:
            raise UsageError(f"unknown step `{what}`; expected {', '.join(STEPS)}")
        host = None if agent is None else self._system.directory.find(agent)
        if agent is not None and host is None:
            raise UsageError(f"unknown agent `{agent}`")
        height = sys.maxsize
        if what in ("over", "out"):
            intention = intention or self._held_intention(agent)
            height = len(intention.frames) - (what == "out")
        self._hook()
        begun = {mind.name: mind.counts.cycles for mind in self._minds() if mind.held is not None}
        self._stepping = _Stepping(what, agent, intention, height, begun)
        self.resume()

    def _held_intention(self, agent: str | None) -> Intention:
        held = [mind.held for mind in self._minds() if agent in (None, mind.name)]
        found = next((each for each in held if isinstance(each, Intention)), None)
        if found is None:
            raise UsageError("no intention is held before a step; use `step`, `event` or `cycle`")
        return found

    def run_ended(self) -> None:
        """Let the run end, because what a pause holds would never end. From now on, nothing pauses it."""
        self._over = True
        self._stepping = None
        self._breakpoints.clear()
        self.resume()

    # ---- speed

    @property
    def speed(self) -> float:
        """Seconds of the run's clock per second of real time; 0.0 for the virtual clock."""
        return self._system.clock.speed

    @speed.setter
    def speed(self, factor: float) -> None:
        if not self.has_speed:
            raise UsageError("the speed can be set only with --clock real and --ros memory")
        if not 0.0 < factor < float("inf"):
            raise UsageError(f"expected a speed greater than 0, found {factor}")
        self._system.clock.speed = factor
        self._change(self._state)

    @property
    def has_speed(self) -> bool:
        """Whether the speed can be changed: in real time, with the embedded world or none."""
        return self._system.clock.has_speed and self._system.options.ros == "memory"

    # ---- breakpoints

    @property
    def breakpoints(self) -> list[Breakpoint]:
        """The breakpoints, in the order in which they were set."""
        return list(self._breakpoints.values())

    def add_breakpoint(self, at: Breakpoint | Mapping[str, Any]) -> Breakpoint:
        """Set a breakpoint, also for future agents.

        Args:
            at: the breakpoint, or data that describes it (`jacaros.runtime.mas.debugging.breakpoints.breakpoint_at`).

        Raises:
            AslError: a trigger or condition has errors.
            UsageError: the data does not describe a breakpoint, or the line has no step.
        """
        made = breakpoint_at(at) if isinstance(at, Mapping) else at
        if isinstance(made, LineBreakpoint):
            self._refuse_useless(made)
        known = self._breakpoints.setdefault(made.text, made)
        self._hook()
        if isinstance(known, ConditionBreakpoint):
            host = self._system.directory.find(known.agent)
            if host is not None and host.mind is not None:
                known.becomes_true(host.mind)
        self._change(self._state)
        return known

    def lines_of(self, file: str) -> set[int]:
        """Return the lines of a file where a breakpoint can stop the run; empty if no agent runs it yet."""
        at = LineBreakpoint(file, 0)
        plans = (plan for mind in self._minds() for plan in mind.library.plans if at.is_in(plan.file))
        return {line for plan in plans for line in lines_that_stop(plan)}

    def _refuse_useless(self, made: LineBreakpoint) -> None:
        """Reject a line without a step. A file that no agent runs may be used later."""
        lines = self.lines_of(made.file)
        if lines and made.line not in lines:
            after = min((line for line in lines if line > made.line), default=None)
            text = f"no step on line {made.line} of {made.file}"
            raise UsageError(text if after is None else f"{text}; the next one is on line {after}")

    def remove_breakpoint(self, at: Breakpoint | Mapping[str, Any]) -> bool:
        """Remove a breakpoint. Return False if it was not set.

        Raises:
            AslError: a trigger or condition has errors.
            UsageError: the data does not describe a breakpoint.
        """
        made = breakpoint_at(at) if isinstance(at, Mapping) else at
        if self._breakpoints.pop(made.text, None) is None:
            return False
        self._change(self._state)
        return True

    # ---- programs

    def reload(self) -> list[str]:
        """Read changed programs (``.asl``) again, and replace their plans and rules in the agents that run them.

        Beliefs and intentions are kept. An intention keeps its old plan until this plan ends. Agents do not adopt new
        initial beliefs and goals.

        Returns:
            What was replaced, and what could not be, one line each.

        Raises:
            AslError: a program has errors; nothing has been replaced.
        """
        lines = reload_programs(self._system.directory, self._system.lifecycle)
        self._change(self._state)
        return lines

    # ---- called by minds, see `jacaros.agents.mind.state.circumstance.StepObserver`

    def holds_event(self, agent: Circumstance, event: Event) -> bool:
        """Return whether *agent* is held before it selects a plan for *event*."""
        if self.paused:
            return True
        why = self._met(agent, lambda each: each.meets_event(agent, event)) or self._why_before(
            agent, "event"
        )
        return self._hold(agent, why, None, event[EVENT_GOAL])

    def holds_step(self, agent: Circumstance, intention: Intention) -> bool:
        """Return whether *agent* is held before it runs the next step of *intention*."""
        if self.paused:
            return True
        if not (self._breakpoints or self._stepping):
            observe_steps(agent, None)  # from now on, the agent is as fast as without a debugger
            return False
        why = self._met(agent, lambda each: self._meets_step(each, agent, intention))
        if not why and intention.frames[-1][STEP] is not None:
            why = self._why_before(agent, "step", intention)
        return self._hold(agent, why, intention)

    def _meets_step(self, each: Breakpoint, agent: Circumstance, intention: Intention) -> bool:
        if not each.meets_step(agent, intention):
            return False
        message = each.logs(agent, intention) if isinstance(each, LineBreakpoint) else None
        if message is not None:
            self._system.console.log(f"[{agent.name}] {message}")
        return message is None

    def notes_unhandled(self, agent: Circumstance, goal: Goal, annotations: Annotations) -> None:
        """Hold *agent* before its next event or step if a breakpoint is for a change that no plan handles."""
        for each in self._breakpoints.values():
            if isinstance(each, EventBreakpoint) and each.fits(agent, goal, annotations):
                self._noted.setdefault(agent.name, {})[each.text] = None

    def notes_failure(self, agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
        """Stop after the step of *agent* in which a goal failed, if a breakpoint is for this kind of failure."""
        wanted = [each for each in self._breakpoints.values() if isinstance(each, FailureBreakpoint)]
        if not wanted or self._over:
            return
        found = failed(agent.name, intention, reason)
        for each in wanted:
            if each.kind in found.kinds:
                self._failure = found
                told = f"{each.text}: {found.message.splitlines()[0]}"
                self._noted.setdefault(agent.name, {})[told] = None

    def _met(self, agent: Circumstance, test: Callable[[Breakpoint], bool]) -> str:
        # Evaluate all: conditions remember at each evaluation whether they hold.
        met = list(self._noted.pop(agent.name, ()))
        met += [each.met for each in self._breakpoints.values() if test(each)]
        return f"breakpoint {', '.join(met)}" if met else ""

    def _why_before(self, agent: Circumstance, what: StepKind, intention: Intention | None = None) -> str:
        """Return ``step`` if the requested step ends here."""
        wanted = self._stepping
        if wanted is None or wanted.agent not in (None, agent.name):
            return ""
        if wanted.what == "cycle":
            return "" if wanted.begun.get(agent.name) == agent.counts.cycles else "step"
        if wanted.intention is None:
            return "step" if wanted.what == what else ""
        if wanted.intention.dropped:
            return "step" if what == "step" else ""
        if intention is None or intention is not wanted.intention:
            return ""
        return "step" if len(intention.frames) <= wanted.height else ""

    def _hold(
        self, agent: Circumstance, why: str, intention: Intention | None, event: Goal | None = None
    ) -> bool:
        if not why:
            return False
        file, line, number = "", 0, 0
        told = "" if event is None else shown_event(event)
        if intention is not None:
            number, frame = intention.id, intention.frames[-1]
            file, line = frame[PLAN].file, step_line(getattr(frame[STEP], "info", None))
        self._stop(
            DebugState("paused", why, agent=agent.name, event=told, file=file, line=line, intention=number)
        )
        return True

    # ---- the run itself

    def _stop(self, state: DebugState) -> None:
        system = self._system
        self._stepping = None
        system.scheduler.pause()
        command_standstill(system.ros, system.options)
        if isinstance(system.clock, WallClock) and system.options.ros != "memory":
            system.clock.pause_timers()
        else:
            system.clock.pause()
        cannot = not_paused(system.directory, system.ros, system.options, system.clock)
        self._change(replace(state, cannot=cannot))

    def _change(self, state: DebugState) -> None:
        breakpoints = tuple(each.data() for each in self._breakpoints.values())
        self._state = replace(state, speed=self.speed, breakpoints=breakpoints)
        with outside_run():
            for listener in tuple(self._listeners):
                listener(self._state)

    def _minds(self) -> list[Mind]:
        return [host.mind for host in self._system.directory if host.mind is not None]

    def _hook(self) -> None:
        """Observe all agents, including future ones."""
        self._system.scheduler.turn_ended = self.turn_ended
        for mind in self._minds():
            self._observe(mind)
        if not self._watches:
            self._watches = True
            self._system.directory.watch(self._agent_came)

    def _agent_came(self, name: str, present: bool) -> None:
        host = self._system.directory.find(name)
        if present and host is not None and (self._breakpoints or self._stepping or self.paused):
            self._observe(host.mind)

    def _observe(self, mind: Mind | None) -> None:
        if mind is not None and mind.observers.step is not self:
            observe_steps(mind, self)

    # ---- called by the scheduler

    def turn_ended(self, agent: Runnable) -> None:
        """Evaluate conditions after a turn, too: a percept that no plan handles is followed by no step."""
        mind = agent.mind if isinstance(agent, AgentHost) else None
        if self.paused or mind is None:
            return
        why = self._met(mind, lambda each: isinstance(each, ConditionBreakpoint) and each.becomes_true(mind))
        if why:
            self._stop(DebugState("paused", why, agent=mind.name))


def command_standstill(ros: RosGraph, options: RunOptions) -> None:
    """Command zero velocity to the robots that our artifacts drive on a real graph.

    The embedded world is itself paused: its robots then continue as if nothing had happened.
    """
    if options.ros != "memory" and ros.joined is not None:
        guarded_by(ros.joined).stand_still()


def not_paused(directory: Directory, ros: RosGraph, options: RunOptions, clock: Clock) -> tuple[str, ...]:
    """Return what continues during a pause, one line each."""
    lines = []
    if not clock.virtual:
        lines += [
            f"agent {host.name} (Python): it continues until it waits for the run's clock or for an operation"
            for host in directory
            if host.mind is None
        ]
    if options.ros != "memory" and ros.joined is not None:
        lines.append(f"the ROS graph ({options.ros}): other nodes and real robots continue")
        lines += [
            f"action {name}: a goal that its server has accepted continues"
            for name, _ in guarded_by(ros.joined).actions
        ]
    if options.ros_clock:
        lines.append("/clock: the simulator continues")
    return tuple(lines)
