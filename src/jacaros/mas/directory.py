"""Who is there, where messages go, and who provides which service.

A message between agents arrives once, in the order of sending, as a copy of its own.  The directory facilitator is an
agent, ``df``, as in Jason, made at its first use: what it knows are its beliefs, so it can be asked.

Whatever takes part besides the agents of this process stands behind the same ports: agents of other processes, Python code
with a mailbox of its own.  Nothing here waits: what is asked of another process is sent, what is asked about it is answered
from what is known here.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Generic, Protocol, TypeVar

from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import belief_update
from jacaros.bdi.state.plan import Failure
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.terms.collections import detached, holds_collection
from jacaros.terms.substitution import is_ground, rename
from jacaros.terms.values import BY_SELF, Annotated, String, Term, atom, functor


class Mailbox(Protocol):
    """Where the messages for one participant go."""

    def receive(self, message: SpeechAct) -> None:
        """Take a message in, or send it on its way; return soon.

        A message that turns out later not to reach its receiver is given to `Mailboxes.returned`.

        Raises:
            Failure: the mailbox is full.
        """


class Participants(Protocol):
    """Participants of the system that are not agents of this run; their names are those of no agent of it."""

    def names(self) -> Sequence[str]:
        """The names known by now, in an order that stays."""

    def find(self, name: str) -> Mailbox | None:
        """Where the messages for a name go; None when it is not among the `names`."""


class Services(Protocol):
    """The directory facilitator: who provides which service."""

    def register(self, name: str, service: str) -> None:
        """An agent provides a service; its subscribers are told."""

    def deregister(self, name: str, service: str) -> None:
        """It does not any more."""

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service, as far as is known by now, in the order of their registration."""

    def subscribe(self, name: str, service: str) -> None:
        """An agent wants to be told of all providers of a service, by messages."""


H = TypeVar("H")


class Directory(Generic[H]):
    """The agents of a run, in the order of their making, and after them its other participants.

    Attributes:
        find: the agent of a name, or None.
    """

    def __init__(self) -> None:
        self._hosts: dict[str, H] = {}
        self._names: tuple[str, ...] | None = ()
        self._others: list[Participants] = []
        self._watchers: list[Callable[[str, bool], None]] = []
        self.find: Callable[[str], H | None] = self._hosts.get

    def add(self, name: str, host: H) -> None:
        """Enter an agent; the name must be free."""
        if self._is_taken(name):
            raise ValueError(f"duplicate agent name {name}")
        self._hosts[name] = host
        self._changed(name, True)

    def remove(self, name: str) -> H | None:
        """Take an agent out; None when there is none of that name."""
        host = self._hosts.pop(name, None)
        if host is not None:
            self._changed(name, False)
        return host

    def watch(self, watcher: Callable[[str, bool], None]) -> Callable[[], None]:
        """Call *watcher* with the name of every agent of this run that comes (True) or goes; gives what ends that."""
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher) if watcher in self._watchers else None

    def _changed(self, name: str, present: bool) -> None:
        self._names = None
        for watcher in tuple(self._watchers):
            watcher(name, present)

    def join(self, others: Participants) -> Callable[[], None]:
        """Let others take part; gives what ends that."""
        self._others.append(others)
        return lambda: self._others.remove(others) if others in self._others else None

    def find_other(self, name: str) -> Mailbox | None:
        """Where the messages for a participant go that is no agent of this run; None when there is none."""
        for others in self._others:
            found = others.find(name)
            if found is not None:
                return found
        return None

    def names(self) -> Sequence[str]:
        """The names of all agents and other participants."""
        if self._names is None:
            self._names = tuple(self._hosts)
        if self._others:
            return (*self._names, *(name for others in self._others for name in others.names()))
        return self._names

    def free_name(self, wanted: str) -> str:
        """*wanted*, or ``wanted_1``, ``wanted_2`` … when it is taken."""
        name, number = wanted, 0
        while self._is_taken(name):
            number += 1
            name = f"{wanted}_{number}"
        return name

    def _is_taken(self, name: str) -> bool:
        return name in self._hosts or self.find_other(name) is not None

    def __iter__(self) -> Iterator[H]:
        """The agents of this run."""
        return iter(list(self._hosts.values()))

    def __len__(self) -> int:
        return len(self._hosts)


