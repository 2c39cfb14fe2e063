"""Agents written in Python: the base class."""

from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine, Mapping, Sequence
from functools import wraps
from inspect import iscoroutinefunction
from random import Random
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, Protocol, TypeVar, Unpack

from jacaros.agents.mind.state.act import Architecture, SpeechAct
from jacaros.agents.python.agent import Literal, ReceivedMessage, content_of, heard, overridden
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.values import Term
from jacaros.artifacts.env.values import text
from jacaros.artifacts.presence.presence import PropertyChange, ReceivedSignal
from jacaros.artifacts.presence.session import ActOptions, Session
from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import JacarosError

T = TypeVar("T")
P = ParamSpec("P")


class Mail(Protocol):
    """The messages of an agent written in Python: keeps agents from importing the run."""

    def say(self, receiver: str, performative: str, content: Term) -> None:
        """Send a message; raises `UnknownAgent`."""

    async def ask(self, receiver: str, performative: str, content: Term, timeout: float | None) -> SpeechAct:
        """Send a question and wait for the answer; raises `UnknownAgent` and TimeoutError."""

    async def next_message(self, timeout: float | None) -> ReceivedMessage:
        """Wait for the next message; raises TimeoutError."""


class Host(Architecture, Protocol):
    """What an agent written in Python may use of the code that runs it."""

    name: str
    options: Mapping[str, str]
    beliefs: tuple[Literal, ...]

    @property
    def mail(self) -> Mail:
        """Its messages."""

    @property
    def clock(self) -> Clock:
        """The run's clock."""

    @property
    def session(self) -> Session:
        """The agent's session in the environment."""

    def start(self, work: Coroutine[object, None, T]) -> Awaitable[T]:
        """Run a coroutine concurrently with `run`; the result can be awaited.

        It is cancelled when the agent ends. An exception in it ends the agent, as in `run`.
        """

    async def sleep(self, seconds: float) -> None:
        """Wait on the run's clock."""

    async def turn(self) -> None:
        """Let other agents run."""


def _of(part: str, method: Callable[Concatenate[Any, P], T]) -> Callable[Concatenate["PythonAgent", P], T]:
    """Return a method that forwards to the one of the agent's session or host."""

    @wraps(method)
    def call(agent: "PythonAgent", /, *arguments: P.args, **options: P.kwargs) -> T:
        result: T = getattr(getattr(agent, part), method.__name__)(*arguments, **options)
        return result

    return call


