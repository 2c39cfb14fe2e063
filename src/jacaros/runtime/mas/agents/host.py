"""The host of a mind in its run (Jason's agent architecture), and the coroutines of its internal actions."""

import asyncio
from collections.abc import Awaitable, Callable, Coroutine, Sequence
from functools import partial
from random import Random
from typing import TYPE_CHECKING, Any, Protocol

from jacaros.agents.language.nodes import Literal
from jacaros.agents.mind.state.act import (
    NEEDS,
    Act,
    Activity,
    AgentSystem,
    Completion,
    SpeechAct,
    TimerHandle,
)
from jacaros.agents.terms.values import String, atom, functor
from jacaros.runtime.clock import Clock
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.scheduler import AgentTimer, Scheduler

if TYPE_CHECKING:
    from jacaros.agents.body.body import AgentBody
    from jacaros.agents.mind.mind import Mind

PATIENCE = 5.0
"""Seconds that coroutines and tasks of an agent have for their clean-up at the end of a run."""
ADD_ENVIRONMENT = "add the line `environment: jacaros.Environment` to the project file"
_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)


Ended = Callable[[object, BaseException | None], None]
"""Called with the result of a coroutine, or the exception that ended it."""


class Run(AgentSystem, Protocol):
    """What a host needs of its run."""

    clock: Clock
    scheduler: Scheduler
    activity: Activity
    console: RunConsole

    def deliver(self, message: SpeechAct) -> bool:
        """Deliver a message. Return False if the receiver is unknown."""

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""

    def goal_lost(self) -> None:
        """Count a failed goal without a plan for its failure."""

    def out_of_memory(self, name: str) -> None:
        """End the run after a `MemoryError` of an agent."""

    def end_agent(self, name: str) -> None:
        """End an agent immediately, without asking it. Unknown names have no effect."""


