"""Who is there: the agents of a run by name."""

from collections.abc import Callable, Iterator, Sequence
from typing import Generic, TypeVar

H = TypeVar("H")


class Directory(Generic[H]):
    """The agents of a run, in the order of their making."""

    def __init__(self) -> None:
        self._hosts: dict[str, H] = {}
        self._names: tuple[str, ...] | None = ()
        self.find: Callable[[str], H | None] = self._hosts.get
        """The agent of a name, or None."""

    def add(self, name: str, host: H) -> None:
        """Enter an agent; the name must be free."""
        if name in self._hosts:
            raise ValueError(f"there is an agent {name} already")
        self._hosts[name] = host
        self._names = None

    def remove(self, name: str) -> H | None:
        """Take an agent out; None when there is none of that name."""
        host = self._hosts.pop(name, None)
        self._names = None
        return host

    def names(self) -> Sequence[str]:
        """All names."""
        if self._names is None:
            self._names = tuple(self._hosts)
        return self._names

    def free_name(self, wanted: str) -> str:
        """*wanted*, or ``wanted_1``, ``wanted_2`` … when it is taken."""
        name, number = wanted, 0
        while name in self._hosts:
            number += 1
            name = f"{wanted}_{number}"
        return name

    def __iter__(self) -> Iterator[H]:
        return iter(list(self._hosts.values()))

    def __len__(self) -> int:
        return len(self._hosts)
