"""Agents of other members, under names that are unique here.

``bob@lab`` is the agent bob of the member lab. A bare name works where it is unique; here, an agent of this member is
meant by it first.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol

from jacaros.agents.mind.state.act import SpeechAct
from jacaros.runtime.mas.directory import Mailbox


class Post(Protocol):
    """The way of messages to one member."""

    def post(self, message: SpeechAct, receiver: str) -> None:
        """Send a message to its agent *receiver*. Raises `Failure` if that is impossible now."""


class _RemoteMailbox:
    """The mailbox of an agent of another member."""

    def __init__(self, post: Post, name: str) -> None:
        self._post, self._name = post, name

    def receive(self, message: SpeechAct) -> None:
        """Send a message on its way."""
        self._post.post(message, self._name)


class _OwnMailbox:
    """The mailbox of an agent of this member, under its full name."""

    def __init__(self, mailbox: Mailbox, name: str) -> None:
        self._mailbox, self._name = mailbox, name

    def receive(self, message: SpeechAct) -> None:
        """Receive a message."""
        self._mailbox.receive(replace(message, receiver=self._name, _id=message.id))


class FleetAgents:
    """The agents of all other members, as participants of this one.

    Args:
        member: name of this member.
        find_own: returns the mailbox of an agent of this member, or None.
        report: writes a warning into the log.
        renamed: called with the bare name of agents that may be called otherwise from now on.
    """

    def __init__(
        self,
        member: str,
        find_own: Callable[[str], Mailbox | None],
        report: Callable[[str], None],
        renamed: Callable[[str], None],
    ) -> None:
        self._member, self._find_own, self._report, self._renamed = member, find_own, report, renamed
        self._posts: dict[str, Post] = {}
        self._holders: dict[str, dict[str, _RemoteMailbox]] = {}
        self._away: dict[str, set[str]] = {}

    def names(self) -> Sequence[str]:
        """Return the names of all agents of other members, as they are called here."""
        return [self._called(name, member) for name, members in self._holders.items() for member in members]

    def _called(self, name: str, member: str) -> str:
        is_unique = len(self._holders.get(name, ())) == 1 and self._find_own(name) is None
        return name if is_unique else f"{name}@{member}"

    def called(self, name: str, member: str) -> str:
        """Return how an agent of another member is called here, such as ``bob`` or ``bob@lab``."""
        holders = self._holders.get(name, ())
        if member in holders:
            return self._called(name, member)
        # After a cut, messages come before the member has said again which agents it has.
        is_unique = name in self._away.get(member, ()) and not holders and self._find_own(name) is None
        return name if is_unique else f"{name}@{member}"

    def of(self, member: str) -> list[str]:
        """Return the names that the agents of another member have there."""
        return [name for name, members in self._holders.items() if member in members]

    def find(self, name: str) -> Mailbox | None:
        """Return the mailbox of an agent, by its bare or full name. None if it does not exist, or more than one has it."""
        bare, at, member = name.rpartition("@")
        if at:
            return self._find_at(bare, member)
        holders = self._holders.get(name, {})
        return next(iter(holders.values())) if len(holders) == 1 else None

    def _find_at(self, name: str, member: str) -> Mailbox | None:
        if member == self._member:
            own = self._find_own(name)
            return None if own is None else _OwnMailbox(own, name)
        post = self._posts.get(member)
        return None if post is None else _RemoteMailbox(post, name)

    def came(self, member: str, post: Post) -> None:
        """A member answers: its agents can be reached."""
        self._posts[member] = post
        self.forget(member)

    def went(self, member: str) -> None:
        """A member does not answer."""
        self._posts.pop(member, None)
        names = self.of(member)
        self._away.setdefault(member, set()).update(names)
        for name in names:
            self.know(name, member, False)

    def forget(self, member: str) -> None:
        """Forget which agents a member had before it was lost."""
        self._away.pop(member, None)

    def know(self, name: str, member: str, present: bool) -> None:
        """Hear that a member has an agent, or no longer. A name with ``@`` would be that of an agent of another member."""
        if "@" in name:
            return
        if not present:
            members = self._holders.get(name, {})
            members.pop(member, None)
            if not members:
                self._holders.pop(name, None)
            elif len(members) == 1:
                self._renamed(name)
        elif member in self._posts:
            members = self._holders.setdefault(name, {})
            members[member] = _RemoteMailbox(self._posts[member], name)
            if len(members) > 1:
                self._renamed(name)
            self.check(name)

    def check(self, name: str) -> None:
        """Report an agent whose bare name is not unique."""
        holders = list(self._holders.get(name, ()))
        if self._find_own(name) is not None:
            holders.append(self._member)
        if len(holders) < 2:
            return
        full = " and ".join(f"{name}@{each}" for each in sorted(holders))
        meant = f"; here, `{name}` is {name}@{self._member}" if self._member in holders else ""
        self._report(f"the name of agent {name} is not unique in the fleet: write {full}{meant}")
