"""One system as a member of a fleet."""

import os
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from secrets import token_hex

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.artifacts.env.values import Structure
from jacaros.fleet import fleet_artifact, protocol
from jacaros.fleet.agents import FleetAgents
from jacaros.fleet.announced import Announced
from jacaros.fleet.artifacts import ArtifactNames
from jacaros.fleet.carrier import Carrier, MemberId
from jacaros.fleet.causes import Causes
from jacaros.fleet.channel import Malformed, read_packet
from jacaros.fleet.names import one_line
from jacaros.fleet.peer import Peer
from jacaros.fleet.rights import Rights
from jacaros.fleet.visits import Visits, is_visitor
from jacaros.look.records.records import MemberRecord
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import aside, help_line
from jacaros.runtime.mas.directory import NAME as DIRECTORY_NAME
from jacaros.runtime.mas.system import System
from jacaros.runtime.timers import Timer

SILENCE = 2.0
"""Seconds after which a member that says nothing is lost. Its loop may be blocked while its network answers."""
PING = 0.5
"""Seconds between signs of life."""
MEMORY = 60.0
"""Seconds for which messages and focuses wait for a lost member to return."""
GOODBYE = 0.5
"""Seconds for which the end of a member waits until the others have what it said last."""
_DEPARTED = 100
"""Runs that have ended whose last datagrams are ignored."""
_FORMER = 8
"""Lost runs whose names others have taken, and which are known if they return."""
_MOST = 1000
"""Other members, and different warnings, at most."""

WhenChanged = Callable[[str, str], None]
"""Called with the name and the new state of a member: ``joined``, ``lost`` or ``left``."""


def new_id(name: str) -> MemberId:
    """Return the id of a run that begins now."""
    return MemberId(name, f"{time.time_ns():016x}{os.getpid() & 0xFFFF:04x}{token_hex(2)}")


