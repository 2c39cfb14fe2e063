"""What stands between one mind and its run: Jason's agent architecture."""

from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from random import Random
from typing import Any, Protocol

from jacaros.asl.nodes import Literal
from jacaros.bdi.architecture import Timer
from jacaros.bdi.state.act import NEEDS, Act, Completion, Percept
from jacaros.bdi.state.options import Options
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.clock import Clock
from jacaros.mas.console import Console
from jacaros.mas.coroutines import Coroutines, Ended
from jacaros.mas.directory import Services
from jacaros.mas.idleness import Activity, AgentTimer
from jacaros.mas.scheduler import Scheduler
from jacaros.terms.values import String, Term, atom, functor

_ERROR_MSG = functor("error_msg", 1)
_REASON = functor("env_failure_reason", 1)


class HostedMind(Protocol):
    """An agent as its host sees it (`jacaros.bdi.mind.Mind`)."""

    stopped: bool
    """Set by the host: no further cycle."""

    @property
    def options(self) -> Options:
        """How it handles its events, and how much it tells."""

    def start(self) -> None:
        """Take up initial beliefs and goals."""

    def post_goal(self, goal: Term) -> None:
        """Adopt a goal."""

    def adopt(self, goals: Iterable[Literal]) -> None:
        """Take up the goals of a program."""

    def run(self, fuel: int) -> bool:
        """Make reasoning cycles; True when there is more to do."""

    def receive(self, message: SpeechAct) -> None:
        """Take a message in."""

    def accept_kill(self, killer: str) -> bool:
        """Whether another agent may end this one."""

    def perceive(self, percepts: list[Percept]) -> None:
        """Take percepts in."""

    def has_untaken(self, name: str) -> bool:
        """Whether percepts about properties called *name* have still to be taken up."""

    def keep_histories(self, namespace: str | None, histories: Mapping[str, float]) -> None:
        """Keep what beliefs in a namespace were: seconds by name."""

    def complete(self, act_id: int, completion: Completion) -> None:
        """Be told the end of an action."""

    def preempted(self, act_id: int, resource: str) -> None:
        """An act, or a plan that needs it, has lost a resource."""

    def regained(self, act_id: int) -> None:
        """It has the resource again, or no longer waits for it."""

    def shut_down_in(self, milliseconds: float) -> None:
        """Be told that the end comes after so many milliseconds."""


class Body(Protocol):
    """What carries out the actions of an agent (`jacaros.body.body.AgentBody`)."""

    def act(self, act: Act) -> None:
        """Begin an action."""

    def cancel_act(self, act_id: int) -> None:
        """Give an action up."""

    def suspend_act(self, act_id: int) -> None:
        """Pause the operation of an action, if it can be paused."""

    def resume_act(self, act_id: int) -> None:
        """Let it go on."""

    def close(self) -> None:
        """Give all actions and focused artifacts up."""


class Run(Protocol):
    """What a host asks of the run that its agent belongs to."""

    clock: Clock
    scheduler: Scheduler
    activity: Activity
    console: Console

    @property
    def services(self) -> Services:
        """The directory facilitator."""

    def deliver(self, message: SpeechAct) -> bool:
        """Bring a message to its receiver; False when there is none."""

    def agent_names(self) -> Sequence[str]:
        """Names of all agents, in the order of their making."""

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""

    def goal_lost(self) -> None:
        """A goal of an agent failed and no plan took over."""

    def out_of_memory(self, name: str) -> None:
        """End the run: an agent met a `MemoryError`."""

    def explain(self, question: str, agent: str) -> Mapping[str, Any]:
        """Answer a question of an agent about the run so far."""

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Make and start an agent; its final name, or None with the reason logged."""

    def clone_agent(self, original: str, name: str) -> str | None:
        """Make an agent with a copy of another one's mind; its final name, or None with the reason logged."""

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        """End an agent on behalf of another; False when there is none of that name, or it does not accept."""

    def end_agent(self, name: str) -> None:
        """End an agent at once, without asking it; nothing when there is none of that name."""

    def read_program(self, path: str) -> tuple[str, str]:
        """Name and text of a program file."""

    def list_files(self, folder: str) -> Sequence[str]:
        """The files below a folder."""

    def write_file(self, path: str, text: str) -> None:
        """Write a text file."""


