"""The host of a mind in its run (Jason's agent architecture)."""

from collections.abc import Callable, Coroutine, Iterable
from random import Random
from typing import TYPE_CHECKING, Any, Protocol

from jacaros.agents.language.nodes import Literal
from jacaros.agents.mind.state.act import NEEDS, Act, AgentSystem, Completion, SpeechAct, Timer
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.terms.values import String, Term, atom, functor
from jacaros.mas.console import Console
from jacaros.mas.coroutines import Coroutines, Ended
from jacaros.mas.idleness import Activity, AgentTimer
from jacaros.mas.scheduler import Scheduler
from jacaros.runtime.clock import Clock

if TYPE_CHECKING:
    from jacaros.agents.body.body import AgentBody

_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)


class HostedMind(Protocol):
    """A mind, as its host sees it (`jacaros.agents.mind.mind.Mind`)."""

    stopped: bool
    """Set by the host to stop the mind."""

    @property
    def options(self) -> Options:
        """Options for its events and logs."""

    def start(self) -> None:
        """Adopt initial beliefs and goals."""

    def post_goal(self, goal: Term) -> None:
        """Adopt a goal."""

    def adopt(self, goals: Iterable[Literal]) -> None:
        """Adopt the goals of a program."""

    def run(self, fuel: int) -> bool:
        """Run reasoning cycles. Return whether there is more to do."""

    def receive(self, message: SpeechAct) -> None:
        """Receive a message."""

    def accept_kill(self, killer: str) -> bool:
        """Return whether another agent may kill this one."""

    def complete(self, act_id: int, completion: Completion) -> None:
        """Receive the outcome of an action."""

    def shut_down_in(self, milliseconds: float) -> None:
        """Receive the announcement that the run ends after this time."""


class Run(AgentSystem, Protocol):
    """What a host needs of its run."""

    clock: Clock
    scheduler: Scheduler
    activity: Activity
    console: Console

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
        mind: set before the first turn.
        body: runs its actions. None before the first one.
        make_body: creates the body. None in a project without an environment.
        intercept: called first with each action. Returns whether it answers the action itself. For tests.
        intercept_stop: the same for the end of the run.
        system: its run.
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
        "run",
        "send",
        "system",
    )

    def __init__(self, name: str, run: Run, seed: str) -> None:
        self.name = name
        self.queued = False
        self.body: AgentBody | None = None
        self.make_body: Callable[[], AgentBody] | None = None
        self.intercept: Callable[[Act], bool] | None = None
        self.intercept_stop: Callable[[float, int], bool] | None = None
        self.system = run
        self._scheduler = run.scheduler
        # Bound directly, because they are called for every message and every turn.
        self.send: Callable[[SpeechAct], bool] = run.deliver
        self.run: Callable[[int], bool] = _no_turn
        self._seed = seed
        self._random: Random | None = None
        self._coroutines: Coroutines | None = None
        self._ended = False

    @property
    def mind(self) -> HostedMind:
        """The mind."""
        return self._mind

    @mind.setter
    def mind(self, mind: HostedMind) -> None:
        self._mind = mind
        self.run = mind.run

    @property
    def ended(self) -> bool:
        """Whether it has ended."""
        return self._ended

    def halt(self) -> None:
        """Stop the mind, even in the middle of its turn."""
        self._ended = True
        self._mind.stopped = True
        self.run = _no_turn

    def end(self) -> None:
        """Cancel all actions and coroutines, and stop focusing."""
        if self._coroutines is not None:
            self._coroutines.cancel()
        if self.body is not None:
            self.body.close()

    async def close(self) -> None:
        """Wait until the coroutines have finished their clean-up."""
        if self._coroutines is not None:
            await self._coroutines.close()

    def receive(self, message: SpeechAct) -> None:
        """Pass a message to the mind."""
        if not self._ended:
            self._mind.receive(message)

    # ---- the port `jacaros.agents.mind.state.act.Architecture`

    def ready(self) -> None:
        """The mind has something to do."""
        if not self.queued:
            self._scheduler.make_ready(self)  # pyright: ignore[reportArgumentType]

    @property
    def random(self) -> Random:
        """The agent's own random number generator."""
        if self._random is None:
            self._random = Random(self._seed)
        return self._random

    def now(self) -> float:
        """Return the time of the run's clock in seconds since the Unix epoch."""
        return self.system.clock.now()

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* after *delay* seconds."""
        return AgentTimer(self.system.clock, self.system.activity, delay, callback)

    def start_coroutine(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> Timer:
        """Run a coroutine of the project's Python code beside the mind."""
        if self._coroutines is None:
            self._coroutines = Coroutines(self.system.activity)
        return self._coroutines.start(coroutine, ended)

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
        verbose = self._mind.options.verbose
        if verbose > 0 or level not in ("debug", "info"):
            # Details that an agent logs on request are shown, whatever the level of the console.
            shown = "info" if level == "debug" and verbose > 1 else level
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
    text = (
        f"unknown operation `{act.functor}`: the project has no environment "
        "(add the line `environment: jacaros.Environment` to the project file)"
    )
    reason = (_REASON, atom("no_environment"))
    return Completion(False, (), ((_ERROR_MSG, String(text)), reason))