class Member:
    """Joins a system to a fleet.

    Args:
        system: the system.
        carrier: its network.
        me: this run.
        rights: what other members may do here.
        silence: seconds after which a member that says nothing is lost.

    Attributes:
        peers: other members by name, also lost ones.
        watchers: called whenever a member comes or goes, and when the offset of its clock changes.
    """

    def __init__(
        self, system: System, carrier: Carrier, me: MemberId, rights: Rights, silence: float = SILENCE
    ) -> None:
        self.me = me
        self.peers: dict[str, Peer] = {}
        self.watchers: list[WhenChanged] = []
        self._system, self._carrier, self._rights = system, carrier, rights
        self._silence = silence
        self._pulse_at = 0.0
        self._reported: set[str] = set()
        self._timer: Timer | None = None
        self._forgetting: dict[MemberId, Timer] = {}
        self._former: dict[MemberId, Peer] = {}
        self._departed: deque[MemberId] = deque(maxlen=_DEPARTED)
        self._rival: MemberId | None = None
        self._names = ArtifactNames(me.incarnation, self._path_of)
        self._agents = FleetAgents(me.name, system.directory.find, self._warn, self._renamed)
        self._causes = Causes(system, me.name)
        self._announced = Announced(system, self._names, self._tell)
        send, picture = carrier.send, partial(self._announced.picture, 1, 0)
        self._visits = Visits(system.clock, send, picture, rights, self._stopped)
        self._ends: list[Callable[[], object]] = []

    def _warn(self, text: str, about: str = "") -> None:
        line = one_line(text)
        if (about or line) not in self._reported and len(self._reported) < _MOST:
            self._reported.add(about or line)
            self._system.console.log(f"[fleet] {line}", "warning")

    def _path_of(self, run: str, workspace: str) -> str:
        peer = next((each for each in self.peers.values() if each.id.incarnation == run), None)
        return workspace if peer is None else peer.path_of(workspace)

    # ---- its life

    async def join(self) -> None:
        """Join the fleet: others know what this member has, and it learns what they have.

        Raises:
            UsageError: the network cannot be used, or another member has the name.
        """
        directory = self._system.directory
        self._ends.append(directory.join(self._agents, elsewhere=True))
        self._ends.append(directory.watch(self._agent_news))
        self._ends.append(self._announced.end)
        self._ends.append(self._system.when_situated(self._situated))
        await self._carrier.open(self.me, self)
        self._pulse_at = self._system.clock.elapsed
        if not await self._is_alone():
            await self.leave()
            help = help_line("choose another name with --member")
            raise UsageError(f"the fleet has a member called {self.me.name} already\n{help}")
        self._system.fleet = self
        self._pulse()

    async def _is_alone(self) -> bool:
        """Return whether no other member has the name of this one. A run that has just been killed may still be known."""
        patience = self._system.clock.elapsed + self._silence + 1.0
        while self._rival is not None and self._system.clock.elapsed < patience:
            await self._system.clock.sleep(0.05)
        return self._rival is None

    async def leave(self) -> None:
        """Leave the fleet, after the others have got what was said last."""
        for end in self._ends:
            end()
        self._ends.clear()
        self._system.fleet = None
        there = [each for each in self.peers.values() if each.is_there]
        for peer in there:
            peer.say(protocol.Bye())
        clock = self._system.clock
        patience = clock.elapsed + GOODBYE
        while sum(each.backlog for each in there) + self._visits.backlog and clock.elapsed < patience:
            await clock.sleep(0.01)
        for timer in (self._timer, *self._forgetting.values()):
            if timer is not None:
                timer.cancel()
        for peer in list(self.peers.values()):
            peer.lose("left")
        self._visits.end()
        await self._carrier.close()

    def _stopped(self, visitor: str) -> None:
        self._system.console.log(f"[fleet] stopped by {visitor}")
        self._system.end(0)

    # ---- what agents perceive

    def states(self) -> fleet_artifact.States:
        """Return the states of all other members, and the offsets of their clocks."""
        return {
            name: (each.state, each.channel.clocks.noted) for name, each in self.peers.items() if each.state
        }

    def watch(self, watcher: Callable[[], None]) -> Callable[[], None]:
        """Call *watcher* whenever `states` may have changed. Return a function that ends this."""

        def changed(name: str, state: str) -> None:
            watcher()

        self.watchers.append(changed)
        return lambda: self.watchers.remove(changed)

    def _situated(self, environment: Environment) -> None:
        """Show the members in the environment of this one, and in no other; let agents create workspaces at them."""
        environment.create_elsewhere = partial(self._create_workspace, environment)
        main, name = environment.workspace("/main"), fleet_artifact.NAME
        if any(each.name == name for each in main.artifacts()):
            self._warn(f"agents do not perceive the members: the project has an artifact `{name}`")
        else:
            main.offer(name, fleet_artifact.Fleet, (self.me.name, self.states, self.watch), personal=True)

    async def _create_workspace(self, environment: Environment, path: str, member: str) -> None:
        if member == self.me.name:
            environment.create_workspace(path)
            return
        peer = self.peers.get(member)
        if peer is None or not peer.is_there:
            known = [self.me.name, *(each.name for each in self.peers.values() if each.is_there)]
            message = f"unknown member `{member}`{aside(member, known)}"
            raise OperationFailed(message, Structure("unknown_member", (member,)))
        await peer.create_workspace(path)

    # ---- news for the others

    def _agent_news(self, name: str, present: bool) -> None:
        if name != DIRECTORY_NAME:
            self._renamed(name)
            if present:
                self._agents.check(name)

    def _renamed(self, name: str) -> None:
        for peer in self.peers.values():
            peer.renamed(name)

    # ---- what recordings and pages of this system need

    def members(self) -> list[MemberRecord]:
        """Return all members, this one first. See `jacaros.runtime.mas.fleet.Fleet`."""
        others = (peer.record() for peer in self.peers.values() if peer.picture is not None)
        return [self._announced.record(self.me.name), *others]

    def traced(self, on: bool) -> None:
        """Hear that this system is recorded, or no longer: others send causes while it is."""
        self._tell(self._announced.watched())

    def show_page(self, address: str) -> None:
        """Tell the others the address of the live page of this system."""
        self._announced.page = address
        self._tell(self._announced.watched())

    def _tell(self, said: object) -> None:
        for peer in self.peers.values():
            peer.say(said)  # type: ignore[arg-type]

    def _pulse(self) -> None:
        """Give signs of life, and notice who gives none."""
        clock = self._system.clock
        late = clock.elapsed - self._pulse_at > self._silence / 2  # the others may have spoken meanwhile
        self._pulse_at = clock.elapsed
        self._timer = clock.call_later(PING, self._pulse)
        for peer in list(self.peers.values()):
            if not peer.is_absent:
                peer.channel.ping()
            if late:
                peer.heard_at = clock.elapsed
            elif peer.is_there and clock.elapsed - peer.heard_at > self._silence:
                peer.lose()
            elif peer.state and peer.channel.clocks.has_moved():
                self._tell_watchers(peer.name, peer.state)

    # ---- what the carrier tells

    def received(self, sender: MemberId, datagram: bytes) -> None:
        """Receive a datagram."""
        try:
            packet = read_packet(datagram)
        except Malformed as error:
            self.refused(sender.name, str(error))
            return
        if is_visitor(sender):
            self._visits.received(sender, packet)
            return
        peer = self._peer(sender)
        if peer is not None and not peer.is_absent:
            peer.find()
            peer.heard(packet)

    def all_received(self) -> None:
        """Give agents that got something their turns now: each pass of the loop between would delay the answer."""
        self._system.scheduler.hurry()

    def refused(self, sender: str, why: str) -> None:
        """Report something that did not come from a member, once for each sender."""
        self._warn(f"ignored from {sender}: {why}", sender)

    def present(self, member: MemberId, is_present: bool) -> None:
        """Hear that another member is there, or is not."""
        if is_visitor(member):
            self._visits.present(member, is_present)
            return
        if not is_present:
            if self._rival == member:
                self._rival = None
            known = self.peers.get(member.name)
            if known is not None and known.id == member:
                known.is_absent = True
                # One that leaves at the same time has no member left to say so to.
                known.lose("lost" if self._ends else "left")
            return
        peer = self._peer(member)
        if peer is not None:
            peer.is_absent = False
            peer.heard_at = self._system.clock.elapsed
            peer.find()

    def _peer(self, member: MemberId) -> Peer | None:
        """Return another member, which may be new. None: it has ended, or its name is taken."""
        known = self.peers.get(member.name)
        if known is not None and known.id == member:
            return known
        if member.name == self.me.name:
            self._meet_rival(member)
            return None
        if member in self._departed or (known is None and not self._has_room()):
            return None
        if known is not None:
            if known.is_there:
                return None  # if it is another member of this name, it tells so itself
            self._replace(known)
        # A channel knows the numbers of both sides, so a run that returns needs its former one.
        peer = self.peers[member.name] = (
            self._former.pop(member) if member in self._former else self._new_peer(member)
        )
        return peer

    def _has_room(self) -> bool:
        """Make room for a new member, in place of one that was lost. Return False if all are there."""
        if len(self.peers) < _MOST:
            return True
        lost = next((each for each in self.peers.values() if not each.is_there), None)
        if lost is None:
            self._warn(f"ignored further members: there are {_MOST} already")
            return False
        del self.peers[lost.name]
        self._replace(lost)
        return True

    def _replace(self, lost: Peer) -> None:
        """Make room for another run of a lost member."""
        self._stop_waiting(lost)
        self._former[lost.id] = lost
        if len(self._former) > _FORMER:
            oldest = next(iter(self._former))
            del self._former[oldest]
            self._departed.append(oldest)
        lost.forget()

    def _new_peer(self, member: MemberId) -> Peer:
        return Peer(
            member,
            self._system,
            self._announced,
            self._agents,
            self._names,
            self._causes,
            lambda datagram: self._carrier.send(member, datagram),
            self._rights.of(member.name),
            self._changed,
        )

    def _meet_rival(self, member: MemberId) -> None:
        """Another run has the name of this one: the older one keeps it."""
        if member.incarnation == self.me.incarnation:
            return
        if member.incarnation < self.me.incarnation:
            self._rival = member
            return
        self._warn(f"another member is called {self.me.name}, too; the one that began first keeps the name")

    def _changed(self, peer: Peer, state: str) -> None:
        self._system.console.log(
            f"[fleet] {peer.name} {_STATES[state]}", "warning" if state == "lost" else "info"
        )
        self._stop_waiting(peer)
        if state == "lost":
            self._forgetting[peer.id] = self._system.clock.call_later(MEMORY, partial(self._expire, peer))
        elif state == "left":
            self._end(peer)
        self._tell_watchers(peer.name, state)

    def _tell_watchers(self, name: str, state: str) -> None:
        for watcher in tuple(self.watchers):
            watcher(name, state)

    def _expire(self, peer: Peer) -> None:
        """It was lost for too long. It may still return."""
        peer.forget()
        peer.state = ""
        self._tell_watchers(peer.name, "left")

    def _stop_waiting(self, peer: Peer) -> None:
        waiting = self._forgetting.pop(peer.id, None)
        if waiting is not None:
            waiting.cancel()

    def _end(self, peer: Peer) -> None:
        """End with a run of another member that will not return."""
        self._stop_waiting(peer)
        if self.peers.get(peer.name) is peer:
            del self.peers[peer.name]
        self._departed.append(peer.id)
        peer.forget()


_STATES = {"joined": "has joined", "lost": "does not answer", "left": "has left"}
