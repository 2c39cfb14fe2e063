"""The port of a mind to whatever runs it (Jason's agent architecture).

A mind does no input or output of its own: it is given things by `Agent.receive`, `Agent.perceive` and
`Agent.complete`, and reaches out through this port alone.
"""

from collections.abc import Callable, Coroutine, Mapping, Sequence
from random import Random
from typing import Any, Protocol

from jacaros.bdi.state.act import Act
from jacaros.bdi.state.speech_act import SpeechAct


class Timer(Protocol):
    """A call that is to come."""

    def cancel(self) -> None:
        """Take it back."""


class AgentSystem(Protocol):
    """What agents of every kind ask of the system that they live in."""

    def agent_names(self) -> Sequence[str]:
        """Names of all agents of the system, in the order of their making."""

    def print(self, text: str) -> None:
        """Show a line of the program's output."""

    def log(self, level: str, text: str) -> None:
        """Tell people about trouble; *level* is ``debug``, ``info``, ``warning`` or ``error``."""

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Make an agent (from the program file *source*, default NAME.asl); its final name, or None with the
        reason logged.

        *classes* are the classes of the project that it is of, by ``agentClass``, ``agentArchClass`` and
        ``beliefBaseClass``.
        """

    def kill_agent(self, name: str, delay: float = 0.0) -> bool:
        """End an agent after *delay* seconds; False when there is none of that name, or it does not accept."""

    def register_service(self, service: str) -> None:
        """Tell the directory facilitator that this agent provides a service."""

    def deregister_service(self, service: str) -> None:
        """Take that back."""

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service, in the order in which they registered."""

    def subscribe_to_service(self, service: str) -> None:
        """Have this agent told of all providers of a service, those to come as well."""


class Architecture(AgentSystem, Protocol):
    """What a mind asks of its host.  No call may enter the agent again before it returns."""

    @property
    def random(self) -> Random:
        """The agent's own generator, seeded by the run."""

    def now(self) -> float:
        """Seconds since the Unix epoch on the run's clock."""

    def ready(self) -> None:
        """The agent has something to do: `Agent.run` is to be called soon."""

    def set_timer(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* after *delay* seconds of the run's clock."""

    def start_coroutine(
        self, coroutine: Coroutine[Any, Any, Any], ended: Callable[[object, BaseException | None], None]
    ) -> Timer:
        """Run a coroutine of the project's Python code beside the agent.

        *ended* is told what it returned, or the exception that ended it; not after it was cancelled.
        """

    def act(self, act: Act) -> None:
        """Begin an external action; `Agent.complete` tells its end (later, or from within this call)."""

    def cancel_act(self, act_id: int) -> None:
        """The intention behind a pending act was dropped."""

    def suspend_act(self, act_id: int) -> None:
        """The intention behind a pending act was suspended."""

    def resume_act(self, act_id: int) -> None:
        """The intention behind a pending act was resumed."""

    def send(self, message: SpeechAct) -> bool:
        """Deliver a message; False when there is no such agent."""

    def goal_lost(self) -> None:
        """A goal failed and no plan took over; the warning comes by `log`."""

    def out_of_memory(self) -> None:
        """A step or an event met a `MemoryError`; the agent goes on as long as it is let."""

    def explain(self, question: str) -> Mapping[str, Any]:
        """Answer a question about the run so far; plain data, as `jacaros.mas.history.Explanation.data` returns it.

        Raises:
            UsageError: the question is not understood.
        """

    def clone_agent(self, name: str) -> str | None:
        """Make an agent with a copy of this mind; its final name, or None with the reason logged."""

    def read_program(self, path: str) -> tuple[str, str]:
        """Name and text of a program file (for ``.include``).

        Raises:
            FileNotFoundError: when there is none.
        """

    def list_files(self, folder: str) -> Sequence[str]:
        """The files in a folder and in the folders in it, as paths that begin with *folder*, sorted.

        Raises:
            OSError: when it cannot be read.
        """

    def write_file(self, path: str, text: str) -> None:
        """Write a text file; what it held before is gone.

        Raises:
            OSError: when it cannot be written.
        """
