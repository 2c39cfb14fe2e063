"""The port to the fleet that a system has joined, for its history and its page."""

from collections.abc import Callable, Sequence
from typing import Protocol

from jacaros.look.records.records import MemberRecord


class Fleet(Protocol):
    """The fleet of a system. `jacaros.fleet.member.Member` is its implementation."""

    def members(self) -> Sequence[MemberRecord]:
        """Return all members, this system first."""

    def watch(self, watcher: Callable[[], None]) -> Callable[[], None]:
        """Call *watcher* whenever a member comes or goes. Return a function that ends this."""

    def traced(self, on: bool) -> None:
        """Hear that the run of this system is recorded, or no longer, so that others send causes."""

    def show_page(self, address: str) -> None:
        """Tell the others the address of the live page of this system; empty: it has none."""