class AgentHost:
    """Runs one mind, and is its `jacaros.bdi.architecture.Architecture`.

    Args:
        name: of the agent.
        run: the run that it belongs to.
        seed: of the agent's own generator of random numbers.

    Attributes:
        queued: True while it waits for a turn; kept by the scheduler.
        mind: set before the first turn.
        body: what carries its actions out, None while there is none.
        make_body: makes the body for the first action; None in a project without environment.
        intercept: asked first about each action; True when it answers the action itself.  For tests.
        intercept_stop: the same for the end of the run.
        send: delivers a message; False when there is no such agent.
        run: lets the mind make up to so many cycles; True when there is more to do.
    """

    __slots__ = (
        "_coroutines",
        "_ended",
        "_mind",
        "_random",
        "_run",
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
    )

    def __init__(self, name: str, run: Run, seed: str) -> None:
        self.name = name
        self.queued = False
        self.body: Body | None = None
        self.make_body: Callable[[], Body] | None = None
        self.intercept: Callable[[Act], bool] | None = None
        self.intercept_stop: Callable[[float, int], bool] | None = None
        self._run = run
        self._scheduler = run.scheduler
        # These are called for every message and every turn: there is nothing to be done on their way.
        self.send: Callable[[SpeechAct], bool] = run.deliver
        self.run: Callable[[int], bool] = _no_turn
        self._seed = seed
        self._random: Random | None = None
        self._coroutines: Coroutines | None = None
        self._ended = False

    @property
    def mind(self) -> HostedMind:
        """Whose host it is."""
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
        """Let the mind make no further cycle, also when it is in the middle of its turn."""
        self._ended = True
        self._mind.stopped = True
        self.run = _no_turn

    def end(self) -> None:
        """Give up all actions, coroutines and focused artifacts."""
        if self._coroutines is not None:
            self._coroutines.cancel()
        if self.body is not None:
            self.body.close()

    async def close(self) -> None:
        """Wait until the coroutines have put their things in order."""
        if self._coroutines is not None:
            await self._coroutines.close()

    def receive(self, message: SpeechAct) -> None:
        """Hand a message to the mind."""
        if not self._ended:
            self._mind.receive(message)

    # From here on, the port `jacaros.bdi.architecture.Architecture`.

    def ready(self) -> None:
        """The mind has something to do."""
        if not self.queued:
            self._scheduler.make_ready(self)  # pyright: ignore[reportArgumentType]

    @property
    def random(self) -> Random:
        """The agent's own generator."""
        if self._random is None:
            self._random = Random(self._seed)
        return self._random

    def now(self) -> float:
        """Seconds since the Unix epoch on the run's clock."""
        return self._run.clock.now()

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* after *delay* seconds."""
        return AgentTimer(self._run.clock, self._run.activity, delay, callback)

    def start_coroutine(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> Timer:
        """Run a coroutine of the project's Python code beside the mind."""
        if self._coroutines is None:
            self._coroutines = Coroutines(self._run.activity)
        return self._coroutines.start(coroutine, ended)

    def act(self, act: Act) -> None:
        """Begin an external action; without an environment it fails at once."""
        if self.intercept is not None and act.functor is not NEEDS and self.intercept(act):
            return
        body = self.body or self.situated()
        if body is not None:
            body.act(act)
            self._scheduler.poll_soon()
        else:
            self._mind.complete(act.id, without_environment(act))

    def situated(self) -> Body | None:
        """The body, made when it is first asked for; None without an environment."""
        if self.body is None and self.make_body is not None:
            self.body = self.make_body()
        return self.body

    def cancel_act(self, act_id: int) -> None:
        """The intention behind an act was dropped."""
        if self.body is not None:
            self.body.cancel_act(act_id)

    def suspend_act(self, act_id: int) -> None:
        """The intention behind an act was suspended."""
        if self.body is not None:
            self.body.suspend_act(act_id)

    def resume_act(self, act_id: int) -> None:
        """The intention behind an act was resumed."""
        if self.body is not None:
            self.body.resume_act(act_id)

    def agent_names(self) -> Sequence[str]:
        """Names of all agents, in the order of their making."""
        return self._run.agent_names()

    def print(self, text: str) -> None:
        """Show a line of the program's output; an agent that has ended prints nothing more."""
        if not self._ended:
            self._run.console.print(self.name, text)

    def log(self, level: str, text: str) -> None:
        """Tell people about trouble, and what else the agent's option ``verbose`` lets through."""
        verbose = self._mind.options.verbose
        if verbose > 0 or level not in ("debug", "info"):
            # Details that an agent is to tell are wanted, whatever is shown of others.
            shown = "info" if level == "debug" and verbose > 1 else level
            self._run.console.log(f"[{self.name}] {level}: {text}", shown)

    def goal_lost(self) -> None:
        """A goal failed and no plan took over."""
        self._run.goal_lost()

    def out_of_memory(self) -> None:
        """A step or an event of the mind met a `MemoryError`."""
        self._run.out_of_memory(self.name)

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""
        if self.intercept_stop is None or not self.intercept_stop(delay, exit_code):
            self._run.stop_system(delay, exit_code)

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Make an agent."""
        return self._run.create_agent(name, source, classes)

    def explain(self, question: str) -> Mapping[str, Any]:
        """Answer a question about the run so far."""
        return self._run.explain(question, self.name)

    def clone_agent(self, name: str) -> str | None:
        """Make an agent with a copy of this one's mind."""
        return self._run.clone_agent(self.name, name)

    def kill_agent(self, name: str, delay: float = 0.0) -> bool:
        """End an agent."""
        return self._run.kill_agent(name, delay, self.name)

    def read_program(self, path: str) -> tuple[str, str]:
        """Name and text of a program file."""
        return self._run.read_program(path)

    def list_files(self, folder: str) -> Sequence[str]:
        """The files below a folder."""
        return self._run.list_files(folder)

    def write_file(self, path: str, text: str) -> None:
        """Write a text file."""
        self._run.write_file(path, text)

    def register_service(self, service: str) -> None:
        """This agent provides a service."""
        self._run.services.register(self.name, service)

    def deregister_service(self, service: str) -> None:
        """It does not any more."""
        self._run.services.deregister(self.name, service)

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service."""
        return self._run.services.providers(service)

    def subscribe_to_service(self, service: str) -> None:
        """Have this agent told of all providers of a service."""
        self._run.services.subscribe(self.name, service)


def _no_turn(fuel: int) -> bool:
    """There is no mind yet, or none any more."""
    del fuel
    return False


def without_environment(act: Act) -> Completion:
    """How an action ends in a project that has no environment."""
    text = (
        f"no artifact offers {act.functor!r}: the project has no environment "
        "(add the line `environment: jacaros.Environment` to the project file)"
    )
    reason = (_REASON, atom("no_environment"))
    return Completion(False, (), ((_ERROR_MSG, String(text)), reason))
