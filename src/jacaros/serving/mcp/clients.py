"""Clients over MCP, and the goals they pursue."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping
from contextlib import ExitStack, suppress
from math import inf
from typing import Any

from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Outbox
from jacaros.serving.goals import RequestedGoal
from jacaros.serving.mcp.tools import AgentOffer, named_tools, offers_of
from jacaros.serving.remote import RemoteCaller
from jacaros.serving.service import Event, Service, Session

LOOK = 0.5
"""Seconds between looks at what an agent does for a goal whose client wants to know."""
Report = Callable[[float, float | None, str | None], Awaitable[None]]
"""Reports progress: how far, of how much, and what the agent does."""


class Client(RemoteCaller):
    """A caller over MCP.

    Attributes:
        left: whether its connection has ended. The end of a request then is not a wish to cancel its goal.
    """

    def __init__(self, caller: Caller, crossing: Crossing, service: Service) -> None:
        super().__init__(caller, crossing, service)
        self.left = False
        self._tools: dict[str, AgentOffer] = {}

    async def leave(self) -> None:
        """End its session."""
        self.left = True
        await super().leave()

    async def tools(self) -> Mapping[str, AgentOffer]:
        """Return the tools of the agents by name."""
        self._tools = named_tools(await self.do(offers_of))
        return self._tools

    async def tool(self, name: str) -> AgentOffer | None:
        """Return the tool with a name, or None."""
        if name not in self._tools:
            await self.tools()
        return self._tools.get(name)

    async def pursue(
        self, tool: AgentOffer, arguments: Mapping[str, Any], report: Report | None, patience: float | None
    ) -> dict[str, Any]:
        """Give an agent a goal, and wait for its end. Return its data.

        Args:
            tool: the goal.
            arguments: its arguments.
            report: reports progress, if the client wants to know.
            patience: seconds after which the goal continues without this request; None for no limit.

        Raises:
            RequestError: the goal is not given.
        """
        pursuit = Pursuit(self, tool, arguments)
        pursuing = asyncio.create_task(self.wait(pursuit.run))
        until = time.monotonic() + (inf if patience is None else patience)
        shown, last = 0.0, None
        try:
            await asyncio.sleep(0)  # it begins, even if there is no patience
            while not pursuing.done() and (rest := until - time.monotonic()) > 0:
                await asyncio.wait({pursuing}, timeout=patience if report is None else min(LOOK, rest))
                now = None if report is None else await self.do(lambda _: pursuit.progress())
                if report is not None and now is not None and now != last:
                    fraction, last = now[0], now
                    shown = max(fraction or 0.0, shown + 1e-6)  # clients expect it to increase
                    await report(shown, None if fraction is None else 1.0, now[1] or None)
            pursuit.detached = not pursuing.done()
            # A later task than `run`: the goal has been given, or the request had no effect.
            found = await self.wait(pursuit.data) if pursuit.detached else None
            return found or await pursuing
        finally:
            pursuing.cancel()

    async def watch(self, beliefs: Mapping[str, tuple[str, str]], changed: Outbox[str]) -> Callable[[], None]:
        """Put the address of each belief that changes into an outbox, and "" when agents start or end.

        Returns:
            A function that ends this.

        Args:
            beliefs: agents and names of the beliefs, by address.
            changed: where to put the addresses.
        """
        stop = await self.do(lambda session: _watch(session, beliefs, changed))

        def end() -> None:
            with suppress(RequestError):  # the run has ended
                self._crossing.post(stop)

        return end


def _watch(
    session: Session, beliefs: Mapping[str, tuple[str, str]], changed: Outbox[str]
) -> Callable[[], None]:
    begun = False

    def put(uri: str) -> None:
        if begun:  # the first call only says how it is now
            changed.put(uri, uri)

    def hear(event: Event) -> None:
        if event["event"] in ("agent_started", "agent_ended"):
            put("")

    with ExitStack() as ends:
        ends.callback(session.listen(hear))
        for uri, (agent, name) in beliefs.items():
            ends.callback(session.watch(agent, name, lambda _, uri=uri: put(uri)))  # type: ignore[misc]
        begun = True
        return ends.pop_all().close


class Pursuit:
    """A goal that a request waits for. All methods belong to the loop of the run.

    Args:
        client: who gives it.
        tool: the goal.
        arguments: its arguments.

    Attributes:
        detached: whether the goal continues when the request ends.
    """

    def __init__(self, client: Client, tool: AgentOffer, arguments: Mapping[str, Any]) -> None:
        self._client, self._tool, self._arguments = client, tool, arguments
        self.detached = False
        self._goal: RequestedGoal | None = None

    async def run(self, session: Session) -> dict[str, Any]:
        """Give the goal, and wait for its end. Return its data."""
        goal = self._goal = session.achieve(self._tool.agent, self._tool.offer.key, self._arguments)
        try:
            await goal.wait()
        except asyncio.CancelledError:
            if not (self.detached or self._client.left):
                session.cancel(goal.id)
            raise
        return goal.data()

    async def data(self, _: Session) -> dict[str, Any] | None:
        """Return the data of the goal; None if it has not been given."""
        return None if self._goal is None else self._goal.data()

    def progress(self) -> tuple[float | None, str] | None:
        """Return how far the goal is, and what the agent does; None before it is given, and after its end."""
        goal = self._goal
        if goal is None or goal.over:
            return None
        return goal.progress, goal.note or goal.doing() or goal.state