class Mailboxes:
    """Delivers what agents say to each other.

    Args:
        find: from an agent's name to where its messages go, None when there is no such agent.
        find_other: the same for participants that are no agents of this run; asked after *find*.

    Attributes:
        observer: called with each message that is delivered, or None.
    """

    def __init__(
        self,
        find: Callable[[str], Mailbox | None],
        find_other: Callable[[str], Mailbox | None] = lambda name: None,
    ) -> None:
        self._find = find
        self._find_other = find_other
        self.observer: Callable[[SpeechAct], None] | None = None

    def deliver(self, message: SpeechAct) -> bool:
        """Put *message* into the mailbox of its receiver; False when nobody of that name is known.

        Variables are renamed apart, and sets, maps and queues copied: what the receiver binds or changes stays
        unknown to the sender.

        Raises:
            Failure: the mailbox is full; the step that sends fails.
        """
        receiver = self._find(message.receiver)
        if receiver is None:
            receiver = self._find_other(message.receiver)
            if receiver is None:
                return False
        if not message.flat:
            message = _parted(message)
        if self.observer is not None:
            self.observer(message)
        receiver.receive(message)
        return True

    def returned(self, message: SpeechAct) -> None:
        """Tell the sender of a message that was accepted that it did not reach its receiver.

        It gets a message ``undelivered`` about it.  A question that it waits for fails with ``receiver_not_found``.
        """
        sender = self._find(message.sender)
        if sender is not None:
            id = f"{message.id}_undelivered"
            told = ("undelivered", message.receiver, message.sender, message.content, id, message.id)
            # Whoever reports it runs no step that could fail: a sender whose mailbox is full does not learn of it.
            with suppress(Failure):
                sender.receive(SpeechAct(*told))


def _parted(message: SpeechAct) -> SpeechAct:
    """The message with a content that shares nothing that can be bound or changed."""
    content = message.content
    if not is_ground(content):
        content = rename(content)
    if holds_collection(content):
        content = detached(content)
    return message if content is message.content else message.with_content(content)


NAME = "df"
_PROVIDER, _SUBSCRIBE = functor("provider", 2), functor("subscribe", 2)

Watcher = Callable[[str, str, bool], None]
"""Told of an agent, a service, and whether the agent provides it from now on."""


class ServiceDirectory:
    """Keeps providers and subscribers of services; it is the `Services` of a run.

    Args:
        make: makes the agent that keeps them.
        deliver: brings a message to its receiver.
    """

    def __init__(self, make: Callable[[], Mind], deliver: Callable[[SpeechAct], bool]) -> None:
        self._make = make
        self._deliver = deliver
        self._agent: Mind | None = None
        self._watchers: list[Watcher] = []

    @property
    def agent(self) -> Mind:
        """The agent, made when it is first asked for."""
        if self._agent is None:
            self._agent = self._make()
        return self._agent

    def register(self, name: str, service: str) -> None:
        """An agent provides a service; its subscribers are told."""
        if name not in self.providers(service):
            belief_update.tell(self.agent, (_PROVIDER, atom(name), String(service)))
            self._changed(name, service, True)
        for subscriber in self._held(_SUBSCRIBE, service):
            self._tell(subscriber, name, service)

    def deregister(self, name: str, service: str) -> None:
        """It does not any more."""
        believed = Annotated((_PROVIDER, atom(name), String(service)), BY_SELF)
        belief_update.untell(self.agent, believed)
        self._changed(name, service, False)

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service, in the order of their registration."""
        return self._held(_PROVIDER, service)

    def subscribe(self, name: str, service: str) -> None:
        """An agent wants to be told of all providers; of those there are it is told now."""
        if name not in self._held(_SUBSCRIBE, service):
            belief_update.tell(self.agent, (_SUBSCRIBE, atom(name), String(service)))
        for provider in self.providers(service):
            self._tell(name, provider, service)

    def watch(self, watcher: Watcher) -> Callable[[], None]:
        """Call *watcher* whenever an agent begins (True) or ceases (False) to provide a service; gives what ends that.

        For those that keep a copy elsewhere.
        """
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher) if watcher in self._watchers else None

    def _changed(self, name: str, service: str, provides: bool) -> None:
        for watcher in tuple(self._watchers):
            watcher(name, service, provides)

    def _held(self, symbol: Term, service: str) -> list[str]:
        rows = [row for row, _ in self.agent.beliefs[symbol].entries() if isinstance(row, tuple)]
        return [row[0].name for row in reversed(rows) if row[1] == String(service)]

    def _tell(self, receiver: str, provider: str, service: str) -> None:
        content = (_PROVIDER, atom(provider), String(service))
        self._deliver(SpeechAct("tell", NAME, receiver, content, self.agent.next_message_id(), None))
