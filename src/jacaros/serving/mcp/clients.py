"""Clients over MCP, and the goals they pursue."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from math import inf
from typing import Any

from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Outbox, Reply
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
        given: list[RequestedGoal] = []

        def begin(session: Session, reply: Reply[dict[str, Any]]) -> None:
            given.append(goal := session.achieve(tool.agent, tool.offer.key, arguments))
            goal.then(lambda: reply.give(goal.data()), over=True)

        ending = self.ask(begin)
        until = time.monotonic() + (inf if patience is None else patience)
        shown, last = 0.0, None
        try:
            while not ending.done() and (rest := until - time.monotonic()) > 0:
                await asyncio.wait({ending}, timeout=patience if report is None else min(LOOK, rest))
                now = None if report is None else await self.do(lambda _: _progress(given))
                if report is not None and now is not None and now != last:
                    fraction, last = now[0], now
                    shown = max(fraction or 0.0, shown + 1e-6)  # clients expect it to increase
                    await report(shown, None if fraction is None else 1.0, now[1] or None)
            found = None if ending.done() else await self.do(lambda _: given[0].data() if given else None)
            return found or await ending
        except asyncio.CancelledError:
            if not self.left:
                with suppress(RequestError):  # the run has ended
                    self._crossing.post(lambda: self._cancel(given))
            raise
        finally:
            ending.cancel()

    def _cancel(self, given: Sequence[RequestedGoal]) -> None:
        with suppress(RequestError):  # the run has ended
            for goal in given:
                self._opened().cancel(goal.id)

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


def _progress(given: Sequence[RequestedGoal]) -> tuple[float | None, str] | None:
    """Return how far a goal is, and what the agent does; None before it is given, and after its end."""
    for goal in given:
        if not goal.over:
            return goal.progress, goal.note or goal.doing() or goal.state
    return None