class AgentHost:
    """Runs one mind. It is the mind's `jacaros.agents.mind.state.act.Architecture`.

    Args:
        name: name of the agent.
        run: its run.
        seed: seed of the agent's random numbers.

    Attributes:
        queued: whether it waits for a turn. Set by the scheduler.
        body: runs its actions. None before the first one.
        make_body: creates the body. None in a project without an environment.
        intercept: called first with each action. Returns whether it answers the action itself. For tests.
        intercept_stop: the same for the end of the run.
        system: its run.
        verbose: the agent's option of this name.
        ready: reports that the mind has something to do.
        send: delivers a message. Returns False if the receiver is unknown.
        run: runs up to this number of cycles of the mind. Returns whether there is more to do.
    """

    __slots__ = (
        "_coroutines",
        "_ended",
        "_mind",
        "_random",
        "_scheduler",
        "_seed",
        "body",
        "intercept",
        "intercept_stop",
        "make_body",
        "name",
        "queued",
        "ready",
        "run",
        "send",
        "system",
        "verbose",
    )

    def __init__(self, name: str, run: Run, seed: str) -> None:
        self.name = name
        self.verbose = 1
        self.queued = False
        self.body: AgentBody | None = None
        self.make_body: Callable[[], AgentBody] | None = None
        self.intercept: Callable[[Act], bool] | None = None
        self.intercept_stop: Callable[[float, int], bool] | None = None
        self.system = run
        self._scheduler = run.scheduler
        # Bound directly, because they are called for every message and every turn.
        self.send: Callable[[SpeechAct], bool] = run.deliver
        self.ready: Callable[[], None] = partial(run.scheduler.make_ready, self)  # pyright: ignore[reportArgumentType]
        self.run: Callable[[int], bool] = _no_turn
        self._seed = seed
        self._random: Random | None = None
        self._mind: Mind
        self._coroutines: dict[AgentCoroutine, None] = {}
        self._ended = False

    @property
    def mind(self) -> "Mind | None":
        """The mind; None for a Python agent."""
        return self._mind

    @property
    def cycles(self) -> int:
        """Number of reasoning cycles so far; 0 for a Python agent."""
        return self.mind.counts.cycles if self.mind is not None else 0

    @property
    def is_held(self) -> bool:
        """Whether its mind is held in the middle of a cycle, by a debugger."""
        return self.mind is not None and self.mind.held is not None

    def set_mind(self, mind: "Mind") -> None:
        """Set the mind."""
        self._mind = mind
        self.run = mind.run
        self.verbose = mind.options.verbose

    def begin(self, goals: Sequence[Literal] | None) -> None:
        """Start the agent. As in JaCaMo, one that is given *goals* adopts them after it has perceived what it focuses."""
        self._mind.start()
        if goals is not None:
            self._mind.run(1)
            self._mind.adopt(goals)

    @property
    def ended(self) -> bool:
        """Whether it has ended."""
        return self._ended

    def halt(self) -> None:
        """Stop the mind, even in the middle of its turn."""
        self._ended = True
        if self.mind is not None:
            self.mind.stopped = True
        self.run = _no_turn

    def end(self) -> None:
        """Cancel all actions and coroutines, and stop focusing."""
        for coroutine in tuple(self._coroutines):
            coroutine.cancel()
        if self.body is not None:
            self.body.close()

    async def close(self) -> None:
        """Wait until the coroutines have finished their clean-up."""
        for coroutine in tuple(self._coroutines):
            coroutine.cancel()
        if self._coroutines:
            await asyncio.wait([each.task for each in self._coroutines], timeout=PATIENCE)

    def receive(self, message: SpeechAct) -> None:
        """Pass a message to the mind."""
        if not self._ended:
            self._mind.receive(message)

    def accept_kill(self, killer: str) -> bool:
        """Return whether another agent may kill this one."""
        return self._mind.accept_kill(killer)

    def shut_down_in(self, seconds: float) -> None:
        """Announce to the agent that it ends after this time."""
        self._mind.shut_down_in(seconds * 1000)

    # ---- the port `jacaros.agents.mind.state.act.Architecture`

    @property
    def random(self) -> Random:
        """The agent's own random number generator."""
        if self._random is None:
            self._random = Random(self._seed)
        return self._random

    def now(self) -> float:
        """Return the time of the run's clock in seconds since the Unix epoch."""
        return self.system.clock.now()

    def set_timer(self, delay: float, callback: Callable[[], None]) -> TimerHandle:
        """Call *callback* after *delay* seconds."""
        return AgentTimer(self.system.clock, self.system.activity, delay, callback)

    def start_coroutine(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> TimerHandle:
        """Run a coroutine of the project's Python code beside the mind."""
        running = AgentCoroutine(coroutine, ended, self.system.activity, self._over)
        self._coroutines[running] = None
        return running

    def _over(self, coroutine: "AgentCoroutine") -> None:
        self._coroutines.pop(coroutine, None)

    def act(self, act: Act) -> None:
        """Begin an external action. Without an environment, it fails immediately."""
        if self.intercept is not None and act.functor is not NEEDS and self.intercept(act):
            return
        body = self.body or self.situated()
        if body is not None:
            body.act(act)
            self._scheduler.poll_soon()
        else:
            self._mind.complete(act.id, without_environment(act))

    def situated(self) -> "AgentBody | None":
        """Return the body, created on first use; None without an environment."""
        if self.body is None and self.make_body is not None:
            self.body = self.make_body()
        return self.body

    def cancel_act(self, act_id: int) -> None:
        """The intention of an action was dropped."""
        if self.body is not None:
            self.body.cancel_act(act_id)

    def suspend_act(self, act_id: int) -> None:
        """The intention of an action was suspended."""
        if self.body is not None:
            self.body.suspend_act(act_id)

    def resume_act(self, act_id: int) -> None:
        """The intention of an action was resumed."""
        if self.body is not None:
            self.body.resume_act(act_id)

    def print(self, text: str) -> None:
        """Print a line of the program's output. An agent that has ended prints nothing."""
        if not self._ended:
            self.system.console.print(self.name, text)

    def log(self, level: str, text: str) -> None:
        """Log a line, subject to the agent's option ``verbose``."""
        if self.verbose > 0 or level not in ("debug", "info"):
            # Details that an agent logs on request are shown, whatever the level of the console.
            shown = "info" if level == "debug" and self.verbose > 1 else level
            self.system.console.log(f"[{self.name}] {level}: {text}", shown)

    def goal_lost(self) -> None:
        """Count a failed goal without a plan for its failure."""
        self.system.goal_lost()

    def out_of_memory(self) -> None:
        """End the run after a `MemoryError` in a step or event of the mind."""
        self.system.out_of_memory(self.name)

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""
        if self.intercept_stop is None or not self.intercept_stop(delay, exit_code):
            self.system.stop_system(delay, exit_code)


def _no_turn(fuel: int) -> bool:
    """Do nothing: the mind does not exist yet, or has ended."""
    del fuel
    return False


def without_environment(act: Act) -> Completion:
    """Return the failure of an action in a project without an environment."""
    text = f"unknown operation `{act.functor}`: the project has no environment ({ADD_ENVIRONMENT})"
    reason = (_REASON, atom("no_environment"))
    return Completion(False, (), ((_ERROR_MSG, String(text)), reason))


class AgentCoroutine:
    """One running coroutine of an internal action.

    Attributes:
        task: the task that runs it.
    """

    def __init__(
        self,
        coroutine: Coroutine[Any, Any, Any],
        ended: Ended,
        activity: Activity,
        over: "Callable[[AgentCoroutine], object]",
    ) -> None:
        self._ended, self._activity, self._over = ended, activity, over
        self._wanted = True
        activity.begin()
        self.task = asyncio.get_running_loop().create_task(without_exit(coroutine))
        self.task.add_done_callback(self._done)

    def cancel(self) -> None:
        """Cancel it: its ``finally`` blocks run, and its end is not reported."""
        if self._wanted:
            self._wanted = False
            self._activity.end()
            self.task.cancel()

    def _done(self, task: "asyncio.Task[Any]") -> None:
        self._over(self)
        error = asyncio.CancelledError("cancelled") if task.cancelled() else task.exception()
        if not self._wanted:
            return
        self._wanted = False
        self._activity.end()
        self._ended(None if error is not None else task.result(), error)


async def without_exit(work: Awaitable[Any]) -> Any:
    """Await a coroutine. Turn its ``sys.exit``, which would end the event loop, into an error."""
    try:
        return await work
    except SystemExit as error:
        raise RuntimeError(f"SystemExit: {error}") from error
