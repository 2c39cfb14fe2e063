"""Who is there: the agents of a run by name, and whoever else takes part."""

from collections.abc import Callable, Iterator, Sequence
from typing import Generic, TypeVar

from jacaros.mas.ports import Mailbox, Participants

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
            raise ValueError(f"there is an agent {name} already")
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
