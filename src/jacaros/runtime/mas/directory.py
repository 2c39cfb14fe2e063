"""Names of agents, delivery of messages, and the directory facilitator.

A message between agents arrives once, in the order of sending, as a copy. The directory facilitator is an agent,
``df``, as in Jason, created at its first use. Its knowledge is its belief base, so agents can query it.

Other participants use the same ports: agents of other processes, and Python code with a mailbox. Nothing here waits:
requests to another process are sent, and lookups are answered from local knowledge.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from typing import Protocol

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import belief_update
from jacaros.agents.mind.rules.proc_msg import UNDELIVERED
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.collections import detached, holds_collection
from jacaros.agents.terms.substitution import is_ground, rename
from jacaros.agents.terms.values import BY_SELF, Annotated, String, Term, atom, functor
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import entered
from jacaros.runtime.trace import Cause


class Mailbox(Protocol):
    """The mailbox of one participant."""

    def receive(self, message: SpeechAct) -> None:
        """Receive a message, or forward it. Return soon.

        A message that later turns out to be undeliverable is passed to `Mailboxes.returned`.

        Raises:
            Failure: the mailbox is full.
        """


class Participants(Protocol):
    """Participants of the system other than agents of this run."""

    def names(self) -> Sequence[str]:
        """Return the known names, in a stable order."""

    def find(self, name: str) -> Mailbox | None:
        """Return the mailbox of a name, or None if it is not among the `names`."""


class Directory:
    """The agents of a run, in the order of creation, and then its other participants.

    Attributes:
        find: returns the agent with a name, or None.
    """

    def __init__(self) -> None:
        self._hosts: dict[str, AgentHost] = {}
        self._names: tuple[str, ...] | None = ()
        self._others: list[Participants] = []
        self._elsewhere: list[Participants] = []
        self._watchers: list[Callable[[str, bool], None]] = []
        self.find: Callable[[str], AgentHost | None] = self._hosts.get

    def add(self, name: str, host: AgentHost) -> None:
        """Add an agent. Its name must be free."""
        if self._is_taken(name):
            raise ValueError(f"duplicate agent name `{name}`")
        self._hosts[name] = host
        self._changed(name, True)

    def remove(self, name: str) -> AgentHost | None:
        """Remove an agent and return it, or None if it is unknown."""
        host = self._hosts.pop(name, None)
        if host is not None:
            self._changed(name, False)
        return host

    def watch(self, watcher: Callable[[str, bool], None]) -> Callable[[], None]:
        """Call *watcher* with the name of every agent that is added (True) or removed. Return a function that ends this."""
        return entered(self._watchers, watcher)

    def _changed(self, name: str, present: bool) -> None:
        self._names = None
        for watcher in tuple(self._watchers):
            watcher(name, present)

    def join(self, others: Participants, elsewhere: bool = False) -> Callable[[], None]:
        """Add other participants. Return a function that removes them.

        Args:
            others: the participants.
            elsewhere: they are of other systems, so an agent may have the name of one of them, and is found first.
        """
        place = self._elsewhere if elsewhere else self._others
        place.append(others)
        return lambda: place.remove(others) if others in place else None

    def find_other(self, name: str) -> Mailbox | None:
        """Return the mailbox of a participant that is not an agent of this run, or None."""
        return self._found(name, self._others) or self._found(name, self._elsewhere)

    def find_here(self, name: str) -> Mailbox | None:
        """Return the mailbox of an agent or participant of this system, or None."""
        return self._hosts.get(name) or self._found(name, self._others)

    def _found(self, name: str, places: Sequence[Participants]) -> Mailbox | None:
        for others in places:
            found = others.find(name)
            if found is not None:
                return found
        return None

    def names(self) -> Sequence[str]:
        """Return the names of all agents and other participants."""
        if self._names is None:
            self._names = tuple(self._hosts)
        if self._others or self._elsewhere:
            others = (*self._others, *self._elsewhere)
            return (*self._names, *(name for each in others for name in each.names()))
        return self._names

    def free_name(self, wanted: str) -> str:
        """Return *wanted*, or ``wanted_1``, ``wanted_2`` … if it is in use."""
        name, number = wanted, 0
        while self._is_taken(name) or self._found(name, self._elsewhere) is not None:
            number += 1
            name = f"{wanted}_{number}"
        return name

    def _is_taken(self, name: str) -> bool:
        return self.find_here(name) is not None

    def __iter__(self) -> Iterator[AgentHost]:
        return iter(list(self._hosts.values()))

    def __len__(self) -> int:
        return len(self._hosts)


class Mailboxes:
    """Delivers messages between agents.

    Args:
        find: returns the mailbox of an agent, or None.
        find_other: the same for other participants. Called after *find*.

    Attributes:
        observer: called with each delivered message and what led to it in another system (None: its sender is here), or
            None.
    """

    def __init__(
        self,
        find: Callable[[str], Mailbox | None],
        find_other: Callable[[str], Mailbox | None] = lambda name: None,
    ) -> None:
        self._find = find
        self._find_other = find_other
        self.observer: Callable[[SpeechAct, Cause | None], None] | None = None

    def deliver(self, message: SpeechAct, cause: Cause | None = None) -> bool:
        """Put *message* into the mailbox of its receiver. Return False if the receiver is unknown.

        Variables are renamed apart, and sets, maps and queues are copied, so that the receiver shares no state with the
        sender.

        Args:
            message: the message.
            cause: what led to it in another system.

        Raises:
            Failure: the mailbox is full. The sending step fails.
        """
        receiver = self._find(message.receiver)
        if receiver is None:
            receiver = self._find_other(message.receiver)
            if receiver is None:
                return False
        if not message.flat:
            message = _parted(message)
        if self.observer is not None:
            self.observer(message, cause)
        receiver.receive(message)
        return True

    def returned(self, message: SpeechAct, reason: str = "receiver_not_found") -> None:
        """Report to the sender of an accepted message that it did not reach its receiver.

        The sender gets a message ``undelivered`` about it, with the content ``undelivered(Content,Reason)``. A question
        that it waits for fails with ``error(Reason)``.

        Args:
            message: the message.
            reason: why: ``receiver_not_found``, ``mailbox_full``, ``not_permitted``, ``member_lost``, ``malformed``, or
                ``unconfirmed`` if it may have arrived.
        """
        sender = self._find(message.sender)
        if sender is not None:
            id = f"{message.id}_undelivered"
            content = (UNDELIVERED, message.content, atom(reason))
            told = ("undelivered", message.receiver, message.sender, content, id, message.id)
            # No step could fail here, so a sender whose mailbox is full gets no report.
            with suppress(Failure):
                sender.receive(SpeechAct(*told))


def _parted(message: SpeechAct) -> SpeechAct:
    """Return the message with a copy of its content that shares nothing that can be bound or changed."""
    content = message.content
    if not is_ground(content):
        content = rename(content)
    if holds_collection(content):
        content = detached(content)
    return message if content is message.content else message.with_content(content)


NAME = "df"
_PROVIDER, _SUBSCRIBE = functor("provider", 2), functor("subscribe", 2)

ParticipantWatcher = Callable[[str, str, bool], None]
"""Called with an agent, a service, and whether the agent provides it from now on."""


class ServiceDirectory:
    """Keeps providers and subscribers of services. It is the `Services` of a run.

    Args:
        make: creates the agent that keeps them.
        deliver: delivers a message.
    """

    def __init__(self, make: Callable[[], Mind], deliver: Callable[[SpeechAct], bool]) -> None:
        self._make = make
        self._deliver = deliver
        self._watchers: list[ParticipantWatcher] = []

    @cached_property
    def agent(self) -> Mind:
        """The agent, created on first use."""
        return self._make()

    def register(self, name: str, service: str) -> None:
        """Register an agent as provider of a service, and notify the subscribers."""
        if name not in self.providers(service):
            belief_update.tell(self.agent, (_PROVIDER, atom(name), String(service)))
            self._changed(name, service, True)
        for subscriber in self._held(_SUBSCRIBE, service):
            self._tell(subscriber, name, service)

    def deregister(self, name: str, service: str) -> None:
        """Deregister an agent as provider of a service."""
        believed = Annotated((_PROVIDER, atom(name), String(service)), BY_SELF)
        belief_update.untell(self.agent, believed)
        self._changed(name, service, False)

    def providers(self, service: str) -> Sequence[str]:
        """Return the providers of a service, in the order of registration."""
        return self._held(_PROVIDER, service)

    def subscribe(self, name: str, service: str) -> None:
        """Subscribe an agent to all providers, beginning with the present ones."""
        if name not in self._held(_SUBSCRIBE, service):
            belief_update.tell(self.agent, (_SUBSCRIBE, atom(name), String(service)))
        for provider in self.providers(service):
            self._tell(name, provider, service)

    def watch(self, watcher: ParticipantWatcher) -> Callable[[], None]:
        """Call *watcher* whenever an agent begins (True) or ceases (False) to provide a service. Return a function that
        ends this.

        For copies elsewhere.
        """
        return entered(self._watchers, watcher)

    def _changed(self, name: str, service: str, provides: bool) -> None:
        for watcher in tuple(self._watchers):
            watcher(name, service, provides)

    def _held(self, symbol: Term, service: str) -> list[str]:
        rows = [row for row, _ in self.agent.beliefs[symbol].entries() if isinstance(row, tuple)]
        return [row[0].name for row in reversed(rows) if row[1] == String(service)]

    def _tell(self, receiver: str, provider: str, service: str) -> None:
        content = (_PROVIDER, atom(provider), String(service))
        self._deliver(SpeechAct("tell", NAME, receiver, content, self.agent.next_message_id(), None))