class PythonAgent:
    """An agent written in Python; to be subclassed.

    A project names the file of the subclass: ``agent painter: painter.py`` in a ``.jcm`` file, ``painter painter.py;``
    in a ``.mas2j`` file. `run` is the agent's behaviour. To use callbacks, override `on_message`, `on_signal` or
    `on_property` in addition, or instead. Take time from `sleep` and `clock` only, and random numbers from `random`:
    then a run with ``--clock fast`` and a seed is reproducible.

    When `run` returns, the agent stays, with all artifacts that it focuses. It ends with an exception in its code, when
    another agent ends it, or with the run. Then its running operations are cancelled, and its ``finally`` blocks run.
    """

    _host: Host

    def __init_subclass__(cls, **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        if not iscoroutinefunction(cls.run):
            raise TypeError(f"{cls.__name__}.run is not a coroutine: write async def run(self)")

    # --- what may be overridden ----------------------------------------------------------------------------

    async def run(self) -> None:
        """The agent's behaviour, called when the agent starts."""

    def on_message(self, message: ReceivedMessage) -> object:
        """Called with every message except answers to `ask`; ``def`` or ``async def``, one call at a time.

        If it does not reply to a question, its return value is the answer; None means that there is no answer.
        """

    def on_signal(self, signal: ReceivedSignal) -> object:
        """Called with every signal of focused artifacts; ``def`` or ``async def``, one call at a time."""

    def on_property(self, change: PropertyChange) -> object:
        """Called with every property change of focused artifacts, as `on_signal`."""

    def accept_kill(self, killer: str) -> bool:
        """Return whether the agent named *killer* may end this one with ``.kill_agent``."""
        return True

    # --- what it is ----------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The agent's name."""
        return self._host.name

    @property
    def options(self) -> Mapping[str, str]:
        """The agent's options in the project file: ``[speed=0.5]``, or ``speed: 0.5`` in a ``.jcm`` file."""
        return self._host.options

    @property
    def beliefs(self) -> tuple[Literal, ...]:
        """The literals that the project file lists as ``beliefs``."""
        return self._host.beliefs

    @property
    def session(self) -> Session:
        """The agent's working session in the environment.

        Raises:
            WorkspaceError: the project has no environment.
        """
        return self._host.session

    @property
    def clock(self) -> Clock:
        """The run's clock."""
        return self._host.clock

    @property
    def random(self) -> Random:
        """The agent's random number generator, seeded by the run."""
        return self._host.random

    # --- time and output -----------------------------------------------------------------------------------

    sleep = _of("_host", Host.sleep)
    start = _of("_host", Host.start)

    def print(self, *values: object) -> None:
        """Print the values as one line, without separators, as ``.print`` does."""
        self._host.print("".join(map(text, values)))

    def log(self, message: str, level: str = "info") -> None:
        """Log a message; *level* is ``debug``, ``info``, ``warning`` or ``error``."""
        self._host.log(level, message)

    # --- in the environment, as `Session` has it -------------------------------------------------------------

    def join(self, workspace: str) -> str:
        """Join a workspace and make it the current one; return its full path."""
        return self.session.join(workspace)

    quit = _of("session", Session.quit)
    make_artifact = _of("session", Session.make_artifact)
    lookup = _of("session", Session.lookup)
    focus = _of("session", Session.focus)
    focus_when_available = _of("session", Session.focus_when_available)
    stop_focus = _of("session", Session.stop_focus)
    begin = _of("session", Session.begin)
    value = _of("session", Session.value)
    values = _of("session", Session.values)
    has_property = _of("session", Session.has_property)
    properties = _of("session", Session.properties)

    async def act(self, operation: str, *arguments: object, **options: Unpack[ActOptions]) -> Any:
        """Run an operation, wait for its end, and return the values of its `Out` arguments; see `Session.act`.

        Raises:
            OperationFailed: with the message and the reason.
        """
        result = await self.begin(operation, *arguments, **options)
        # An operation may end immediately: let other agents run even if this one does nothing else.
        await self._host.turn()
        return result

    async def until(self, condition: Callable[[], T], timeout: float | None = None) -> T:
        """Wait until *condition* is true; it is tested whenever a focused artifact publishes a change.

        Raises:
            TimeoutError: it did not become true within *timeout* seconds.
        """
        value = await self.session.until(condition, timeout)
        await self._host.turn()
        return value

    # --- messages ------------------------------------------------------------------------------------------

    def send(self, receiver: str | Sequence[str], performative: str, content: object) -> None:
        """Send a message.

        Args:
            receiver: name of an agent, or several names.
            performative: ``tell``, ``achieve``, ``untell`` ….
            content: AgentSpeak as text (with ``tellHow`` and similar, the text of plans), a `Literal`,
                or another Python value.

        Raises:
            UnknownAgent: the receiver does not exist.
            AslError: the text is not AgentSpeak.
        """
        said = content_of(content, performative)
        for name in (receiver,) if isinstance(receiver, str) else receiver:
            self._host.mail.say(name, performative, rename(said))

    def broadcast(self, performative: str, content: object) -> None:
        """Send a message to all other agents."""
        self.send([name for name in self.agent_names() if name != self.name], performative, content)

    async def ask(
        self, receiver: str, question: object, performative: str = "askOne", timeout: float | None = None
    ) -> Any:
        """Ask an agent, and wait for the answer.

        Args:
            receiver: name of the agent.
            question: a text such as ``"position(X, Y)"``, or a `Literal`.
            performative: ``askOne``, ``askAll`` or ``askHow``.
            timeout: maximum time to wait, in seconds; None for no limit.

        Returns:
            For ``askOne`` a `Literal` (or another value), None if there is no answer; for the others a list.

        Raises:
            UnknownAgent: the receiver does not exist.
            TimeoutError: there was no answer in time.
            AslError: the text is not AgentSpeak.
        """
        answer = await self._host.mail.ask(
            receiver, performative, content_of(question, performative), timeout
        )
        if answer.performative == "untell":
            return None if performative in ("askOne", "ask-one") else []
        return heard(answer.content)

    async def receive(self, timeout: float | None = None) -> ReceivedMessage:
        """Wait for the next message; answers to `ask` are not included.

        Raises:
            TimeoutError: no message arrived within *timeout* seconds.
        """
        return await self._unread.next_message(timeout)

    def messages(self) -> AsyncIterator[ReceivedMessage]:
        """Iterate over all messages with ``async for``: those that have arrived, and future ones."""
        return _Messages(self._unread)

    @property
    def _unread(self) -> Mail:
        if overridden(self, PythonAgent, "on_message") is not None:
            raise JacarosError(
                f"{type(self).__name__} has on_message, which receives all messages, so none can be awaited"
            )
        return self._host.mail

    # --- other agents --------------------------------------------------------------------------------------

    def agent_names(self) -> tuple[str, ...]:
        """Return the names of all agents, in order of creation."""
        return tuple(self._host.system.agent_names())

    def create_agent(self, name: str, source: str | None = None, agent_class: str | None = None) -> str:
        """Create an agent and start it; return its name, which differs from *name* if that is taken.

        Args:
            name: of the agent.
            source: its program (``bob.asl``, ``bob.py``), by default NAME.asl.
            agent_class: its class, for an AgentSpeak agent as in ``ag-class``.

        Raises:
            JacarosError: it cannot be created; the reason is logged.
        """
        classes = {} if agent_class is None else {"agentClass": agent_class}
        made = self._host.system.create_agent(name, source, classes)
        if made is None:
            raise JacarosError(f"cannot create agent {name}; see the log for the reason")
        return made

    def kill_agent(self, name: str, delay: float = 0.0) -> bool:
        """End an agent after *delay* seconds; return False if it does not exist or refuses."""
        return self._host.system.kill_agent(name, delay, self.name)

    def stop_system(self, exit_code: int = 0, delay: float = 0.0) -> None:
        """End the run after *delay* seconds, with an exit code."""
        self._host.stop_system(delay, exit_code)

    def register_service(self, service: str) -> None:
        """Register a service that this agent provides with the directory facilitator."""
        self._host.system.services.register(self.name, service)

    def deregister_service(self, service: str) -> None:
        """Remove the registration."""
        self._host.system.services.deregister(self.name, service)

    def subscribe_to_service(self, service: str) -> None:
        """Subscribe this agent to the present and future providers of a service."""
        self._host.system.services.subscribe(self.name, service)

    def providers(self, service: str) -> tuple[str, ...]:
        """Return the agents that provide a service, in order of registration."""
        return tuple(self._host.system.services.providers(service))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> object:
            if name == "_host":
                raise JacarosError(
                    f"{type(self).__name__} has not started yet: do this in run, not in __init__"
                )
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}", name=name, obj=self)


class _Messages:
    """The messages of an agent, as an endless asynchronous iterator."""

    def __init__(self, mail: Mail) -> None:
        self._mail = mail

    def __aiter__(self) -> "_Messages":
        return self

    async def __anext__(self) -> ReceivedMessage:
        return await self._mail.next_message(None)
