"""Another member, as this one knows it: what it has, and what is under way between both."""

import asyncio
from collections.abc import Callable, Collection
from functools import partial
from typing import Any

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.fleet import protocol
from jacaros.fleet.agents import FleetAgents
from jacaros.fleet.announced import Announced
from jacaros.fleet.artifacts import ArtifactNames
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.causes import Causes
from jacaros.fleet.channel import Channel, Packet
from jacaros.fleet.messages import Messages
from jacaros.fleet.mounted import MountedWorkspaces
from jacaros.fleet.names import one_line
from jacaros.fleet.remote import Calls, RemoteWorkspaces
from jacaros.fleet.rights import OPERATE, SEE, STOP
from jacaros.fleet.served import Served
from jacaros.fleet.wire import Wire
from jacaros.look.records.records import MemberRecord
from jacaros.runtime.errors import InternalError
from jacaros.runtime.mas.system import System

_REPORTS = 100
"""Different warnings about a member that are written at most."""
_SHUTDOWN = "shutdownNode"
"""The operation of CArtAgO that ends the run."""


class Peer:
    """One run of another member.

    Args:
        id: that run.
        system: the system of this member.
        announced: what this member says of itself.
        agents: agents of all other members.
        names: names of artifacts.
        causes: describes what led to something.
        transmit: sends a datagram to it.
        rights: what it may do here.
        changed: called with its new state: ``joined``, ``lost`` or ``left``.

    Attributes:
        is_there: whether it answers.
        is_absent: whether the network says that it is not there.
        heard_at: when it was last heard, on the clock of the run.
        picture: what it said of itself last; None before.
        state: ``joined``, ``lost`` or ``left``; empty before it has joined.
        messages: messages in both directions.
    """

    def __init__(
        self,
        id: MemberId,
        system: System,
        announced: Announced,
        agents: FleetAgents,
        names: ArtifactNames,
        causes: Causes,
        transmit: Callable[[bytes], None],
        rights: Collection[str],
        changed: Callable[["Peer", str], None],
    ) -> None:
        self.id, self.name = id, id.name
        self.is_there = self.is_absent = False
        self.heard_at = system.clock.elapsed
        self.picture: protocol.Here | None = None
        self.channel = Channel(system.clock, transmit, self._received)
        self._system, self._announced, self._agents, self._names = system, announced, agents, names
        self._causes, self._rights, self._changed = causes, rights, changed
        self._epoch = 1
        self._its_epoch = 0
        self.state = ""
        self._is_known = False
        self._reported: set[str] = set()
        self._services: dict[tuple[str, str], str] = {}
        wire = Wire(names.name, names.find)
        self.messages = Messages(self.name, system, self.channel, self, agents, wire, causes, rights)
        self._calls = Calls(self, self.name)
        self._served = Served(
            self._environment, names, wire, self, lambda agent: agents.called(agent, self.name), causes
        )
        self.channel.when_drained = self._served.drained
        self._remote = RemoteWorkspaces(id.incarnation, names, wire, self, self._calls, causes)
        self._workspaces = MountedWorkspaces(
            self.name,
            self._remote,
            lambda: self._environment() if system.has_environment else None,
            self.report,
        )
        self._handlers: dict[type, Callable[[Any], None]] = {
            protocol.Here: self._on_here,
            protocol.Watched: self._on_watched,
            protocol.Bye: lambda _: self.leave(),
            protocol.AgentNews: self._if_known(self._on_agent),
            protocol.ServiceNews: self._if_known(self._on_service),
            protocol.Message: self.messages.received,
            protocol.Returned: self.messages.returned,
            protocol.WorkspaceNews: self._if_known(self._on_workspace),
            protocol.ArtifactNews: self._if_known(self._on_artifact),
            protocol.Execute: self._on_execute,
            protocol.Create: partial(self._allowed, OPERATE, self._served.on_create),
            protocol.CreateWorkspace: partial(self._allowed, OPERATE, self._served.on_create_workspace),
            protocol.Dispose: partial(self._allowed, OPERATE, self._served.on_dispose),
            protocol.Focus: partial(self._allowed, SEE, self._served.on_focus),
            protocol.StopFocus: self._served.on_stop_focus,
            protocol.Link: partial(self._allowed, OPERATE, self._served.on_link),
            protocol.Handle: self._served.on_handle,
            protocol.Ended: self._calls.ended,
            protocol.Observed: self._remote.observed,
        }

    def _environment(self) -> Environment:
        return self._system.run_environment().environment

    # ---- the line

    @property
    def is_behind(self) -> bool:
        """Whether what is sent now would wait on its way."""
        return self.channel.is_behind

    @property
    def backlog(self) -> int:
        """Bytes that have not arrived there."""
        return self.channel.backlog

    def say(self, said: protocol.Said) -> bool:
        """Say something. Without effect while it does not answer: it gets the whole picture when it returns.

        Return False if it is too large.
        """
        if self.is_there:
            payload = protocol.write(said)
            if len(payload) > protocol.LARGEST:
                self.report(f"{type(said).__name__}: {protocol.TOO_LARGE}")
                return False
            self.channel.send(payload)
        return True

    def report(self, text: str, about: str = "") -> None:
        """Write a warning about it into the log, once; or once *about* something."""
        line = one_line(text)
        if (about or line) not in self._reported and len(self._reported) < _REPORTS:
            self._reported.add(about or line)
            self._system.console.log(f"[fleet] {self.name}: {line}", "warning")

    def heard(self, packet: Packet) -> None:
        """Take in a packet."""
        self.heard_at = self._system.clock.elapsed
        self.channel.heard(packet)

    def _received(self, payload: bytes) -> None:
        try:
            said = protocol.read(payload)
            handler = self._handlers.get(type(said))
            if handler is not None:
                handler(said)
        except OperationFailed as failure:
            self.report(failure.message)
        except InternalError:
            raise
        except Exception as error:  # whatever it says, nothing here ends because of it
            kind = type(error).__name__
            self.report(f"dropped an invalid message: {kind}: {error}", "invalid")

    def _allowed(self, right: str, handler: Callable[[Any], None], asked: Any) -> None:
        """Do what it asks for if it may. It gets an outcome in any case."""
        if right in self._rights:
            try:
                handler(asked)
            except OperationFailed as failure:
                self._served.fail(asked.call, OperationOutcome.of(failure))
            except Exception as error:
                self._served.fail(asked.call, OperationOutcome(False, f"malformed request: {error}"))
                raise
            return
        self.report(f"refused a request: it lacks the right `{right}` (--fleet-allow)")
        text = f"{self._system.deployment.name} does not give this system the right `{right}`"
        self.say(protocol.Ended(asked.call, False, text, [1, "not_permitted", [0, right]], [], None))

    def _on_execute(self, asked: protocol.Execute) -> None:
        """Run an operation. One that ends the run has a right of its own."""
        self._allowed(STOP if asked.operation == _SHUTDOWN else OPERATE, self._served.on_execute, asked)

    # ---- its life

    def find(self) -> None:
        """It answers."""
        if self.is_there:
            return
        self.is_there = True
        self.channel.find()
        self._introduce()

    def _introduce(self) -> None:
        self.say(self._announced.picture(self._epoch, self._its_epoch))
        self.say(self._announced.watched())

    def lose(self, state: str = "lost") -> None:
        """It does not answer."""
        if not self.is_there:
            return
        self.is_there = False
        self.channel.lose()
        self._epoch += 1
        self._break()
        self._become(state)

    def leave(self) -> None:
        """It said that it ends."""
        self.channel.ping()  # it waits for that
        self.lose("left")

    def _break(self) -> None:
        """End everything that is under way between both."""
        self._is_known = False
        self._served.lost()
        self._remote.lose()
        self._calls.lost()
        self._drop_names()
        self.messages.lost()

    def forget(self) -> None:
        """It will not return."""
        self.channel.give_up()
        for path in self._workspaces:
            self._workspaces.remove(path)
        self._names.forget_run(self.id.incarnation)
        self.messages.forget()
        self._agents.forget(self.name)
        self._causes.want(self.name, False)

    def record(self) -> MemberRecord:
        """Return what is known of it."""
        state = "joined" if self.is_there and self.picture is not None else "lost"
        clocks, page = self.channel.clocks, "" if self.picture is None else self.picture.page
        delay = None if clocks.delay is None else round(clocks.delay, 6)
        return MemberRecord(
            self.name,
            state,
            self._agents.of(self.name),
            [*self._workspaces],
            delay,
            round(clocks.offset, 6),
            page,
        )

    # ---- what it has

    def _drop_names(self) -> None:
        """Forget its agents and their services."""
        self._agents.went(self.name)
        for agent, service in list(self._services):
            self._on_service(protocol.ServiceNews(agent, service, False))

    def _on_here(self, said: protocol.Here) -> None:
        if not self.is_there:
            return
        known, self._its_epoch = self._its_epoch, said.epoch
        if known != said.epoch:
            # It lost this member, even if that has not noticed, and what was begun on both sides.
            if known:
                self.channel.withdraw()  # no operation of before begins after its caller has given it up
            self._break()
            if known or said.knows == self._epoch:
                self._introduce()
        self._drop_names()  # changes since an earlier picture may have been withdrawn
        self._is_known = True
        self._agents.came(self.name, self.messages)
        for name in said.agents:
            self._agents.know(name, self.name, True)
        for agent, service in said.services:
            self._on_service(protocol.ServiceNews(agent, service, True))
        self._workspaces.keep_only([path for path, _ in said.workspaces])
        self._remote.find()  # before new ones, whose artifacts agents focus themselves
        self._workspaces.told_all(said.workspaces)
        self.picture = said
        self._become("joined")

    def _on_watched(self, said: protocol.Watched) -> None:
        self._causes.want(self.name, said.records)
        if self.picture is not None:
            self.picture.page = said.page

    def _become(self, state: str) -> None:
        if state != self.state:
            self.state = state
            self._changed(self, state)

    def _if_known(self, handler: Callable[[Any], None]) -> Callable[[Any], None]:
        """Ignore changes of a picture that is not known: the whole one follows."""
        return lambda said: handler(said) if self._is_known else None

    def _on_agent(self, said: protocol.AgentNews) -> None:
        self._agents.know(said.name, self.name, said.present)

    def renamed(self, name: str) -> None:
        """Its agent with this bare name, if there is one, may be called otherwise here."""
        called, services = self._agents.called(name, self.name), self._system.services
        for (agent, service), former in list(self._services.items()):
            if agent == name and former != called:
                services.deregister(former, service)
                self._services[agent, service] = called
                services.register(called, service)

    def _on_service(self, said: protocol.ServiceNews) -> None:
        key = (said.agent, said.service)
        services = self._system.services
        if said.provides and key not in self._services:
            self._services[key] = self._agents.called(said.agent, self.name)
            services.register(self._services[key], said.service)
        elif not said.provides and key in self._services:
            services.deregister(self._services.pop(key), said.service)

    def path_of(self, path: str) -> str:
        """Return the path at which a workspace of it is visible here."""
        return self._workspaces.path_of(path)

    def _on_workspace(self, said: protocol.WorkspaceNews) -> None:
        if said.present:
            self._workspaces.add(said.path)
        else:
            self._workspaces.remove(said.path)

    async def create_workspace(self, path: str) -> None:
        """Create a workspace there.

        Raises:
            OperationFailed: that is impossible.
        """
        ended: asyncio.Future[protocol.Ended] = asyncio.get_running_loop().create_future()

        def done(said: protocol.Ended) -> None:
            if not ended.done():
                ended.set_result(said)

        self._calls.ask(lambda call: protocol.CreateWorkspace(call, path), done)
        outcome = self._remote.outcome(await ended)
        if not outcome.ok:
            raise outcome.failure

    def _on_artifact(self, said: protocol.ArtifactNews) -> None:
        self._workspaces.told(said.workspace, said.number, said.data)
